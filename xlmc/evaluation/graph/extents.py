"""How far ranges that go on beyond the last filled cell are read: as far as what is done with them needs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from xlmc.address import Area

__all__ = ["as_filled", "beyond", "by_halves", "leveled", "one_behind", "one_further", "sized"]


def leveled(direct: Mapping[int, Sequence[Area]]) -> dict[int, list[Area]]:
    """The areas of arguments, as long as each other where they are of one size with their further cells; else not."""
    rows = _lengths((area.rows, area.whole.rows) for areas in direct.values() for area in areas)
    columns = _lengths((area.columns, area.whole.columns) for areas in direct.values() for area in areas)
    return {
        i: [sized(sized(a, rows[a.whole.rows], False), columns[a.whole.columns], True) for a in areas]
        for i, areas in direct.items()
    }


def _lengths(sizes: Iterable[tuple[int, int]]) -> dict[int, int]:
    """Size with the further cells -> how far to read; larger sizes are read further."""
    longest: dict[int, int] = {}
    for held, whole in sizes:
        longest[whole] = max(held, longest.get(whole, 0))
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


def sized(area: Area, length: int, across: bool) -> Area:
    """The area with so many rows, or columns, read; the rest of its size is further ones."""
    whole = area.whole
    if across:
        right = area.left + length - 1
        return replace(area, right=right, further_columns=max(0, whole.right - right))
    bottom = area.top + length - 1
    return replace(area, bottom=bottom, further_rows=max(0, whole.bottom - bottom))


def one_behind(area: Area, length: int, across: bool) -> Area:
    """The row, or column, behind so many."""
    if across:
        return Area(area.sheet, area.top, area.left + length, area.bottom, area.left + length)
    return Area(area.sheet, area.top + length, area.left, area.top + length, area.right)


def as_filled(area: Area) -> Area:
    return area.filled


def one_further(area: Area) -> Area:
    """With the first further row and column."""
    rows, columns = area.rows + (area.further_rows > 0), area.columns + (area.further_columns > 0)
    return sized(sized(area, rows, False), columns, True)


def by_halves(area: Area) -> Area:
    """As far as a search by halves comes, which steps back from empty cells."""
    rows = _halved(area.rows, area.whole.rows, 0 if area.further_columns else area.columns)
    columns = _halved(area.columns, area.whole.columns, 0 if area.further_rows else area.rows + 1)
    return sized(sized(area, rows, False), columns, True)


def _halved(held: int, whole: int, least: int) -> int:
    """The end of a search of `whole` cells once its middle is among the first `held`; a range keeps its long side."""
    if held == whole:
        return held
    end = whole
    while (middle := (end - 1) // 2) >= max(held, least):
        end = middle
    return end
