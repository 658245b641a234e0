"""What stands in a cell of a result sheet: a text or a number, how the number shows, how the cell looks."""

from __future__ import annotations

from dataclasses import dataclass

from xlmc.report import number_format
from xlmc.statistics import Estimate

__all__ = ["BLANK", "NONE", "Shown", "count", "digits_of", "estimate", "exact", "interval", "share", "text"]


@dataclass(frozen=True, slots=True)
class Shown:
    """The content of one cell; None is an empty one."""

    value: str | float | None
    format: str = "General"
    look: str = "number"


BLANK = Shown(None)

NONE = "–"
"""Where there is no number to show."""


def text(value: str, look: str = "text") -> Shown:
    """A text as it is, also where it begins with `=`."""
    return Shown(value, look=look)


def exact(value: float | None, number: str = "General") -> Shown:
    """A number that has no error: a setting, the base case."""
    return Shown(value, number)


def count(value: int) -> Shown:
    """Trials."""
    return Shown(value, number_format.COUNT)


def estimate(
    found: Estimate, look: str = "number", error_look: str = "error", *, like: Estimate | None = None
) -> list[Shown]:
    """Two cells: the value, and its standard error in the same digits; without an error, in those of `like`."""
    digits = number_format.paired(like if found.error is None and like is not None else found)
    return [Shown(found.value, digits, look), _error(found.error, digits, error_look)]


def share(found: Estimate) -> list[Shown]:
    """Two cells: a share of trials and its standard error, in percent."""
    digits = number_format.share_paired(found)
    return [Shown(found.value, digits), _error(found.error, digits, "error")]


def interval(found: Estimate, *, percent: bool = False) -> list[Shown]:
    """Two cells: the ends of the 95 % interval, in the digits of the value."""
    digits = number_format.share_paired(found) if percent else number_format.paired(found)
    low, high = found.interval or (None, None)
    return [_error(low, digits, "error"), _error(high, digits, "error")]


def digits_of(found: Estimate) -> str:
    """The number format of a value beside its error, for numbers to be compared with it."""
    return number_format.paired(found)


def _error(value: float | None, digits: str, look: str) -> Shown:
    return Shown(NONE if value is None else value, digits, look)
