"""Excel number formats that show no more decimals than a standard error supports, as `format_estimate` prints them.

A cell keeps its full number; only what it shows is cut. Excel cannot show a number rounded to tens, so one whose error
is larger than a unit shows its units too, with the error beside it.
"""

from __future__ import annotations

import math

from xlmc.statistics import Estimate

__all__ = ["COUNT", "NOISE", "exact", "paired", "share_paired"]

COUNT = "#,##0"

NOISE = '"noise";"noise";"noise"'
"""Of a number that is no more than noise: the word stands for it."""

_DIGITS = 6
"""Significant digits where no error limits them."""

_ROOM = 9
"""Characters that columns have room for; fewer decimals are shown rather than `###`."""

_LARGEST, _SMALLEST = 1e7, 1e-4
"""Beyond these a number is shown with a power of ten."""


def paired(estimate: Estimate) -> str:
    """For a value with its error in a cell of its own: two digits of the error."""
    if estimate.error == 0.0:
        return "General"
    return _format(estimate.value, _paired_decimals(estimate))


def share_paired(estimate: Estimate) -> str:
    """`paired` for a share, in percent."""
    decimals = _paired_decimals(estimate)
    return "0" + _fraction(max((4 if decimals is None else decimals) - 2, 0)) + "%"


def exact(spread: float) -> str:
    """For single trials: four digits of their spread."""
    return _format(spread, 3 - _exponent(spread)) if _usable(spread) else "General"


def _paired_decimals(estimate: Estimate) -> int | None:
    return 1 - _exponent(estimate.error) if estimate.error and _usable(estimate.error) else None


def _format(value: float, decimals: int | None) -> str:
    if not math.isfinite(value):
        return "General"
    if decimals is None:
        if value == 0.0:
            return "General"
        decimals = _DIGITS - 1 - _exponent(value)
    size = max(abs(value), 10.0**-decimals)
    if not _SMALLEST <= size < _LARGEST:
        return "0" + _fraction(min(max(decimals + _exponent(size), 0), 3)) + "E+00"
    room = _ROOM - len(f"{value:,.0f}") - 1
    return "#,##0" + _fraction(max(min(decimals, room), 0))


def _fraction(decimals: int) -> str:
    return "." + "0" * decimals if decimals else ""


def _usable(number: float) -> bool:
    return number != 0.0 and math.isfinite(number)


def _exponent(number: float) -> int:
    """The power of ten of a number rounded to two digits: 0.00996 -> -2."""
    return int(f"{number:.1e}".partition("e")[2])
