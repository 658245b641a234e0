"""Every formula of a workbook, computed once from the values that are typed into its cells.

What Excel saved stays where it is right. Formulas are computed anew where it is not, where nothing is saved, where a
cell was changed, and wherever one of these is read.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final

from xlmc.engine.graph.lowering import Lowering, lower_until_complete
from xlmc.engine.graph.moment import Moment
from xlmc.engine.saved_values import array_of, faults_of, filled_cells, is_saved_value, same_value
from xlmc.errors import Notice
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver, build_graph
from xlmc.excel.formula.graph import Graph, reached
from xlmc.excel.formula.precedents import mentioned_cells
from xlmc.excel.workbook.lazy_sheets import with_contents, with_values
from xlmc.excel.workbook.places import changeable_cell
from xlmc.excel.workbook.workbook import CellValue, Workbook

__all__ = ["Calculation", "Calculator", "calculated"]

DEPENDS: Final = "the formula depends on a cell that could not be computed"
_OTHERWISE_EACH_TIME: Final = "the formula has another value each time"
_WHAT_IF: Final = "what-if tables are not computed"


@dataclass(frozen=True, slots=True)
class Calculation:
    """The values of a workbook's formulas.

    Attributes:
        values: of the formula cells, and of those that array formulas fill, whose value is not what the file holds.
        unknown: the cells that have no value now -> why.
        kept: those that could not be computed and keep what Excel saved -> why.
    """

    values: Mapping[Cell, CellValue]
    unknown: Mapping[Cell, str]
    kept: Mapping[Cell, str]

    @property
    def notices(self) -> Iterator[Notice]:
        """Yield what could not be computed, cell by cell, with the reason."""
        for message, cells in (("the saved value stays", self.kept), ("it has no value", self.unknown)):
            yield from (Notice(f"{why}; {message}", cell) for cell, why in cells.items())

    def of(self, book: Workbook) -> Workbook:
        """Return the workbook with these values."""
        cells = {**self.values, **dict.fromkeys(self.unknown, None)}
        contents = {cell: replace(book.content(cell), value=value) for cell, value in cells.items()}
        return replace(with_contents(book, contents), may_be_stale=False, notices=(*book.notices, *self.notices))


class Calculator:
    """Computes the formulas of a workbook, once or with many changes of the same cells.

    Args:
        book: as it was read.
        changing: the cells that will be changed: none holds a formula, or is filled by one.
        volatile: compute NOW, TODAY, RAND and RANDBETWEEN, too, which Excel computes anew each time.
    """

    def __init__(self, book: Workbook, changing: Collection[Cell] = (), *, volatile: bool = False) -> None:
        self._book, self._moment = book, Moment() if volatile else None
        self._formulas = list(book.formula_cells())
        self._what_if = {cell for table in book.data_tables for cell in table.area.cells()}
        given = {cell: book.content(cell).value for cell in {*changing, *self._what_if}}
        self._audit = self._lowered(book, self._formulas, given, audit=True)
        self._users = self._all_users(given.keys())
        self._faults = faults_of(self._audit, _OTHERWISE_EACH_TIME)
        stale = [cell for cell in self._audit.graph.formulas if not self._is_right(cell)]
        self._stale = self._downstream(stale) - self._what_if
        self._changing = self._downstream(self._with_what_if(changing)) if changing else frozenset()
        self._changed = frozenset(changing)

    @property
    def reached(self) -> frozenset[Cell]:
        """The cells that depend on those that will be changed."""
        return self._changing - self._changed

    def calculate(
        self, changes: Mapping[Cell, CellValue] | None = None, wanted: Collection[Cell] | None = None
    ) -> Calculation:
        """Compute the formulas that have no right value.

        Args:
            changes: cell -> what is typed into it.
            wanted: the cells whose values are of interest; all where None.
        """
        book = with_values(self._book, changes) if changes else self._book
        what_if = self._changing & self._what_if
        again = (self._stale | self._changing) - self._changed - what_if
        targets = [cell for cell in self._formulas if cell in again and (wanted is None or cell in wanted)]
        right = {
            cell: book.content(cell).value
            for cell in self._audit.graph.formulas
            if cell not in again and not self._fills(cell)
        }
        lowering = self._lowered(book, targets, right, audit=False)
        faults = {cell: why for cell, why in self._faults.items() if cell not in again}
        faults |= faults_of(lowering, _OTHERWISE_EACH_TIME)
        faults |= dict.fromkeys(what_if, _WHAT_IF)
        lost = dict.fromkeys(cell for cell in faults if self._loses_value(cell))
        unknown = dict.fromkeys(sorted(self._downstream(lost)), DEPENDS) if lost else {}
        kept = {cell: why for cell, why in faults.items() if cell not in lost}
        for cell in [cell for cell in unknown if cell not in lost and not self._loses_value(cell)]:
            kept[cell] = unknown.pop(cell)
        unknown |= {cell: faults[cell] for cell in lost}
        values = {
            place: value
            for cell in lowering.graph.formulas
            if cell in again and cell not in faults and cell not in unknown and cell not in kept
            for place, value in self._new_values(lowering, cell)
        }
        if wanted is None:
            kept |= dict(_kept_tables(book, what_if))
        return Calculation(values, unknown, dict(sorted(kept.items())))

    def _lowered(
        self, book: Workbook, cells: Iterable[Cell], given: Mapping[Cell, CellValue], *, audit: bool
    ) -> Lowering:
        """Lower formulas; nothing varies, so that every node is a constant."""
        resolver, targets = Resolver(book, strict=False), list(cells)
        values: Mapping[Cell, float] = given  # type: ignore[assignment]  # a value of any type does

        def lower(more: Mapping[Cell, set[Cell]]) -> Lowering:
            graph = build_graph(resolver, targets, frozenset(), frozenset(given), more=more, strict=False)
            return Lowering(graph, {}, values, audit=audit, strict=False, moment=self._moment)

        return lower_until_complete(lower)

    def _all_users(self, given: Collection[Cell]) -> dict[Cell, list[Cell]]:
        """Return each cell -> the formula cells that read it; also those that cannot be read, by what they mention."""
        graph: Graph = self._audit.graph
        users: dict[Cell, list[Cell]] = {}
        for cell in graph.needs:
            for need in graph.needs.of(cell):
                users.setdefault(need, []).append(cell)
        cells = {*self._formulas, *given}
        for cell in graph.faults:
            for need in mentioned_cells(self._book, cell, cells):
                users.setdefault(need, []).append(cell)
        return users

    def _downstream(self, start: Iterable[Cell]) -> frozenset[Cell]:
        """Return these cells, what array formulas in them fill, and all that depends on either."""
        return frozenset(reached(start, lambda cell: (*self._users.get(cell, ()), *array_of(self._book, cell))))

    def _with_what_if(self, changing: Collection[Cell]) -> set[Cell]:
        """Return the changing cells, and those of the what-if tables that depend on them."""
        cells, before = set(changing), -1
        while before != len(cells):
            before, reached = len(cells), self._downstream(cells)
            for table in self._book.data_tables:
                if any(cell in reached for cell in (*table.margins(), *table.inputs)):
                    cells |= set(table.area.cells())
        return cells

    def _fills(self, cell: Cell) -> bool:
        """Return whether an array formula stands in a cell, or fills it: others may read all of it."""
        formula = self._book.content(cell).formula
        return formula is None or formula.array is not None

    def _is_right(self, cell: Cell) -> bool:
        """Return whether what is saved is what the formula gives, or is all that there is of it."""
        saved = self._book.content(cell).value
        if cell in self._faults:
            return saved is not None
        if self._book.content(cell).formula is None:
            return True  # its array formula looks at it
        value = self._audit.value(cell)
        if value is None or not is_saved_value(self._audit, cell, saved, value.objects().ravel()[0]):
            return False
        return all(same_value(self._book.content(at).value, got) for at, got in filled_cells(self._audit, cell))

    def _loses_value(self, cell: Cell) -> bool:
        """Return whether a cell that cannot be computed has no value: none is saved, or that is of other inputs."""
        return cell in self._changing or self._book.content(cell).value is None

    def _new_values(self, lowering: Lowering, cell: Cell) -> Iterator[tuple[Cell, CellValue]]:
        """Yield the values of a formula, in its own cell and in those that it fills, where other ones are saved."""
        if self._book.content(cell).formula is None:
            return
        value = lowering.value(cell)
        got: CellValue = None if value is None else value.objects().ravel()[0]
        if not is_saved_value(lowering, cell, self._book.content(cell).value, got):
            yield cell, got
        for place, filled in filled_cells(lowering, cell):
            if not same_value(self._book.content(place).value, filled):
                yield place, filled  # type: ignore[misc]  # what a cell holds


def calculated(book: Workbook, changes: Mapping[str, CellValue], *, volatile: bool) -> Workbook:
    """Compute every formula; see `xlmc.engine.calculate`."""
    typed = {changeable_cell(book, place): value for place, value in changes.items()}
    calculation = Calculator(book, typed, volatile=volatile).calculate(typed)
    return calculation.of(with_values(book, typed) if typed else book)


def _kept_tables(book: Workbook, lost: Collection[Cell]) -> Iterator[tuple[Cell, str]]:
    for table in book.data_tables:
        corner = Cell(table.area.sheet, table.area.top, table.area.left)
        if corner not in lost:
            yield corner, _WHAT_IF
