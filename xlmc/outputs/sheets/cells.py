"""What stands in a cell of a result sheet: a text or a number, how the number shows, how the cell looks.

Excel's number formats show no more decimals than a standard error supports, as `format_estimate` prints them. A cell
keeps its full number; only what it shows is cut. Excel cannot show a number rounded to tens, so one whose error is
larger than a unit shows its units too, with the error beside it.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from xlmc.analysis.results.statements.in_words import number_text
from xlmc.montecarlo.statistics import Estimate
from xlmc.montecarlo.statistics.estimate import two_digit_exponent

__all__ = [
    "AT_LEAST",
    "BLANK",
    "LOGICAL",
    "NOISE",
    "NONE",
    "Shown",
    "count",
    "estimate",
    "exact",
    "interval",
    "number_format",
    "paired_format",
    "share",
    "share_format",
    "shown_text",
    "spread_format",
]

NONE = "–"
"""The text shown if there is no number."""

LOGICAL = '"TRUE";"TRUE";"FALSE"'
"""The format of a logical: LibreOffice shows 1 or 0 without it; Excel has its own words and does not heed it."""

NOISE = '"noise";"noise";"noise"'
"""The format of a number that is no more than noise: it shows the word."""

AT_LEAST = '"at least "'
"""What a number format begins with, if the number is a lower bound."""

_COUNT = "#,##0"

_DIGITS = 6
"""Significant digits where no error limits them."""

_ROOM = 9
"""Characters that columns have room for; fewer decimals are shown rather than `###`."""

_FORMAT = re.compile(r"(?P<grouped>#,##)?0(\.(?P<decimals>0+))?(?P<ending>%|E\+00)?")

_LONGEST = 11
"""Characters of a number that Excel shows in a cell without a format."""

_LARGEST, _SMALLEST = 1e7, 1e-4
"""A number outside these limits is shown with a power of ten."""


@dataclass(frozen=True, slots=True)
class Shown:
    """The content of one cell: a text as it is, also where it begins with `=`; a number; None is an empty cell.

    Attributes:
        look: by default `text` for a text, and `number` for anything else.
    """

    value: str | float | None
    format: str = "General"
    look: str = ""

    def __post_init__(self) -> None:
        if not self.look:
            object.__setattr__(self, "look", "text" if isinstance(self.value, str) else "number")


BLANK = Shown(None)

_ROUNDING = 1e-14
"""An error of a share from which on it is none of sampling; Excel refuses formats of more than 30 decimals."""


def exact(value: float | None, number: str = "General") -> Shown:
    """A number that has no error: a setting, the base case."""
    return Shown(value, number)


def count(value: int) -> Shown:
    """Trials."""
    return Shown(value, _COUNT)


def estimate(
    found: Estimate, look: str = "number", error_look: str = "error", *, like: Estimate | None = None
) -> list[Shown]:
    """Two cells: the value, and its standard error in the same digits; without an error, in those of `like`."""
    digits = paired_format(like if found.error is None and like is not None else found)
    return [Shown(found.value, digits, look), _error(found.error, _error_format(found, digits), error_look)]


def share(found: Estimate, look: str = "") -> list[Shown]:
    """Two cells: a share of trials and its standard error, in percent."""
    digits = share_format(found)
    return [Shown(found.value, digits, look), _error(found.error, digits, "error")]


def interval(found: Estimate, *, percent: bool = False) -> list[Shown]:
    """Two cells: the ends of the 95 % interval, in the digits of the value."""
    digits = share_format(found) if percent else paired_format(found)
    low, high = found.interval or (None, None)
    return [_error(low, digits, "error"), _error(high, digits, "error")]


def _error(value: float | None, digits: str, look: str) -> Shown:
    return Shown(NONE if value is None else value, digits, look)


def paired_format(estimate: Estimate) -> str:
    """The format of a value whose error stands in a cell of its own: two digits of the error."""
    if estimate.error == 0.0:
        return "General"
    return _format(estimate.value, _paired_decimals(estimate))


def _error_format(found: Estimate, digits: str) -> str:
    """The format of the error beside a value; digits of its own where those of so large a value show nothing of it."""
    decimals = _paired_decimals(found)
    if found.error is None or decimals is None or "E" in digits:
        return digits
    return digits if len(digits.partition(".")[2]) >= decimals - 1 else _format(found.error, decimals)


def share_format(estimate: Estimate) -> str:
    """`paired_format` for a share, in percent."""
    decimals = _paired_decimals(estimate) if (estimate.error or 0.0) > _ROUNDING else None
    return "0" + _fraction(max((4 if decimals is None else decimals) - 2, 0)) + "%"


def spread_format(spread: float) -> str:
    """The format of single trials: four digits of their spread."""
    return _format(spread, 3 - two_digit_exponent(spread)) if _usable(spread) else "General"


def number_format(value: float) -> str:
    """The format of a number that stands alone: six digits, or all that it has where these are fewer."""
    if float(value).is_integer():
        return _COUNT if abs(value) < _LARGEST * 100 else "General"
    return "General" if len(repr(value)) <= _DIGITS + 1 else _format(value, None)


def _paired_decimals(estimate: Estimate) -> int | None:
    return 1 - two_digit_exponent(estimate.error) if estimate.error and _usable(estimate.error) else None


def _format(value: float, decimals: int | None) -> str:
    if not math.isfinite(value):
        return "General"
    if decimals is None:
        if value == 0.0:
            return "General"
        decimals = _DIGITS - 1 - two_digit_exponent(value)
    size = max(abs(value), 10.0**-decimals)
    if not _SMALLEST <= size < _LARGEST:
        return "0" + _fraction(min(max(decimals + two_digit_exponent(size), 0), 3)) + "E+00"
    room = _ROOM - len(f"{value:,.0f}") - 1
    return "#,##0" + _fraction(max(min(decimals, room), 0))


def _fraction(decimals: int) -> str:
    return "." + "0" * decimals if decimals else ""


def _usable(number: float) -> bool:
    return number != 0.0 and math.isfinite(number)


def shown_text(shown: Shown) -> str:
    """What the sheet shows.

    Raises:
        ValueError: there is no such number format.
    """
    value = shown.value
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    if not math.isfinite(value):
        return NONE if math.isnan(value) else "∞" if value > 0 else "−∞"
    return _general(value) if shown.format == "General" else _format_number(value, shown.format)


def _general(value: float) -> str:
    text = number_text(value)
    return text if len(text) <= _LONGEST else f"{value:.9g}"


def _format_number(value: float, number_format: str) -> str:
    if number_format == NOISE:
        return "noise"
    if number_format.startswith(AT_LEAST):
        return f"at least {_format_number(value, number_format.removeprefix(AT_LEAST))}"
    found = _FORMAT.fullmatch(number_format)
    if found is None:
        raise ValueError(f"no number format of a result sheet: {number_format!r}")
    decimals, ending = len(found["decimals"] or ""), found["ending"]
    if ending == "E+00":
        return f"{value:.{decimals}e}"
    if ending == "%":
        return f"{_round(100.0 * value, decimals):.{decimals}f} %"
    value = _round(value, decimals)
    return f"{value:,.{decimals}f}" if found["grouped"] else f"{value:.{decimals}f}"


def _round(value: float, decimals: int) -> float:
    return round(value, decimals) + 0.0  # no negative zero
