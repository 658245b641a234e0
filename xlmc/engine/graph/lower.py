"""The needed formula cells, lowered to nodes one after another.

Where xlmc cannot compute a cell, and no assumption reaches it, the value that Excel saved stands in.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from functools import cached_property
from typing import Final, TypeVar

from xlmc.engine.graph import lambdas
from xlmc.engine.graph.arrays import element
from xlmc.engine.graph.circle_lowering import CircleLowering
from xlmc.engine.graph.circles import CircleError, lower_as_read
from xlmc.engine.graph.computed_references import NotYetNeeded
from xlmc.engine.graph.dag import MANY, Dag
from xlmc.engine.graph.fill_down import FillDownCache
from xlmc.engine.graph.lowering import Scope
from xlmc.engine.graph.nodes import Apply, Constant, Input, Target
from xlmc.engine.graph.running_totals import RunningTotals
from xlmc.engine.graph.spilled_cells import refuse_cells_beyond, spilled_cell, unneeded_arrays
from xlmc.errors import ErrorCode, FormulaError, Notice
from xlmc.excel.address import Area, Cell, InFormula, host_of
from xlmc.excel.formula import Filled, Graph, Resolver, build_graph, ir
from xlmc.excel.formula.callables import gives_function
from xlmc.excel.formula.graph import Spills
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.logical import zero_if_blank
from xlmc.excel.functions.registry import Anything
from xlmc.excel.functions.values import Value, constant

__all__ = ["Lowering", "lower_cells", "lower_until_complete"]

L = TypeVar("L", bound="Lowering")

_SHOWN: Final = Function("shown", (Anything,), zero_if_blank, Kind.ANY, facts=Facts(unrounded=True))


def lower_until_complete(lower: Callable[[Mapping[Cell, set[Cell]]], L]) -> L:
    """Lower a graph; as long as OFFSET and its like lead to cells that it does not hold, lower it again with them.

    Args:
        lower: takes formula cell -> cells it turned out to need, and lowers a graph that holds these too.
    """
    more: dict[Cell, set[Cell]] = {}
    while True:
        lowering = lower(more)
        if not lowering.more:
            return lowering
        for cell, needed in lowering.more.items():
            more.setdefault(cell, set()).update(needed)


def lower_cells(
    resolver: Resolver, cells: Collection[Cell], inputs: Mapping[Cell, str], held: Mapping[Cell, float]
) -> Lowering:
    """What some cells need, lowered.

    Args:
        resolver: of the workbook.
        cells: that are wanted.
        inputs: assumption cell -> name of its input.
        held: cell -> the value of its own that it is held at.

    Raises:
        FormulaError: a needed cell cannot be computed.
    """

    def lower(more: Mapping[Cell, set[Cell]]) -> Lowering:
        return Lowering(build_graph(resolver, cells, frozenset(inputs), frozenset(held), more=more), inputs, held)

    return lower_until_complete(lower)


class Lowering(CircleLowering):
    """The nodes of every needed cell of a graph.

    Args:
        graph: the needed cells, in dependency order.
        inputs: the assumption cells and the names of their inputs; any other cell that holds a value is constant.
        held: cells held at a value of their own: frozen assumptions.
        audit: every formula reads what Excel saved in the cells it needs, so that each is checked on its own; one that
            cannot be computed is a fault, not an exception.
        one_trial: a cell that reads itself is an error, as in a trial of many, and no reason to refuse the cells.
        strict: a formula that cannot be computed and has no saved value is an exception; otherwise a fault, too.

    Attributes:
        graph, inputs, held: as given.
        saved: the cells that xlmc cannot compute, with the values that Excel saved.
        faults: these cells -> why it cannot.
        more: formula cell -> cells that OFFSET and its like turned out to need and the graph does not hold. Where there
            are any, the graph must be built again with them.
        led_to: formula cell -> inputs and formula cells that OFFSET and its like lead to.
        notices: what the person should know.
        circle: cells that are being lowered and were asked for meanwhile.
        iterated: the circles whose cells are computed iteratively.
    """

    def __init__(
        self,
        graph: Graph,
        inputs: Mapping[Cell, str],
        held: Mapping[Cell, float],
        *,
        audit: bool = False,
        one_trial: bool = False,
        strict: bool = True,
    ) -> None:
        dag = Dag(date1904=graph.workbook.date1904)
        trees = (placed for placed in graph.formulas.ordered.values() if not isinstance(placed, Filled))
        super().__init__(
            graph,
            dag,
            RunningTotals(dag, trees, self.cell),
            audit=audit,
            strict=strict and not audit,
            one_trial=one_trial,
        )
        self.inputs, self.held = inputs, held
        self.saved: dict[Cell, object] = {}
        self.faults: dict[Cell, FormulaError] = {}
        self.more: dict[Cell, set[Cell]] = {}
        self.led_to: dict[Cell, set[Cell]] = {}
        self._led: set[Cell] = set()
        self._complete: dict[Area, frozenset[Cell]] = {}
        self._spills = Spills(graph.workbook)
        self._cells = {cell: dag.input(name) for cell, name in inputs.items()}
        self._cells |= {cell: dag.constant(constant(value)) for cell, value in held.items()}
        self._fill_down = FillDownCache(dag)
        if self._circles:
            lower_as_read(graph.formulas.ordered, self)
        else:
            for cell, placed in graph.formulas.ordered.items():
                self._set(cell, self._lower_placed(cell, placed))

    def _set(self, cell: Cell, node: int) -> None:
        """Note the node of a formula cell, and what other formulas read of it."""
        self._computed[cell] = node
        self.dag.host_ends(cell)
        self.calls.next_formula()
        saved = self.graph.workbook.content(cell).value if self._audit and node not in self.dag.missing else None
        self._cells[cell] = node if saved is None else self._held_cell(cell)

    def cell(self, cell: Cell) -> int:
        """The node of a cell's value."""
        if cell not in self._cells:
            if cell in self.circle:
                return self.dag.circle()
            if self._circles and cell in self.graph.formulas.ordered:
                raise NotYetNeeded([cell])
            self._cells[cell] = self._held_cell(cell)
        return self._cells[cell]

    def array(self, cell: Cell) -> int:
        """The node of all that an array formula in a cell gives."""
        return self._arrays.get(cell, self.cell(cell))

    def spill(self, cell: Cell) -> int:
        """The node of the cells that an array formula fills; a cell shows 0 for an empty value."""
        node = self.array(cell)
        constant_ = isinstance(self.dag.nodes[node], Constant)
        return self.zero_if_blank(node) if constant_ else self.apply(_SHOWN, (node,))

    def is_saved(self, cell: Cell) -> bool:
        """Whether formulas see what Excel saved in a formula's cell, rather than what it gives."""
        return self._audit or cell in self.saved

    def target(self, target: Target) -> int:
        """The node of a target."""
        return self.first_cell(self.lower(target.tree, Scope(target.cell)))

    def known(self, target: Target) -> Value | None:
        """The target's value where no input reaches it; None where one does."""
        return self.lookup_constant(self.target(target))

    def value(self, cell: Cell) -> Value | None:
        """What a formula cell computes where that is constant; None where it is not."""
        return self.lookup_constant(self._computed[cell])

    def filled(self, cell: Cell, anchor: Cell) -> Value | None:
        """What the array formula of another cell puts into a cell, where that is constant; None where it is not."""
        return self.lookup_constant(self._filled_cell(cell, anchor))

    def last_step(self, cell: Cell) -> tuple[str, list[Value]] | None:
        """The function that a formula cell ends with, and its arguments, where all is constant; None otherwise."""
        node_id = self._computed[cell]
        node = self.dag.origins.get(node_id, self.dag.nodes[node_id])
        if not isinstance(node, Apply):
            return None
        known = [self.lookup_constant(argument) for argument in node.arguments]
        return (
            (node.function.name, values) if len(values := [v for v in known if v is not None]) == len(known) else None
        )

    @property
    def read(self) -> frozenset[Cell]:
        """Every cell that the targets read: formulas, inputs, constants, and blank cells of ranges."""
        unread = (self.inputs.keys() | self.held.keys()) - self.graph.reached
        return frozenset(self._cells) - unread

    def awaits(self, cell: Cell) -> bool:
        """Whether a cell must still be lowered before a formula can refer to it."""
        if cell in self.inputs or cell in self._computed:
            self._led.add(cell)
        if cell in self.inputs:
            return cell not in self.graph.reached
        if cell in self._cells or (self.graph.circles and cell in self.graph.formulas.ordered):
            return False  # those of a circle are asked for when they are read
        return self.graph.workbook.content(cell).formula is not None or self._spills.anchor(cell) is not None

    def awaited(self, area: Area) -> Sequence[Cell]:
        """The cells of an area that must still be lowered before a formula can refer to it.

        An area that awaits none is not looked through again: thousands of lookups may refer to the same columns.
        """
        known = self._complete.get(area)
        if known is not None:
            self._led |= known
            return ()
        before, self._led = self._led, set()
        missing = [cell for cell in area.cells() if self.awaits(cell)]
        if not missing and not self.graph.circles:
            self._complete[area] = frozenset(self._led)
        self._led |= before
        return missing

    @cached_property
    def resolver(self) -> Resolver:
        """Reads the references in texts."""
        return Resolver(self.graph.workbook, self.inputs, strict=False)

    def _lower_placed(self, cell: Cell, placed: ir.Expression | Filled) -> int:
        if not isinstance(placed, Filled):
            return self.lower_cell(cell, placed)
        stencil, cells = placed
        if self._audit or cell in self._circles:
            return self.lower_cell(cell, stencil.at(cell))
        known = self._cells
        leaves = [known[leaf] if leaf in known else self.cell(leaf) for leaf in cells]
        return self._fill_down.lower(stencil, leaves, lambda: self.lower_cell(cell, stencil.at(cell)))

    def lower_cell(self, cell: Cell, tree: ir.Expression) -> int:
        """The node of a formula cell; its saved value where xlmc cannot compute it."""
        formula = self.graph.workbook.content(host_of(cell)).formula
        self._led, self._unknown = set(), {}
        try:
            if cell in self.graph.faults:
                raise self.graph.faults[cell]
            if formula is None and not isinstance(cell, InFormula):
                return self._filled_cell(cell, tree)
            array = formula is not None and (formula.array is not None or formula.dynamic)
            node = self._lower_formula(tree, Scope(cell, array))
            self._arrays[cell] = node
            node = self._show(self.first_cell(node))
            self._tell_unknown(cell, self.lookup_constant(node))
        except NotYetNeeded as needed:
            if not self._wait_for_graph(cell, needed.cells):
                raise
            return self._held_cell(cell)  # only until the graph is built again
        except CircleError as error:
            self.refuse([cell], error.at(cell))
            return self._computed[cell]
        except FormulaError as error:
            return self._take_saved(cell, error)
        finally:
            self._unknown = None
        if self._led:
            self.led_to[cell] = self._led
        return node

    def _wait_for_graph(self, cell: Cell, needed: Collection[Cell]) -> bool:
        """Note the cells that a formula needs and does not name; whether there are any."""
        if self._circles:
            needed = [need for need in needed if not self.graph.needs.names(cell, need)]
        if needed:
            self.more.setdefault(cell, set()).update(needed)
        return bool(needed)

    def _tell_unknown(self, cell: Cell, value: Value | None) -> None:
        """Report the names and functions in a cell that Excel does not know.

        Raises:
            FormulaError: of a function; what Excel saved in the cell does not say that it did not know it.
        """
        saved = self.graph.workbook.content(cell).value
        agrees = saved is ErrorCode.NAME or (value is not None and saved is not None and value.objects()[0] == saved)
        for name, unless_saved in (self._unknown or {}).items():
            if agrees:
                said = f"Excel does not know {name}, which gives #NAME?: the saved value agrees"
                self.notices.append(Notice(said, cell))
            elif unless_saved is not None:
                raise unless_saved

    def _lower_formula(self, tree: ir.Expression, scope: Scope) -> int:
        """The node of a cell's formula; a LAMBDA that nothing calls is `#CALC!` there."""
        try:
            return self.lower(tree, scope)
        except lambdas.NothingCallsError:
            if not gives_function(tree):
                raise
            return self.error(ErrorCode.CALC)

    def _show(self, node: int) -> int:
        """What a formula's cell shows: 0 for an empty one, in each trial."""
        if self.dag.types[node] is Kind.ANY and not isinstance(self.dag.nodes[node], Constant | Input):
            return self.dag.add(Apply(_SHOWN, (node,)))
        return self.zero_if_blank(node)

    def _filled_cell(self, cell: Cell, anchor: ir.Expression) -> int:
        """A cell that the array formula of another fills."""
        assert isinstance(anchor, Cell)
        if anchor in self.saved:
            return self._hold_saved(cell, self.faults[anchor])
        at = cell.row - anchor.row, cell.column - anchor.column
        formula = self.graph.workbook.content(anchor).formula
        if formula is None or not formula.dynamic:
            return self._show(element(self.dag, self.array(anchor), *at))
        node = spilled_cell(self.dag, self.array(anchor), *at)
        return self._blank if node is None else node if self.dag.sizes[self.array(anchor)] == MANY else self._show(node)

    def refuse_cells_beyond(self) -> None:
        """Refuse formulas that name cells which a dynamic array may fill, and did not when Excel saved it.

        Raises:
            FormulaError: a formula names some.
        """
        refuse_cells_beyond(self.graph, self.dag, self._arrays, self._ranges)
        sheets = dict.fromkeys(cell.sheet for cell in self._cells)
        for array in unneeded_arrays(self.graph, sheets, self._ranges):
            try:
                apart = lower_cells(Resolver(self.graph.workbook, self.inputs), [array], self.inputs, self.held)
            except FormulaError as error:
                said = f"formulas that name cells beyond this dynamic array read them as the file holds them: {error}"
                self.notices.append(Notice(said, array))
            else:
                refuse_cells_beyond(self.graph, apart.dag, apart._arrays, self._ranges)

    def _take_saved(self, cell: Cell, error: FormulaError) -> int:
        """Excel's own value stands in for what we cannot compute, as long as no assumption reaches it."""
        text = self.graph.text(cell)
        complete = FormulaError(error.message, where=cell, hint=error.hint, text=text, span=error.span)
        saved = self.graph.workbook.content(cell).value
        if self._strict and (cell in self.graph.varying or saved is None):
            raise complete from None
        self.notices.append(Notice(f"{error.message}; Excel's saved value is used (no assumption reaches it)", cell))
        return self._hold_saved(cell, complete)

    def _hold_saved(self, cell: Cell, fault: FormulaError) -> int:
        self.saved[cell] = self.graph.workbook.content(cell).value
        self.faults[cell] = fault
        return self._held_cell(cell)

    def _held_cell(self, cell: Cell) -> int:
        value = self.graph.workbook.content(cell).value
        return self._blank if value is None else self.dag.constant(constant(value))

    @cached_property
    def _blank(self) -> int:
        """The node of a blank cell: a long range may hold a million of them."""
        return self.dag.constant(constant(None))
