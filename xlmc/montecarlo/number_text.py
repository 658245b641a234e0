"""Numbers as people read them: all outputs write them with these functions, so that no two differ.

A number has the digits that its error supports; without an error six, or all that it needs where it is exact. Thousands
stand apart. A power of ten is written from 10¹⁵ on and below 10⁻⁴ alone.

Thousands and decimals have the signs of the setting Number style, never those of the machine. Whatever writes a whole
text for people (a sheet, a page, a report, a frame of the live window, what a command prints) knows the run or the
workbook, and writes it `in_style` of that (`number_styles`); elsewhere, as in JSON, the signs are those of 1,234.5.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from decimal import Decimal
from typing import Final

__all__ = [
    "MOST_DIGITS",
    "count_text",
    "counted_text",
    "decimals_of",
    "exact_digits",
    "exact_text",
    "fixed_text",
    "format_estimate",
    "fraction",
    "in_signs",
    "is_far",
    "number_text",
    "percent",
    "percent_format",
    "signs",
    "styled_text",
    "two_digit_exponent",
    "whole_text",
]

MOST_DIGITS = 15
"""All that a double holds for certain."""

_LARGEST, _SMALLEST = 15, -4
"""Powers of ten from which on, and below which, a number is written with a power of ten."""

_DIGITS = 6
_EXACT_DIGITS: Final = range(6, 14)
"""Digits of a number that is exact; one that has more of them is no decimal number, and six are enough."""
_NOISE: Final = 1e-13
"""Share of such a number that may come from rounding in formulas, where it has no more than `_ROUND` digits."""
_ROUND: Final = 10

_USUAL: Final = ",", "."

_SIGNS: ContextVar[tuple[str, str]] = ContextVar("signs of thousands and decimals", default=_USUAL)


@contextmanager
def in_signs(of_thousands: str, of_decimals: str) -> Iterator[None]:
    """Write all numbers with these signs until the end of the block.

    >>> with in_signs(".", ","):
    ...     number_text(1234567.25), format_estimate(1234.5, 0.32)
    ('1.234.567', '1.234,50 ± 0,32')
    """
    token = _SIGNS.set((of_thousands, of_decimals))
    try:
        yield
    finally:
        _SIGNS.reset(token)


def signs() -> tuple[str, str]:
    """Return the signs of thousands and of decimals."""
    return _SIGNS.get()


def _styled(text: str) -> str:
    """Write a number that Python wrote, `1,234.5`, with the signs of the context."""
    if (pair := _SIGNS.get()) == _USUAL:
        return text
    return text.translate(dict(zip(map(ord, _USUAL), pair, strict=True)))


def styled_text(value: float | Decimal, form: str) -> str:
    """Write a number by a format of Python; a percentage as all others, with a space.

    >>> styled_text(0.0213, ".1%"), styled_text(0.0213, ".2g")
    ('2.1 %', '0.021')
    """
    text = _styled(format(value, form))
    return f"{text[:-1]} %" if form.endswith("%") else text


def count_text(count: int) -> str:
    """Write a count of trials or of anything else, `200,000`."""
    return _styled(f"{count:,}")


def counted_text(count: int, noun: str) -> str:
    """Write how many of something there are.

    >>> counted_text(1, "accepted trial"), counted_text(200000, "accepted trial")
    ('1 accepted trial', '200,000 accepted trials')
    """
    return f"{count_text(count)} {noun}{'s' * (count != 1)}"


def fixed_text(value: float, decimals: int) -> str:
    """Write a number rounded to so many decimals; to tens, hundreds, … where they are negative.

    >>> fixed_text(48211.3, -1), fixed_text(-0.001, 2)
    ('48,210', '0.00')
    """
    return _styled(f"{round(value, decimals) + 0.0:,.{max(decimals, 0)}f}")  # + 0.0: no negative zero


def is_far(value: float) -> bool:
    """Whether a number is written with a power of ten."""
    return value != 0.0 and math.isfinite(value) and not _SMALLEST <= two_digit_exponent(value) < _LARGEST


def number_text(value: float, digits: int = _DIGITS) -> str:
    """Write a number without an error, in so many significant digits at most; all of its digits before the point.

    >>> number_text(2234567.89), number_text(0.1 + 0.2), number_text(1e-9), number_text(2.5e15)
    ('2,234,568', '0.3', '1e-09', '2.5e+15')
    >>> number_text(99.71, 3), number_text(99.96, 3), number_text(0.9996, 3)
    ('99.7', '100', '1')
    """
    if value == 0.0 or not math.isfinite(value) or is_far(value):
        return _styled(f"{value + 0.0:.{digits}g}")
    power = int(f"{value:.{digits - 1}e}".partition("e")[2])  # once it is rounded: 9.996 -> 10.00
    text = f"{value:,.{max(digits - 1 - power, 0)}f}"
    return _styled(text.rstrip("0").rstrip(".") if "." in text else text)


def percent(share: float) -> str:
    """`0.51 -> 51 %`."""
    return f"{number_text(100.0 * share, 12)} %"


def whole_text(value: float) -> str:
    """Write a number with all of its digits, without thousands, as a record holds it.

    >>> whole_text(0.1 + 0.2), whole_text(200000)
    ('0.30000000000000004', '200000')
    """
    return _styled(repr(float(value)).removesuffix(".0"))


def exact_text(value: float, *, typed: bool = False) -> str:
    """Write a number that is exact, up to rounding in formulas, in the fewest digits, six or more, that say what it is;
    in six where no decimal number is. One that a person has `typed` is one, with up to 15 digits.

    >>> exact_text(1234567.8), exact_text(0.1 + 0.2), exact_text(1 / 3)
    ('1,234,567.8', '0.3', '0.333333')
    >>> exact_text(0.12345678901234), exact_text(0.12345678901234, typed=True)
    ('0.123457', '0.12345678901234')
    """
    digits = exact_digits(value)
    if typed and digits is None:
        digits = next((most for most in (14, MOST_DIGITS) if float(f"{value:.{most}g}") == value), None)
    return number_text(value, digits or _DIGITS)


def exact_digits(value: float) -> int | None:
    """Return how many digits, six or more, say what an exact number is; None where it is no decimal number.

    >>> exact_digits(1234567.8), exact_digits(0.1 + 0.2), exact_digits(1 / 3)
    (8, 6, None)
    """
    for digits in _EXACT_DIGITS:
        noise = _NOISE * abs(value) if digits <= _ROUND else 0.0
        if abs(float(f"{value:.{digits}g}") - value) <= noise:
            return digits
    return None


def decimals_of(error: float | None) -> int | None:
    """Return the decimals that show an error in two digits; negative for tens, hundreds, …; None without an error."""
    return 1 - two_digit_exponent(error) if error and math.isfinite(error) else None


def format_estimate(value: float, error: float | None, decimals: int | None = None) -> str:
    """Write the error to two significant digits and the value to the same decimal, or both to `decimals`.

    A value whose error is not known has six digits; one whose error is 0, as a constant's, stands alone, too, with more
    where it needs them.

    >>> format_estimate(17.02134, 0.00231)
    '17.0213 ± 0.0023'
    >>> format_estimate(48211.3, 870.0), format_estimate(2.2345e6, 1.2e3)
    ('48,210 ± 870', '2,234,500 ± 1,200')
    >>> format_estimate(17.02134, None)
    '17.0213'
    >>> format_estimate(1234567.8, 0.0), format_estimate(0.1 + 0.2, 0.0)
    ('1,234,567.8', '0.3')
    """
    if error is None or not math.isfinite(value):
        return number_text(value) if decimals is None else fixed_text(value, decimals)
    if error == 0.0:
        return exact_text(value)
    size = two_digit_exponent(max(abs(value), error))
    if not _SMALLEST <= size < _LARGEST:
        shown = round(value, 1 - two_digit_exponent(error))
        if abs(shown) >= error:  # 9.997e-12 is not yet 1.0e-11
            size = int(f"{shown:.14e}".partition("e")[2])
        scaled = format_estimate(value / 10.0**size, error / 10.0**size)
        return f"({scaled})e{size:+03d}" if "±" in scaled else f"{scaled}e{size:+03d}"
    decimals = 1 - two_digit_exponent(error) if decimals is None else decimals
    if decimals + size >= MOST_DIGITS:  # an error below the last bit of the value, which is rounding
        return exact_text(value)
    return f"{fixed_text(value, decimals)} ± {fixed_text(error, decimals)}"


def two_digit_exponent(number: float) -> int:
    """Return the power of ten of a number rounded to two digits: 0.00996 -> -2."""
    return int(f"{number:.1e}".partition("e")[2])


def fraction(decimals: int) -> str:
    """Return the part of a number format behind the digits before the point."""
    return "." + "0" * decimals if decimals > 0 else ""


def percent_format(decimals: int) -> str:
    """Return the format of percentages with so many decimals, none where that is below 0."""
    return f"0{fraction(decimals)}%"
