"""What the formulas of a workbook need, cell by cell, without a list of its own for each range.

Many formulas read one column: all of it, or down to their own row. A `Strip` lists what counts in a column or row once,
and a range of it is a `Stretch`: from one index of that list to another. A range of a few columns is a stretch of each;
larger tables are listed once each.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterator, Mapping, Set
from dataclasses import dataclass, field
from itertools import chain

from xlmc.excel.address import Area, Cell

__all__ = ["Needs", "Part", "Stretch", "Strips"]

_SHORTEST = 64
"""Cells of a range that is worth a stretch."""

_NARROW = 8
"""Columns, or rows, of a range that is worth a stretch of each."""


@dataclass(eq=False, slots=True)
class _Span:
    """Indices that have a property which they do not lose: the longest run of them that is known."""

    start: int = 0
    stop: int = 0

    def outside(self, start: int, stop: int) -> tuple[range, range]:
        """Return the indices from `start` to before `stop` that are not known to have it."""
        return range(start, min(stop, self.start)), range(max(start, self.stop), stop)

    def add(self, start: int, stop: int) -> None:
        """Note that these have it too."""
        if start <= self.stop and self.start <= stop:
            self.start, self.stop = min(start, self.start), max(stop, self.stop)
        elif stop - start > self.stop - self.start:
            self.start, self.stop = start, stop


@dataclass(eq=False, slots=True)
class _Strip:
    """The cells of a column, or of a row, that count: in order, with their rows or columns."""

    cells: list[Cell]
    at: list[int]
    ordered: _Span = field(default_factory=_Span)
    constant: _Span = field(default_factory=_Span)


@dataclass(frozen=True, eq=False, slots=True)
class Stretch:
    """The cells that count of a range of one column or row."""

    strip: _Strip
    start: int
    stop: int

    def __iter__(self) -> Iterator[Cell]:
        return map(self.strip.cells.__getitem__, range(self.start, self.stop))

    def __contains__(self, cell: object) -> bool:
        if not isinstance(cell, Cell):
            return False
        index = bisect_left(self.strip.cells, cell, self.start, self.stop)
        return index < self.stop and self.strip.cells[index] == cell

    @property
    def key(self) -> tuple[int, ...]:
        """What stretches of the same cells have in common."""
        return id(self.strip), self.start, self.stop

    def waiting(self) -> Iterator[Cell]:
        """Return the cells that are not in order yet, and perhaps some that are."""
        indices = chain(*self.strip.ordered.outside(self.start, self.stop))
        return map(self.strip.cells.__getitem__, indices)

    def note_ordered(self) -> None:
        """Note that all of them are in order."""
        self.strip.ordered.add(self.start, self.stop)

    def varies(self, varying: Set[Cell]) -> bool:
        """Whether any is among the cells that vary, once this is known of all of them."""
        cells, constant = self.strip.cells, self.strip.constant
        for indices in constant.outside(self.start, self.stop):
            value = next((index for index in indices if cells[index] in varying), None)
            constant.add(indices.start, indices.stop if value is None else value)
            if value is not None:
                return True
        return False


Part = tuple[Cell, ...] | Stretch


class Strips:
    """The cells that count in ranges, each column, row and table looked through once.

    Args:
        counts: whether a cell counts.
        filled: the cells of a large area that may count.
        last: the last row and column of a sheet that may hold such a cell.
    """

    def __init__(
        self,
        counts: Callable[[Cell], bool],
        filled: Callable[[Area], Iterator[Cell]],
        last: Callable[[str], tuple[int, int]],
    ) -> None:
        self._counts, self._filled, self._last = counts, filled, last
        self._strips: dict[tuple[str, int, int], _Strip] = {}
        self._tables: dict[Area, tuple[Cell, ...]] = {}

    def of(self, area: Area) -> Iterator[Part]:
        """Return the cells of an area that count; of a narrow one column by column, or row by row."""
        if area.rows * area.columns >= _SHORTEST and area.columns <= _NARROW:
            for column in range(area.left, area.right + 1):
                yield self._stretch(self._column(area.sheet, column), area.top, area.bottom)
            return
        if area.rows * area.columns >= _SHORTEST and area.rows <= _NARROW:
            for row in range(area.top, area.bottom + 1):
                yield self._stretch(self._row(area.sheet, row), area.left, area.right)
            return
        if area not in self._tables:
            self._tables[area] = tuple(filter(self._counts, self._filled(area)))
        yield self._tables[area]

    def _column(self, sheet: str, column: int) -> _Strip:
        key = sheet, 0, column
        if key not in self._strips:
            cells = self._counted(Area(sheet, 1, column, self._last(sheet)[0], column))
            self._strips[key] = _Strip(cells, [cell.row for cell in cells])
        return self._strips[key]

    def _row(self, sheet: str, row: int) -> _Strip:
        key = sheet, row, 0
        if key not in self._strips:
            cells = self._counted(Area(sheet, row, 1, row, self._last(sheet)[1]))
            self._strips[key] = _Strip(cells, [cell.column for cell in cells])
        return self._strips[key]

    def _counted(self, area: Area) -> list[Cell]:
        return list(filter(self._counts, self._filled(area)))

    def _stretch(self, strip: _Strip, first: int, last: int) -> Stretch:
        return Stretch(strip, bisect_left(strip.at, first), bisect_right(strip.at, last))


class Needs(Mapping[Cell, tuple[Cell, ...]]):
    """Formula cell -> the cells that it needs and that hold a formula or are inputs. They are kept in parts."""

    def __init__(self) -> None:
        self.parts: dict[Cell, tuple[Part, ...]] = {}

    def __getitem__(self, cell: Cell) -> tuple[Cell, ...]:
        return tuple(self.of(cell))

    def __iter__(self) -> Iterator[Cell]:
        return iter(self.parts)

    def __len__(self) -> int:
        return len(self.parts)

    def of(self, cell: Cell) -> Iterator[Cell]:
        """Return the cells that a formula cell needs, one by one."""
        return chain.from_iterable(self.parts[cell])

    def names(self, cell: Cell, need: Cell) -> bool:
        """Whether one cell's formula names another one, or has it in a range."""
        return any(need in part for part in self.parts[cell])

    def linked(self) -> tuple[list[Part], dict[Cell, list[int]]]:
        """Return the different parts, and the indices of those of each cell: formulas that read one range
        share a part.
        """
        result: list[Part] = []
        numbers: dict[tuple[int, ...], int] = {}
        links: dict[Cell, list[int]] = {}
        for cell, parts in self.parts.items():
            keys = [part.key if isinstance(part, Stretch) else (id(part),) for part in parts]
            for key, part in zip(keys, parts, strict=True):
                if key not in numbers:
                    numbers[key] = len(result)
                    result.append(part)
            links[cell] = [numbers[key] for key in keys]
        return result, links
