"""Turn the needed formula cells, one after another, and the trees of their formulas, into nodes of the graph.

`Lowering` goes through cells, trees, functions and ranges; what a family of functions needs beyond that (choices,
references, LAMBDAs, whole columns, …) is a module of its own, which reaches the rest through `scope.TreeLowering`.
Where xlmc cannot compute a cell, and no assumption reaches it, the value that Excel saved stands in.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import cached_property
from itertools import groupby
from typing import Final, TypeVar, assert_never

from xlmc.engine.graph import lambdas, whole_columns
from xlmc.engine.graph.arrays import element, grid, size_of
from xlmc.engine.graph.called_functions import check_count, not_computed, unknown_to_excel, with_settings
from xlmc.engine.graph.choices import CHOICES, lower_reference
from xlmc.engine.graph.circles import CircleError, Iterates, lower_as_read
from xlmc.engine.graph.computed_references import NoReference, NotYetNeeded, areas_of, of_one_cell
from xlmc.engine.graph.constant_sums import SUMS
from xlmc.engine.graph.fill_down import FillDownCache
from xlmc.engine.graph.further_cells import refusal
from xlmc.engine.graph.graph import MANY, Dag
from xlmc.engine.graph.iteration import IteratedCells, in_order, iterate_cells
from xlmc.engine.graph.moment import Moment
from xlmc.engine.graph.nodes import Apply, Constant, Input, Range, Target
from xlmc.engine.graph.picked_ranges import PICKING, range_as_read
from xlmc.engine.graph.reference_functions import REFERENCE_FUNCTIONS
from xlmc.engine.graph.running_totals import FOLDS, RunningTotals
from xlmc.engine.graph.scope import LambdaCalls, Scope, TreeLowering
from xlmc.engine.graph.spilled_cells import refuse_cells_beyond, spilled_cell, unneeded_arrays
from xlmc.errors import ErrorCode, FormulaError, Notice
from xlmc.excel.address import Area, Cell, InFormula, host_of
from xlmc.excel.formula import Filled, Graph, Resolver, build_graph, ir
from xlmc.excel.formula.callables import gives_function
from xlmc.excel.formula.graph import Spills, reached
from xlmc.excel.formula.precedents import mentioned_cells
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.budget import CallCount, ask_for_reading
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.fifteen_digits import SNAP_TO_ZERO
from xlmc.excel.functions.logical import zero_if_blank
from xlmc.excel.functions.operators import ALL_BITS
from xlmc.excel.functions.registry import Anything, Ranges
from xlmc.excel.functions.values import Value, constant

__all__ = ["WRITTEN_OUT", "Lowering", "lower_cells", "lower_until_complete"]

_Arguments = tuple[ir.Expression, ...]

_DRAW_EACH: Final = "draw in cells of their own, one for each value"

_PASSING_ON = ir.Call | ir.Let | ir.Invoke
"""Trees that may give a whole range where one is wanted: choices, INDEX, LET, LAMBDA."""


def _percent_of(lowering: TreeLowering, arguments: _Arguments, scope: Scope) -> int:
    """PERCENTOF(subset, all) is SUM(subset)/SUM(all), says its page at Microsoft."""
    subset, everything = (ir.Call("SUM", (argument,)) for argument in arguments)
    return lowering.lower(ir.Binary("/", subset, everything), scope)


WRITTEN_OUT: Final[Mapping[str, Callable[[TreeLowering, _Arguments, Scope], int]]] = {"PERCENTOF": _percent_of}
"""Functions that Microsoft describes as a formula of other functions, and that are computed as that formula."""


_SHOWN: Final = Function("shown", (Anything,), zero_if_blank, Kind.ANY, facts=Facts(unrounded=True))


L = TypeVar("L", bound="Lowering")


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
    resolver: Resolver, cells: Collection[Cell], inputs: Mapping[Cell, str], frozen: Mapping[Cell, float]
) -> Lowering:
    """Lower what some cells need.

    Args:
        resolver: of the workbook.
        cells: that are wanted.
        inputs: assumption cell -> name of its input.
        frozen: cell -> the value of its own that it is held at.

    Raises:
        FormulaError: a needed cell cannot be computed.
    """

    def lower(more: Mapping[Cell, set[Cell]]) -> Lowering:
        return Lowering(build_graph(resolver, cells, frozenset(inputs), frozenset(frozen), more=more), inputs, frozen)

    return lower_until_complete(lower)


class Lowering(TreeLowering):
    """Turn every needed cell of a graph into a node.

    Args:
        graph: the needed cells, in dependency order.
        inputs: the assumption cells and the names of their inputs; any other cell that holds a value is constant.
        frozen: cells held at a value of their own: frozen assumptions.
        audit: every formula reads what Excel saved in the cells it needs, so that each is checked on its own; one that
            cannot be computed is a fault, not an exception.
        one_trial: a cell that reads itself is an error, as in a trial of many, and no reason to refuse the cells.
        strict: a formula that cannot be computed and has no saved value is an exception; otherwise a fault, too.
        moment: of a recalculation, at which NOW, RAND and their like are computed; otherwise they are faults.

    Attributes:
        graph, inputs, frozen: as given.
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
        frozen: Mapping[Cell, float],
        *,
        audit: bool = False,
        one_trial: bool = False,
        strict: bool = True,
        moment: Moment | None = None,
    ) -> None:
        dag = Dag(date1904=graph.workbook.date1904)
        trees = (placed for placed in graph.formulas.ordered.values() if not isinstance(placed, Filled))
        super().__init__(dag, RunningTotals(dag, trees, self.cell))
        self.graph, self._audit, self._strict, self._one_trial = graph, audit, strict and not audit, one_trial
        self._moment = moment
        self.calls, self.lambda_calls = CallCount(), LambdaCalls()
        self.inputs, self.frozen = inputs, frozen
        self.saved: dict[Cell, object] = {}
        self.faults: dict[Cell, FormulaError] = {}
        self.more: dict[Cell, set[Cell]] = {}
        self.led_to: dict[Cell, set[Cell]] = {}
        self.notices: list[Notice] = []
        self.circle: set[Cell] = set()
        self.iterated: list[IteratedCells] = []
        self._led: set[Cell] = set()
        self._unknown: dict[str, FormulaError | None] | None = None  # in the cell at hand; None between cells
        self._iteration = graph.workbook.iteration
        self._circles = {} if audit and self._iteration else graph.circles
        self._computed: dict[Cell, int] = {}
        self._arrays: dict[Cell, int] = {}
        self._ranges: dict[Area, int] = {}
        self._complete: dict[Area, frozenset[Cell]] = {}
        self._spills = Spills(graph.workbook)
        self._cells = {cell: dag.input(name) for cell, name in inputs.items()}
        self._cells |= {cell: dag.constant(constant(value)) for cell, value in frozen.items()}
        self._fill_down = FillDownCache(dag)
        if self._circles:
            lower_as_read(graph.formulas.ordered, self)
        else:
            for cell, placed in graph.formulas.ordered.items():
                self._set(cell, self._lower_placed(cell, placed))

    def target(self, target: Target) -> int:
        """Lower a target."""
        return self.first_cell(self.lower(target.tree, Scope(target.cell)))

    def known(self, target: Target) -> Value | None:
        """Return the target's value where no input reaches it; None if one does."""
        return self.lookup_constant(self.target(target))

    def value(self, cell: Cell) -> Value | None:
        """Return what a formula cell computes where that is constant; None if it is not."""
        return self.lookup_constant(self._computed[cell])

    def filled(self, cell: Cell, anchor: Cell) -> Value | None:
        """Return what the array formula of another cell puts into a cell, where that is constant; None if it is not."""
        return self.lookup_constant(self._filled_cell(cell, anchor))

    def last_step(self, cell: Cell) -> tuple[str, list[Value]] | None:
        """Return the function that a formula cell ends with, and its arguments, where all is constant;
        otherwise None.
        """
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
        unread = (self.inputs.keys() | self.frozen.keys()) - self.graph.reached
        return frozenset(self._cells) - unread

    def refuse_cells_beyond(self) -> None:
        """Refuse formulas that name cells which a dynamic array may fill, and did not when Excel saved it.

        Raises:
            FormulaError: a formula names some.
        """
        refuse_cells_beyond(self.graph, self.dag, self._arrays, self._ranges)
        sheets = dict.fromkeys(cell.sheet for cell in self._cells)
        for array in unneeded_arrays(self.graph, sheets, self._ranges):
            try:
                apart = lower_cells(Resolver(self.graph.workbook, self.inputs), [array], self.inputs, self.frozen)
            except FormulaError as error:
                message = (
                    f"formulas that name cells beyond this dynamic array read them as the file holds them: {error}"
                )
                self.notices.append(Notice(message, array))
            else:
                refuse_cells_beyond(self.graph, apart.dag, apart._arrays, self._ranges)

    def _set(self, cell: Cell, node: int) -> None:
        """Note the node of a formula cell, and what other formulas read of it."""
        self._computed[cell] = node
        self.dag.host_ends(cell)
        self.calls.next_formula()
        saved = self.graph.workbook.content(cell).value if self._audit and node not in self.dag.missing else None
        self._cells[cell] = node if saved is None else self._saved_cell(cell)

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
        """Lower a formula cell; where xlmc cannot compute it, its saved value."""
        formula = self.graph.workbook.content(host_of(cell)).formula
        self._led, self._unknown = set(), {}
        try:
            if cell in self.graph.faults:
                raise self.graph.faults[cell]
            if formula is None and isinstance(tree, Cell) and not isinstance(cell, InFormula):
                return self._filled_cell(cell, tree)
            array = formula is not None and (formula.array is not None or formula.dynamic)
            node = self._lower_formula(tree, Scope(cell, array))
            self._arrays[cell] = node
            if isinstance(cell, InFormula) and (size_of(self.dag, node) or (1, 1)) != (1, 1):
                raise FormulaError("several values stand where a draw takes one", hint=_DRAW_EACH)
            node = self._show(self.first_cell(node))
            self._report_unknown(cell, self.lookup_constant(node))
        except NotYetNeeded as needed:
            if not self._wait_for_graph(cell, needed.cells):
                raise
            return self._saved_cell(cell)  # only until the graph is built again
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

    def _report_unknown(self, cell: Cell, value: Value | None) -> None:
        """Report the names and functions in a cell that Excel does not know.

        Raises:
            FormulaError: of a function; what Excel saved in the cell does not say that it did not know it.
        """
        saved = self.graph.workbook.content(cell).value
        agrees = saved is ErrorCode.NAME or (value is not None and saved is not None and value.objects()[0] == saved)
        for name, unless_saved in (self._unknown or {}).items():
            if agrees:
                message = f"Excel does not know {name}, which gives #NAME?: the saved value agrees"
                self.notices.append(Notice(message, cell))
            elif unless_saved is not None:
                raise unless_saved

    def _lower_formula(self, tree: ir.Expression, scope: Scope) -> int:
        """Lower a cell's formula; a LAMBDA that nothing calls is `#CALC!` there."""
        try:
            return self.lower(tree, scope)
        except lambdas.NothingCallsError:
            if not gives_function(tree):
                raise
            return self.error(ErrorCode.CALC)

    def _show(self, node: int) -> int:
        """Return what a formula's cell shows: 0 for an empty one, in each trial."""
        if self.dag.types[node] is Kind.ANY and not isinstance(self.dag.nodes[node], Constant | Input):
            return self.dag.add(Apply(_SHOWN, (node,)))
        return self.zero_if_blank(node)

    def _filled_cell(self, cell: Cell, anchor: ir.Expression) -> int:
        """Return the node of a cell that the array formula of another fills."""
        assert isinstance(anchor, Cell)
        if anchor in self.saved:
            return self._use_saved(cell, self.faults[anchor])
        at = cell.row - anchor.row, cell.column - anchor.column
        formula = self.graph.workbook.content(anchor).formula
        if formula is None or not formula.dynamic:
            return self._show(element(self.dag, self.array(anchor), *at))
        node = spilled_cell(self.dag, self.array(anchor), *at)
        return self._blank if node is None else node if self.dag.sizes[self.array(anchor)] == MANY else self._show(node)

    def cell(self, cell: Cell) -> int:
        """Return the node of a cell's value."""
        if cell not in self._cells:
            if cell in self.circle:
                return self.dag.circle()
            if self._circles and cell in self.graph.formulas.ordered:
                raise NotYetNeeded([cell])
            self._cells[cell] = self._saved_cell(cell)
        return self._cells[cell]

    def array(self, cell: Cell) -> int:
        """Return the node of all that an array formula in a cell gives."""
        return self._arrays.get(cell, self.cell(cell))

    def spill(self, cell: Cell) -> int:
        """Return the node of the cells that an array formula fills; a cell shows 0 for an empty value."""
        node = self.array(cell)
        constant_ = isinstance(self.dag.nodes[node], Constant)
        return self.zero_if_blank(node) if constant_ else self.apply(_SHOWN, (node,))

    def is_saved(self, cell: Cell) -> bool:
        """Whether formulas see what Excel saved in a formula's cell, rather than what it gives."""
        return self._audit or cell in self.saved

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
        """Return the cells of an area that must still be lowered before a formula can refer to it.

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

    def _take_saved(self, cell: Cell, error: FormulaError) -> int:
        """Excel's own value stands in for what we cannot compute, as long as no assumption reaches it."""
        text, saved = self.graph.text(cell), self.graph.workbook.content(cell).value
        varies = cell in self.graph.varying or saved is None
        typed = None if varies or not self._strict else self._needs_typed(cell)
        older = "" if typed is None else f"; what Excel saved in it belongs to another content of {typed}"
        complete = FormulaError(error.message + older, where=cell, hint=error.hint, text=text, span=error.span)
        if self._strict and (varies or older):
            raise complete from None
        self.notices.append(Notice(f"{error.message}; Excel's saved value is used (no assumption reaches it)", cell))
        return self._use_saved(cell, complete)

    def _needs_typed(self, cell: Cell) -> Cell | None:
        """Return a cell that a formula depends on and that was typed into since Excel saved its value; else None."""
        book, graph = self.graph.workbook, self.graph
        if not book.typed:
            return None
        among = {*book.typed, *book.formula_cells()}

        def following(at: Cell) -> Iterable[Cell]:
            return (*graph.needs.get(at, ()), *mentioned_cells(book, at, among))  # of needs, the constants are left out

        return next((at for at in reached([cell], following) if at in book.typed), None)

    def _use_saved(self, cell: Cell, fault: FormulaError) -> int:
        self.saved[cell] = self.graph.workbook.content(cell).value
        self.faults[cell] = fault
        return self._saved_cell(cell)

    def _saved_cell(self, cell: Cell) -> int:
        value = self.graph.workbook.content(cell).value
        return self._blank if value is None else self.dag.constant(constant(value))

    @cached_property
    def _blank(self) -> int:
        """The node of a blank cell: a long range may hold a million of them."""
        return self.dag.constant(constant(None))

    def lower(self, tree: ir.Expression, scope: Scope) -> int:
        """Lower a tree."""
        match tree:
            case ir.Number(value):
                return self.number(value)
            case ir.Text(value) | ir.Logical(value):
                return self.dag.constant(constant(value))
            case ir.ErrorLiteral(code, name):
                return self._name_error(name, None) if name else self.error(code)
            case ir.Missing():
                return self.dag.constant(constant(None))
            case Cell():
                return self.cell(tree)
            case Area():
                return self.range(tree) if scope.array or scope.whole else self._intersect(tree, scope.cell)
            case ir.Array(rows):
                return self.dag.add(Range(tuple(tuple(self.lower(part, scope) for part in row) for row in rows)))
            case ir.Unary("+", operand):
                return self.lower(operand, scope.inside())
            case ir.Unary(operator, operand):
                return self.call("%" if operator == "%" else "u-", (self.lower(operand, scope.inside()),))
            case ir.Binary():
                return self._chain(tree, scope)
            case ir.Call():
                return self._call(tree, scope)
            case ir.Variable() | ir.Let() | ir.Lambda() | ir.FunctionName() | ir.Invoke():
                return lambdas.lower(self, tree, scope)
            case ir.Reference() | ir.Name() | ir.TableReference():
                raise TypeError(f"not resolved: {tree}")
            case _:
                assert_never(tree)

    def _chain(self, tree: ir.Binary, scope: Scope) -> int:
        if tree.operator in (",", ":", " "):
            return self._join(tree, scope)
        scope = scope.inside()
        if tree.all_bits:
            return self.apply(ALL_BITS[tree.operator], (self.lower(tree.left, scope), self.lower(tree.right, scope)))
        first, rest = ir.chain(tree)
        node = before = self.lower(first, scope)
        for operator, run in groupby(rest, lambda step: step[0]):
            parts = [self.lower(right, scope) for _, right in run]
            if operator == "&":
                node = self.call(operator, (node, *parts))
                continue
            for part in parts:
                before, node = node, self.call(operator, (node, part))
        if not tree.last or node in (before, parts[-1]):
            return node
        return self.apply(SNAP_TO_ZERO, (node, before))

    def _join(self, tree: ir.Binary, scope: Scope) -> int:
        """Lower references joined by an operator, where one value is wanted."""
        try:
            areas = areas_of(self, tree, scope)
        except NoReference as no_reference:
            return self.error(no_reference.code)
        if areas is None or len(areas) != 1:
            raise FormulaError("one value is needed here, and several areas joined by commas are given")
        return self.lower(areas[0], scope)

    def _intersect(self, area: Area, host: Cell) -> int:
        """Return the cell of a one-column (one-row) area in the host's row (column), as a plain formula takes it."""
        area = area.whole
        if area.rows == area.columns == 1:
            return self.cell(Cell(area.sheet, area.top, area.left))
        if area.left == area.right and area.top <= host.row <= area.bottom:
            return self.cell(Cell(area.sheet, host.row, area.left))
        if area.top == area.bottom and area.left <= host.column <= area.right:
            return self.cell(Cell(area.sheet, area.top, host.column))
        return self.error(ErrorCode.VALUE)

    def _call(self, call: ir.Call, scope: Scope) -> int:
        name, arguments = call.name, call.arguments
        if call.given is not None:
            return self._call_function(call.given, arguments, scope.inside(), {})
        if self._moment is not None:
            now = self._moment.formula(name, arguments, self.graph.workbook.date1904)
            if now is not None:
                return self.lower(now, scope)
        check_count(name, arguments)
        made = self._special(name, arguments, scope)
        if made is not None:
            return made
        parts = self.graph.workbook.parts
        if self._unknown is not None and function_named(name) is None and unknown_to_excel(call, parts):
            return self._name_error(name, self._not_computed(name))
        return self.call_by_name(name, arguments, scope)

    def _not_computed(self, name: str) -> FormulaError:
        own = self.graph.workbook.functions
        return not_computed(name) if own is None else not_computed(name, own.names, own.file)

    def _name_error(self, name: str, unless_saved: FormulaError | None) -> int:
        """Lower a name or function that Excel does not know; `unless_saved` is raised if it saved no #NAME?."""
        if self._unknown is not None:
            self._unknown[name] = unless_saved
        return self.error(ErrorCode.NAME)

    def call_by_name(self, name: str, arguments: tuple[ir.Expression, ...], scope: Scope) -> int:
        """Lower a function of values."""
        function = function_named(name)
        if function is None:
            raise self._not_computed(name)
        if function.volatile and not self._audit:
            hint = "put it in a cell of its own: the value Excel saved for it is then used, and the run can be repeated"
            raise FormulaError(f"{name} gives another value each time", hint=hint)
        apart = host_of(scope.cell) in self.graph.circles  # whose cells may be lowered more than once
        if name in FOLDS and len(arguments) == 1 and isinstance(arguments[0], Area) and not apart:
            area = arguments[0].filled
            return self._totals.of_area(name, area, lambda: self._call_function(function, (area,), scope, {}))
        scope = scope.inside()

        def make(parts: tuple[ir.Expression, ...], first: Mapping[int, Function]) -> int:
            return self._call_function(function, parts, scope, first)

        return whole_columns.lower_call(self, name, function, arguments, scope, make)

    def _call_function(
        self,
        function: Function,
        arguments: tuple[ir.Expression, ...],
        scope: Scope,
        first: Mapping[int, Function],
    ) -> int:
        """Call a function of the registry; some of its arguments go through another function first."""
        book = self.graph.workbook
        function_here = with_settings(function, book.date1904, book.macintosh)
        picked = PICKING.get(function.name) if self.graph.circles else None
        parts = {
            position: self._argument(function, position, argument, scope, first)
            for position, argument in enumerate(arguments)
            if position != picked
        }
        if picked is not None and picked < len(arguments):
            node = self._as_read(function_here, picked, arguments[picked], scope, parts)
            nodes = self._argument(function, picked, arguments[picked], scope, first) if node is None else [node]
            parts[picked] = nodes
        result = tuple(node for position in range(len(arguments)) for node in parts[position])
        return self.apply(function_here, result)

    def _as_read(
        self, function: Function, picked: int, tree: ir.Expression, scope: Scope, given: Mapping[int, list[int]]
    ) -> int | None:
        """Lower a range of which a function reads a few cells; None if it is to be read whole."""
        try:
            areas = areas_of(self, tree, scope.of(function.parameter(picked).ranges).pointed_at())
        except NoReference:
            return None
        if areas is None or len(areas) != 1 or areas[0].is_cut:
            return None
        return range_as_read(self, function, picked, areas[0], given)

    def _argument(
        self,
        function: Function,
        position: int,
        argument: ir.Expression,
        scope: Scope,
        first: Mapping[int, Function],
    ) -> list[int]:
        """Lower an argument of a call: to several nodes for joined areas, where the function takes any number
        of them.
        """
        parameter = function.parameter(position)
        beside = scope.of(parameter.ranges)
        if parameter.ranges is Ranges.ONE_CELL:
            argument = of_one_cell(self, argument, beside)
        whole = parameter.ranged and (beside.array or parameter.ranges is not Ranges.SINGLE)
        nodes = self.whole(argument, beside) if whole else [self.lower(argument, beside)]
        if position in first:
            nodes = [self.apply(first[position], (node,)) for node in nodes]
        return nodes if parameter.repeat else [self._stack(nodes)]

    def _special(self, name: str, arguments: tuple[ir.Expression, ...], scope: Scope) -> int | None:
        """Lower a function that takes more than values, or that is lowered as others are; None of any other call."""
        for special in (CHOICES, REFERENCE_FUNCTIONS, lambdas.LAMBDAS, WRITTEN_OUT, SUMS):
            if name in special:
                try:
                    return special[name](self, arguments, scope)
                except NoReference as no_reference:
                    return self.error(no_reference.code)
        return None

    def _stack(self, parts: list[int]) -> int:
        """Stack joined areas, for a function that takes a single range: their cells in one column."""
        if len(parts) == 1:
            return parts[0]
        cells = []
        for part in parts:
            rows, columns = size_of(self.dag, part) or (1, 1)
            cells += [element(self.dag, part, r, c) for r in range(rows) for c in range(columns)]
        return grid(self.dag, len(cells), 1, lambda r, _: cells[r])

    def whole(self, tree: ir.Expression, scope: Scope) -> list[int]:
        """Lower an argument that may be a range: ranges whole, joined areas one by one, anything else as it
        computes.
        """
        try:
            areas = areas_of(self, tree, scope)
        except NoReference as no_reference:
            return [self.error(no_reference.code)]
        if areas is None:
            passing_on = isinstance(tree, _PASSING_ON)
            return [lower_reference(self, tree, scope.wanted_whole()) if passing_on else self.lower(tree, scope)]
        return [self.range(area) for area in areas]

    def range(self, area: Area) -> int:
        """Return the node of all cells of an area, which are looked up once.

        Raises:
            TooLargeError: they are too many.
        """
        if area.is_cut:
            raise refusal("what takes all cells")
        if area not in self._ranges:
            ask_for_reading(area.rows, area.columns)
            self.read_first(area.cells())
            node = self._range(area)
            if node in self.dag.missing:
                return node
            self._ranges[area] = node
        return self._ranges[area]

    def _range(self, area: Area) -> int:
        rows = range(area.top, area.bottom + 1)
        columns = range(area.left, area.right + 1)
        return self.dag.add(Range(tuple(tuple(self.cell(Cell(area.sheet, r, c)) for c in columns) for r in rows)))

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
        """Return the node of a formula cell that is lowered."""
        return self._computed[cell]

    def refuse(self, cells: Sequence[Cell], error: FormulaError) -> None:
        """Take cells for faulty that need each other in a circle; of many trials raise the error, or iterate."""
        if self._iteration is not None and cells[0] in self._circles:
            raise Iterates(cells[0])
        if self._strict and not self._one_trial:
            raise error
        for cell in cells:
            self._set(cell, self.dag.circle() if self._strict else self._use_saved(cell, error))

    def note_circle(self, cell: Cell) -> None:
        """Note that some trials may read a cell while it is computed."""
        if self._iteration is not None:
            raise Iterates(cell)
        message = "trials in which this cell needs itself in a circle are errors, #CALC!"
        self.notices.append(Notice(message, cell))

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
        result = iterate_cells(self.dag, cells, saved, self._iteration, self._lower_iterated)
        for each, node in zip(result.cells, result.nodes, strict=True):
            self._set(each, node)
        self.iterated.append(result)
        self.notices.append(result.notice(self._iteration))

    def _lower_iterated(self, parameters: Mapping[Cell, int]) -> list[int]:
        """Lower the formulas of cells, read as what stands for them."""
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
        """Return the cells of an area that are in a circle and have no value yet."""
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
