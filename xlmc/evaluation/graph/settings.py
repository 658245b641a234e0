"""Functions whose values depend on the workbook they stand in: dates, and character sets."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import Any

from xlmc.functions import Function

__all__ = ["as_set"]


@dataclass(frozen=True, slots=True)
class _Settled:
    """The body of a row with one of its options settled. It is pickled with the row, of which only the name is."""

    row: Function
    option: str
    value: bool

    def __call__(self, *arguments: Any) -> Any:
        return self.row.body(*arguments, **{self.option: self.value})


@cache
def as_set(function: Function, date1904: bool, macintosh: bool) -> Function:
    """The function as a workbook with these settings has it; the same object each time, so that nodes are shared."""
    if function.dated:
        return replace(function, body=_Settled(function, "date1904", date1904))
    if macintosh and function.macintosh:
        return replace(function, body=_Settled(function, "macintosh", macintosh))
    return function
