"""Numbers in other bases, and their bits.

`BIN2DEC` and similar functions take ten digits at most; the upper half of all ten-digit numbers stands for negative
ones. `BITAND` and similar functions take whole numbers of at most 48 bits, from 0 on; others are `#NUM!`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.math.numerals import digits_of, read_digits
from xlmc.excel.functions.per_element import per_object
from xlmc.excel.functions.registry import Kind, Number, excel
from xlmc.excel.functions.toolpak import OneCell, strict_number
from xlmc.excel.functions.values import NUM, Bools, Floats, general_text

__all__: list[str] = []

_MOST_DIGITS: Final = 10
_ANY_LENGTH: Final = object()
_BASES: Final = {"BIN": ("binary", 2), "OCT": ("octal", 8), "HEX": ("hexadecimal", 16)}


def _read(item: object, base: int) -> int | ErrorCode:
    """Read up to ten digits, in a text or as a number; "" and a blank are 0."""
    if isinstance(item, bool):
        return ErrorCode.VALUE
    text = general_text(item) if isinstance(item, float) else str(item or "")
    number = read_digits(text, base) if len(text) <= _MOST_DIGITS else None
    if number is None:
        return ErrorCode.NUM
    return number if number < base**_MOST_DIGITS // 2 else number - int(base**_MOST_DIGITS)


def _read_whole(item: object) -> int | ErrorCode:
    number = strict_number(item)
    return number if isinstance(number, ErrorCode) else int(number)


def _read_length(digits_wanted: object) -> int | ErrorCode | None:
    """Read how many digits are asked for; None if the argument is left out; `#NUM!` unless 1 to 10."""
    if digits_wanted is _ANY_LENGTH:
        return None
    length = _read_whole(digits_wanted)
    if isinstance(length, ErrorCode) or 1 <= length <= _MOST_DIGITS:
        return length
    return ErrorCode.NUM


def _write(number: int | ErrorCode, base: int, digits_wanted: object) -> str | ErrorCode:
    """Write the digits with the length asked for; a negative number always has ten. Errors of the length go first."""
    length = _read_length(digits_wanted)
    if isinstance(length, ErrorCode) or isinstance(number, ErrorCode):
        return length if isinstance(length, ErrorCode) else ErrorCode(number)
    most = base**_MOST_DIGITS // 2
    if not -most <= number < most:
        return ErrorCode.NUM
    if number < 0:
        return digits_of(2 * most + number, base)
    digits = digits_of(number, base) or "0"
    if length is None:
        return digits
    return digits.zfill(length) if len(digits) <= length else ErrorCode.NUM


def _convert_between(source: int, target: int) -> Callable[..., str | ErrorCode]:
    def convert(digits: object, digits_wanted: object = _ANY_LENGTH) -> str | ErrorCode:
        return _write(_read(digits, source), target, digits_wanted)

    return convert


def _to_decimal(source: int) -> Callable[..., float | ErrorCode]:
    def convert(digits: object) -> float | ErrorCode:
        number = _read(digits, source)
        return number if isinstance(number, ErrorCode) else float(number)

    return convert


def _from_decimal(target: int) -> Callable[..., str | ErrorCode]:
    def convert(number: object, digits_wanted: object = _ANY_LENGTH) -> str | ErrorCode:
        return _write(_read_whole(number), target, digits_wanted)

    return convert


def _register(name: str, meaning: str, function: Callable[..., object], *, text: bool) -> None:
    function.__doc__ = meaning
    parameters = (OneCell, OneCell(default=None)) if text else (OneCell,)
    excel(name, *parameters, returns=Kind.TEXT if text else Kind.NUMBER)(per_object(function))


for _name, (_word, _base) in _BASES.items():
    _register(f"{_name}2DEC", f"Number of {_word} digits.", _to_decimal(_base), text=False)
    _register(f"DEC2{_name}", f"The {_word} digits of a number.", _from_decimal(_base), text=True)
    for _other, (_new_word, _new_base) in _BASES.items():
        if _other != _name:
            _meaning = f"The {_new_word} digits of a number in {_word} digits."
            _register(f"{_name}2{_other}", _meaning, _convert_between(_base, _new_base), text=True)


_END_OF_BITS: Final = 2.0**48
_FURTHEST_SHIFT: Final = 53


def _has_bits(x: Floats) -> Bools:
    return np.asarray((x >= 0) & (x < _END_OF_BITS) & (x == np.trunc(x)))


def _register_bits(name: str, meaning: str, operation: np.ufunc) -> None:
    def body(x: Floats, y: Floats) -> Floats:
        fit = _has_bits(x) & _has_bits(y)
        left, right = (np.where(fit, z, 0.0).astype(np.int64) for z in (x, y))
        return np.where(fit, operation(left, right), NUM)

    body.__doc__ = meaning
    excel(name, Number, Number)(body)


_register_bits("BITAND", "Bits that both numbers have.", np.bitwise_and)
_register_bits("BITOR", "Bits that either number has.", np.bitwise_or)
_register_bits("BITXOR", "Bits that only one of the numbers has.", np.bitwise_xor)


@excel("BITLSHIFT", Number, Number)
def shift_left(x: Floats, count: Floats) -> Floats:
    """Bits shifted left by up to 53 places, or right by a negative number; bits that leave on the right are lost.

    `#NUM!` where the result has more than 48 bits.
    """
    shift = np.trunc(count)
    fit = _has_bits(x) & (np.abs(shift) <= _FURTHEST_SHIFT)
    shifted = np.floor(np.ldexp(np.where(fit, x, 0.0), np.where(fit, shift, 0.0).astype(np.intc)))
    return np.where(fit & (shifted < _END_OF_BITS), shifted, NUM)


@excel("BITRSHIFT", Number, Number)
def shift_right(x: Floats, count: Floats) -> Floats:
    """Bits shifted right by up to 53 places, or left by a negative number."""
    result: Floats = shift_left(x, -count)
    return result
