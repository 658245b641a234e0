"""Functions of dates, told from which year the workbook counts."""

from __future__ import annotations

from dataclasses import replace
from functools import cache, partial

from xlmc.functions import Function

__all__ = ["dated"]


@cache
def dated(function: Function, date1904: bool) -> Function:
    """The function as a workbook of that date system has it; the same object each time, so that nodes are shared."""
    return replace(function, body=partial(function.body, date1904=date1904)) if function.dated else function
