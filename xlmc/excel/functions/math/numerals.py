"""Numbers written another way: Roman, or in a base from 2 to 36."""

from __future__ import annotations

from typing import Final

from xlmc.errors import ErrorCode
from xlmc.excel.functions.per_element import per_element, per_object
from xlmc.excel.functions.registry import Anything, Kind, Number, Text, excel
from xlmc.excel.functions.toolpak import strict_number

__all__ = ["digits_of", "read_digits"]

_ROMAN: Final = {"I": 1, "V": 5, "X": 10, "L": 50, "C": 100, "D": 500, "M": 1000}
_LONGEST: Final = 255
"""Longer texts are not read or written as numerals."""

_DIGITS: Final = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ"
_EXACT: Final = 2.0**53


@excel("ROMAN", Anything, Anything(default=None), returns=Kind.TEXT)
@per_object
def roman(number: object, form: object = 0.0) -> str | ErrorCode:
    """Roman numeral, from the classic form 0 (also TRUE) to the shortest, 4 (also FALSE); `#VALUE!` above 3999."""
    value = float(number) if isinstance(number, bool) else strict_number(number)
    level = (0.0 if form else 4.0) if isinstance(form, bool) else strict_number(form)
    for result in (value, level):
        if isinstance(result, ErrorCode):
            return result
    if not 0 <= value < 4000 or not 0 <= level < 5:
        return ErrorCode.VALUE
    return _numeral(int(value), int(level))


def _numeral(value: int, form: int) -> str:
    text = ""
    while value:
        letters, amount = _next_letters(value, form)
        text, value = text + letters, value - amount
    return text


def _next_letters(value: int, form: int) -> tuple[str, int]:
    """Yield what comes first in the numeral, a letter or a pair such as IV, and what it counts.

    In the classic form, the letter that is subtracted is the next power of ten below. Each further form allows one
    letter smaller; of those allowed, the smallest is taken that still brings the large letter down to the value.
    """
    names = list(_ROMAN)
    for large in reversed(range(len(names))):
        amount = _ROMAN[names[large]]
        if amount <= value:
            return names[large], amount
        power_of_ten = (large - 1) // 2 * 2
        smaller = range(power_of_ten, max(power_of_ten - form, 0) - 1, -1)
        reached = [s for s in smaller if amount - _ROMAN[names[s]] <= value]
        if reached:
            small = reached[-1]
            return names[small] + names[large], amount - _ROMAN[names[small]]
    raise ValueError(f"{value} has no Roman numeral")


@excel("ARABIC", Anything)
@per_object
def arabic(numeral: object) -> float | ErrorCode:
    """Return the number of a Roman numeral in any form: a letter left of a larger one is subtracted; "" is 0."""
    if numeral is None:
        return 0.0
    if not isinstance(numeral, str) or len(numeral) > _LONGEST:
        return ErrorCode.VALUE
    text = numeral.strip(" ").upper()
    letters = text.removeprefix("-")
    if not set(letters) <= set(_ROMAN):
        return ErrorCode.VALUE
    if text == "-":
        return ErrorCode.NUM
    return -_add_letters(letters) if text != letters else _add_letters(letters)


def _add_letters(letters: str) -> float:
    total = largest = 0
    for letter in reversed(letters):
        value = _ROMAN[letter]
        largest = max(largest, value)
        total += value if value == largest else -value
    return float(total)


def digits_of(number: int, base: int) -> str:
    """Write a whole number, 0 or more, in a base from 2 to 36; 0 has no digits."""
    text = ""
    while number:
        number, digit = divmod(number, base)
        text = _DIGITS[digit] + text
    return text


def read_digits(text: str, base: int) -> int | None:
    """Return the whole number that digits in a base stand for, 0 for none; None when a character is no such digit."""
    if any(digit not in _DIGITS[:base] for digit in text.upper()):
        return None
    return int(text or "0", base)


@excel("BASE", Number, Number, Number(default=1.0), returns=Kind.TEXT)
@per_element
def base(number: float, radix: float, length: float) -> str | ErrorCode:
    """Digits in a base, zeros before them up to a length; `#NUM!` below 0 and from 2^53 on."""
    if not (0 <= number < _EXACT and 2 <= radix < 37 and 0 <= length < _LONGEST + 1):
        return ErrorCode.NUM
    return digits_of(int(number), int(radix)).zfill(int(length))


@excel("DECIMAL", Text, Number)
@per_element
def decimal(text: str, radix: float) -> float | ErrorCode:
    """Return the number that digits in a base stand for; `#NUM!` for others than digits of that base."""
    if len(text) > _LONGEST:
        return ErrorCode.VALUE
    if not 2 <= radix < 37:
        return ErrorCode.NUM
    number = read_digits(text.lstrip(" "), int(radix))
    try:
        return ErrorCode.NUM if number is None else float(number)
    except OverflowError:
        return ErrorCode.NUM
