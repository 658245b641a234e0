"""Functions whose values depend on the workbook they stand in: dates, and character sets."""

from __future__ import annotations

from dataclasses import replace
from functools import cache, partial

from xlmc.functions import Function

__all__ = ["as_set"]


@cache
def as_set(function: Function, date1904: bool, macintosh: bool) -> Function:
    """The function as a workbook with these settings has it; the same object each time, so that nodes are shared."""
    if function.dated:
        return replace(function, body=partial(function.body, date1904=date1904))
    if macintosh and function.name in ("CHAR", "CODE"):
        return replace(function, body=partial(function.body, macintosh=True))
    return function
