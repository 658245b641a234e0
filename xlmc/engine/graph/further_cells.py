"""What stands for the further cells of a range that goes on beyond the last filled cell, as a whole column does.

It says how far such ranges are read (as far as the function needs), and refuses them where nothing can stand for their
empty cells.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from typing import Final

import numpy as np

from xlmc.errors import FormulaError
from xlmc.excel.address import Area
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.budget import TooLargeError
from xlmc.excel.functions.registry import Anything, Number
from xlmc.excel.functions.values import Floats, Value

__all__ = [
    "beyond",
    "by_halves",
    "keep_within",
    "level",
    "one_behind",
    "one_further",
    "refusal",
    "resize",
    "to_filled",
    "to_the_last",
]

_MESSAGE: Final = (
    "{} is given a whole column or row, or a range that goes on far beyond the last filled cell; xlmc cannot take all "
    "its empty cells there"
)
_HINT: Final = "name only the rows and columns that hold something"


def level(direct: Mapping[int, Sequence[Area]]) -> dict[int, list[Area]]:
    """Read the areas equally far where they have one size with their further cells; else read them differently far."""
    rows = _lengths((area.rows, area.whole.rows) for areas in direct.values() for area in areas)
    columns = _lengths((area.columns, area.whole.columns) for areas in direct.values() for area in areas)
    return {
        i: [resize(resize(a, rows[a.whole.rows], False), columns[a.whole.columns], True) for a in areas]
        for i, areas in direct.items()
    }


def _lengths(sizes: Iterable[tuple[int, int]]) -> dict[int, int]:
    """How far to read areas of each size, further cells included; larger sizes are read further."""
    longest: dict[int, int] = {}
    for filled_count, whole in sizes:
        longest[whole] = max(filled_count, longest.get(whole, 0))
    last = 0
    for whole in sorted(longest):
        longest[whole] = last = max(longest[whole], last + 1)
    return longest


def beyond(area: Area) -> Area:
    """One of the further cells of a range."""
    row, column = area.top, area.left
    if area.further_rows:
        row = area.bottom + 1
    else:
        column = area.right + 1
    return Area(area.sheet, row, column, row, column)


def resize(area: Area, length: int, across: bool) -> Area:
    """Return the area with `length` rows, or columns, read; all others become further ones."""
    whole = area.whole
    if across:
        right = area.left + length - 1
        return replace(area, right=right, further_columns=max(0, whole.right - right))
    bottom = area.top + length - 1
    return replace(area, bottom=bottom, further_rows=max(0, whole.bottom - bottom))


def one_behind(area: Area, length: int, across: bool) -> Area:
    """Return the row, or column, behind the first `length`."""
    if across:
        return Area(area.sheet, area.top, area.left + length, area.bottom, area.left + length)
    return Area(area.sheet, area.top + length, area.left, area.top + length, area.right)


def to_filled(area: Area) -> Area:
    return area.filled


def one_further(area: Area) -> Area:
    """Return the area with the first further row and column."""
    rows, columns = area.rows + (area.further_rows > 0), area.columns + (area.further_columns > 0)
    return resize(resize(area, rows, False), columns, True)


def by_halves(area: Area) -> Area:
    """Return the area as far as a search by halves comes, which steps back from empty cells."""
    rows = _halve(area.rows, area.whole.rows, 0 if area.further_columns else area.columns)
    columns = _halve(area.columns, area.whole.columns, 0 if area.further_rows else area.rows + 1)
    return resize(resize(area, rows, False), columns, True)


def _halve(filled_count: int, whole: int, least: int) -> int:
    """Return the end of a search of `whole` cells once its middle is below `filled_count`, and no less than `least`.

    With `least` a range keeps its long side.
    """
    if filled_count == whole:
        return filled_count
    end = whole
    while (middle := (end - 1) // 2) >= max(filled_count, least):
        end = middle
    return end


def refusal(name: str) -> FormulaError:
    """Return the error of a function that cannot be given a whole column."""
    return FormulaError(_MESSAGE.format(name), hint=_HINT)


@cache
def keep_within(filled_count: int, whole: int, zero_is_all: bool) -> Function:
    """Make a function that makes `filled_count` of numbers of rows or columns above it, up to `whole`."""
    body = partial(_within, filled_count=filled_count, whole=whole, zero_is_all=zero_is_all)
    return Function(f"within {filled_count} of {whole}", (Anything,), body, Kind.NUMBER)


@cache
def to_the_last(filled_count: int, whole: int) -> Function:
    """Make a function that makes `whole` of numbers of rows or columns above `filled_count`."""
    return Function(
        f"{filled_count} or {whole}", (Number,), partial(_of_whole, filled_count=filled_count, whole=whole), Kind.NUMBER
    )


def _of_whole(numbers: Floats, filled_count: int, whole: int) -> Floats:
    return np.where(numbers > filled_count, float(whole), numbers)


def _within(given: Value, filled_count: int, whole: int, zero_is_all: bool) -> Value:
    numbers, errors = given.to_numbers()
    if zero_is_all and ((np.trunc(numbers) == 0) & (errors == 0)).any():
        raise TooLargeError(_MESSAGE.format("INDEX with row or column 0"), hint=_HINT)
    return Value.of_numbers(np.where(numbers < whole + 1, np.minimum(numbers, filled_count), numbers), errors)
