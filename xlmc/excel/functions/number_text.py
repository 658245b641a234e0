"""Numbers as texts and texts as numbers, converted as Excel for the United States does it."""

from __future__ import annotations

import math
import re
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from decimal import ROUND_HALF_UP, Context, Decimal
from typing import Final

from xlmc.excel.functions.dates.date_text import parse_moment
from xlmc.excel.functions.denormals import TINIEST

__all__ = [
    "SPACES",
    "dates_from_1904",
    "general_text",
    "parse_number",
    "parse_plain_number",
    "round_to_15_digits",
]

SPACES: Final = " \t\r\n"
"""Characters that may stand before and after a number; a no-break space may not."""

_15_DIGITS: Final = Context(prec=15, rounding=ROUND_HALF_UP)
_14_DIGITS: Final = Context(prec=14, rounding=ROUND_HALF_UP)
_LONGEST: Final = 20
"""The most characters of a number; a longer one is written with an exponent."""


def round_to_15_digits(number: float) -> Decimal:
    """Round to the 15 significant digits that Excel shows, halves away from zero."""
    return _15_DIGITS.create_decimal_from_float(number)


def general_text(number: float) -> str:
    """Write a number as `&` does: 15 significant digits, in at most 20 characters."""
    size = round_to_15_digits(abs(number))
    if not size:
        return "0"
    if abs(size.adjusted()) > 98:
        size = _14_DIGITS.plus(size)
    digits, exponent = "".join(map(str, size.as_tuple().digits)).rstrip("0"), size.adjusted()
    return ("-" if number < 0 else "") + _write_digits(digits, exponent)


def _write_digits(digits: str, exponent: int) -> str:
    """Write `digits`, the first of which counts 10^exponent."""
    if exponent >= _LONGEST or len(digits) - exponent + 1 > _LONGEST:
        return f"{digits[0]}{'.' * (len(digits) > 1)}{digits[1:]}E{exponent:+03d}"
    if exponent < 0:
        return f"0.{'0' * (-exponent - 1)}{digits}"
    whole, decimals = digits[: exponent + 1].ljust(exponent + 1, "0"), digits[exponent + 1 :]
    return f"{whole}.{decimals}" if decimals else whole


_NUMBER: Final = re.compile(
    r"(?P<before>[ +%($€-]*)"
    r"(?P<whole>[0-9]+|(?!0+,)[0-9]+(?:,[0-9]{3,})+)?(?:(?P<point>\.)(?P<decimals>[0-9]*))?"
    r"(?: +(?P<top>[0-9]{1,15})/(?P<bottom>[0-9]{1,15}))?"
    r"(?:[eE](?P<exponent>[+-]?[0-9]{1,9}))?"
    r"(?P<after>[ %)€]*)"
)
_MARKS: Final = re.compile(r"[+-]?|\(\)")


class _Calendar(threading.local):
    from_1904 = False


_CALENDAR: Final = _Calendar()


@contextmanager
def dates_from_1904() -> Iterator[None]:
    """Read texts that are dates as days from 1904 on, in this thread, where nothing else is said."""
    before, _CALENDAR.from_1904 = _CALENDAR.from_1904, True
    try:
        yield
    finally:
        _CALENDAR.from_1904 = before


def parse_number(text: str, date1904: bool | None = None) -> float | None:
    """Read the number that a text stands for in arithmetic; None if it is no number.

    `$1,234.50`, `(5)`, `12%`, `1E-3` and `1 1/2` are numbers, and so are dates and times. Spaces may stand around
    numbers, but not around dates and times.

    Args:
        text: what is read.
        date1904: whether days count from 1904; by default they do within `dates_from_1904`, and nowhere else.
    """
    number = parse_plain_number(text.strip(SPACES))
    if number is not None:
        return number
    moment = parse_moment(text, _CALENDAR.from_1904 if date1904 is None else date1904)
    return None if moment is None else moment.serial


def parse_plain_number(text: str) -> float | None:
    """Read a number that is neither a date nor a time; None if the text is no such number."""
    match = _NUMBER.fullmatch(text)
    if match is None or not (match["whole"] or match["decimals"]):
        return None
    marks = (match["before"] + match["after"]).replace(" ", "")
    size = _read_size(match, marks.count("%")) if _marks_fit(marks) else None
    if size is None or not math.isfinite(size):
        return None
    return 0.0 if size < TINIEST else -size if "-" in marks or "(" in marks else size


def _marks_fit(marks: str) -> bool:
    """Return whether there is at most one of `$ € %`, and at most one of `+`, `-` and a pair of brackets."""
    signs = re.sub("[$€%]", "", marks)
    return len(marks) - len(signs) <= 1 and _MARKS.fullmatch(signs) is not None


def _read_size(match: re.Match[str], percents: int) -> float | None:
    """Read the number without its sign. Digits after the 15th are lost, as in Excel."""
    whole, decimals = (match["whole"] or "").replace(",", ""), match["decimals"] or ""
    if match["top"]:
        return _read_mixed(match, whole, percents)
    digits = (whole + decimals).lstrip("0")
    exponent = int(match["exponent"] or 0) - len(decimals) + max(len(digits) - 15, 0) - 2 * percents
    return float(f"{digits[:15] or 0}E{exponent}")


def _read_mixed(match: re.Match[str], whole: str, percents: int) -> float | None:
    """Read a mixed number such as `1 1/2`."""
    if not whole or match["point"] or match["exponent"] or not int(match["bottom"]):
        return None
    return (float(whole) + int(match["top"]) / int(match["bottom"])) / float(100**percents)
