"""Lowers the cells of a graph in which cells need themselves: as they are read, or to be iterated."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Collection, Iterable, Mapping, Sequence

from xlmc.engine.graph.circles import Iterates, lower_as_read
from xlmc.engine.graph.computed_references import NotYetNeeded
from xlmc.engine.graph.dag import Dag
from xlmc.engine.graph.expressions import ExpressionLowering
from xlmc.engine.graph.iteration import IteratedCells, in_order, iterate_cells
from xlmc.engine.graph.running_totals import RunningTotals
from xlmc.errors import FormulaError, Notice
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import Filled, Graph, ir

__all__ = ["CircleLowering"]


class CircleLowering(ExpressionLowering):
    """Lowers formula cells in the order in which their values are read.

    Args:
        graph: the needed cells.
        dag: takes the nodes.
        totals: of long ranges.
        audit: a cell that reads itself is a fault, or reads what Excel saved, where the workbook has it iterated.
        strict: cells that cannot be computed are refused; otherwise they are faults.
        one_trial: such a cell is an error, and no reason to refuse the cells.

    Attributes:
        circle: cells that are being lowered and were asked for meanwhile.
        iterated: the circles whose cells are computed iteratively.
        notices: what the person should know.
    """

    def __init__(
        self, graph: Graph, dag: Dag, totals: RunningTotals, *, audit: bool, strict: bool, one_trial: bool
    ) -> None:
        super().__init__(graph, dag, totals, audit=audit)
        self.circle: set[Cell] = set()
        self.iterated: list[IteratedCells] = []
        self.notices: list[Notice] = []
        self._strict, self._one_trial, self._iteration = strict, one_trial, graph.workbook.iteration
        self._circles = {} if audit and self._iteration else graph.circles
        self._cells: dict[Cell, int] = {}
        self._computed: dict[Cell, int] = {}
        self._arrays: dict[Cell, int] = {}

    @abstractmethod
    def _set(self, cell: Cell, node: int) -> None:
        """Note the node of a formula cell, and what other formulas read of it."""

    @abstractmethod
    def _lower_placed(self, cell: Cell, placed: ir.Expression | Filled) -> int:
        """The node of a formula cell."""

    @abstractmethod
    def lower_cell(self, cell: Cell, tree: ir.Expression) -> int:
        """The node of a formula cell; its saved value where xlmc cannot compute it."""

    @abstractmethod
    def _hold_saved(self, cell: Cell, fault: FormulaError) -> int:
        """The node of what Excel saved in a formula cell."""

    def is_lowered(self, cell: Cell) -> bool:
        """Whether the node of a formula cell is there."""
        return cell in self._computed or cell not in self.graph.formulas.ordered

    def lower_next(self, cell: Cell) -> Collection[Cell]:
        """Lower a formula cell; if that asks for others that are not lowered, return these instead."""
        try:
            self._set(cell, self._lower_placed(cell, self.graph.formulas.ordered[cell]))
        except NotYetNeeded as needed:
            self.calls.next_formula()
            return needed.cells
        return ()

    def forget(self, cell: Cell) -> None:
        """Have a formula cell lowered again."""
        for known in (self._computed, self._cells, self._arrays):
            known.pop(cell, None)

    def node_of(self, cell: Cell) -> int:
        """The node of a formula cell that is lowered."""
        return self._computed[cell]

    def refuse(self, cells: Sequence[Cell], error: FormulaError) -> None:
        """Take cells for faulty that need each other in a circle; of many trials raise the error, or iterate."""
        if self._iteration is not None and cells[0] in self._circles:
            raise Iterates(cells[0])
        if self._strict and not self._one_trial:
            raise error
        for cell in cells:
            self._set(cell, self.dag.circle() if self._strict else self._hold_saved(cell, error))

    def tell_circle(self, cell: Cell) -> None:
        """Note that some trials may read a cell while it is computed."""
        if self._iteration is not None:
            raise Iterates(cell)
        said = "trials in which this cell needs itself in a circle are errors, #CALC!"
        self.notices.append(Notice(said, cell))

    def iterate(self, cell: Cell) -> None:
        """Lower the cells of the circle that a cell is in, to be computed again and again."""
        assert self._iteration is not None
        graph, book = self.graph, self.graph.workbook
        cells = in_order(book.sheets, [each for each, fault in graph.circles.items() if fault is graph.circles[cell]])
        self.circle.clear()
        for each in [*cells, *(each for each, node in self._computed.items() if node in self.dag.missing)]:
            self.forget(each)
        lower_as_read([need for each in cells for need in graph.needs.of(each) if need not in set(cells)], self)
        saved = [book.content(each).value for each in cells]
        found = iterate_cells(self.dag, cells, saved, self._iteration, self._lower_iterated)
        for each, node in zip(found.cells, found.nodes, strict=True):
            self._set(each, node)
        self.iterated.append(found)
        self.notices.append(found.notice(self._iteration))

    def _lower_iterated(self, parameters: Mapping[Cell, int]) -> list[int]:
        """The nodes of the formulas of cells, read as what stands for them."""
        known = dict(self._ranges)
        self._cells |= parameters
        results = []
        for cell in parameters:
            results.append(self.lower_cell(cell, self.graph.formulas[cell]))
            self.dag.host_ends(cell)
        self._ranges = known
        for cell in parameters:
            if self.dag.sizes[self._arrays.pop(cell)] is not None:
                raise FormulaError("an array formula is in a circle", where=cell, hint="break the circle")
        return results

    def not_there(self, area: Area) -> Collection[Cell]:
        """The cells of an area that are in a circle and have no value yet."""
        known, missing = self._cells, self.dag.missing
        return {c for c in self._circles if c in area and (c not in known or known[c] in missing)}

    def read_first(self, cells: Iterable[Cell]) -> None:
        """Ask for all cells that must be lowered first."""
        if not self._circles:
            return
        ordered, known = self.graph.formulas.ordered, self._cells
        waiting = [cell for cell in cells if cell in ordered and cell not in known and cell not in self.circle]
        if waiting:
            raise NotYetNeeded(waiting)
