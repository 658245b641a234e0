"""Formula trees to nodes: operators, functions, and the ranges that they are given."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Collection, Iterable, Mapping
from itertools import groupby
from typing import Final, assert_never

from xlmc.engine.graph import lambdas, whole_columns
from xlmc.engine.graph.arrays import element, grid, size_of
from xlmc.engine.graph.called_functions import check_count, not_computed, unknown_to_excel, with_settings
from xlmc.engine.graph.choices import CHOICES, lower_reference
from xlmc.engine.graph.computed_references import NoReference, areas_of, of_one_cell
from xlmc.engine.graph.dag import Dag
from xlmc.engine.graph.further_cells import refusal
from xlmc.engine.graph.lowering import LambdaCalls, Scope, TreeLowering
from xlmc.engine.graph.nodes import Range
from xlmc.engine.graph.picked_ranges import PICKING, range_as_read
from xlmc.engine.graph.reference_functions import REFERENCE_FUNCTIONS
from xlmc.engine.graph.running_totals import FOLDS, RunningTotals
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Area, Cell, host_of
from xlmc.excel.formula import Graph, ir
from xlmc.excel.functions import Function
from xlmc.excel.functions.budget import CallCount, ask_for_reading
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.fifteen_digits import SNAP_TO_ZERO
from xlmc.excel.functions.operators import ALL_BITS
from xlmc.excel.functions.registry import Ranges
from xlmc.excel.functions.values import constant

__all__ = ["WRITTEN_OUT", "ExpressionLowering"]

_Arguments = tuple[ir.Expression, ...]

_PASSING_ON = ir.Call | ir.Let | ir.Invoke
"""Trees that may give a whole range where one is wanted: choices, INDEX, LET, LAMBDA."""


def _percent_of(lowering: TreeLowering, arguments: _Arguments, scope: Scope) -> int:
    """PERCENTOF(subset, all) is SUM(subset)/SUM(all), says its page at Microsoft."""
    subset, everything = (ir.Call("SUM", (argument,)) for argument in arguments)
    return lowering.lower(ir.Binary("/", subset, everything), scope)


WRITTEN_OUT: Final[Mapping[str, Callable[[TreeLowering, _Arguments, Scope], int]]] = {"PERCENTOF": _percent_of}
"""Functions that Microsoft describes as a formula of other functions, and that are computed as that formula."""


class ExpressionLowering(TreeLowering):
    """Lowers the trees of formulas; a subclass says where the nodes of cells come from."""

    def __init__(self, graph: Graph, dag: Dag, totals: RunningTotals, *, audit: bool) -> None:
        super().__init__(dag, totals)
        self.graph, self._audit = graph, audit
        self.calls, self.lambda_calls = CallCount(), LambdaCalls()
        self._unknown: dict[str, FormulaError | None] | None = None  # in the cell at hand; None between cells
        self._ranges: dict[Area, int] = {}

    def lower(self, tree: ir.Expression, scope: Scope) -> int:
        """The node of a tree."""
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
        """The node of references joined by an operator, where one value is wanted."""
        try:
            areas = areas_of(self, tree, scope)
        except NoReference as found:
            return self.error(found.code)
        if areas is None or len(areas) != 1:
            raise FormulaError("one value is needed here, and several areas joined by commas are given")
        return self.lower(areas[0], scope)

    def _intersect(self, area: Area, host: Cell) -> int:
        """The cell of a one-column (one-row) area in the host's row (column), as a plain formula takes it."""
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
        check_count(name, arguments)
        made = self._special(name, arguments, scope)
        if made is not None:
            return made
        parts = self.graph.workbook.parts
        if self._unknown is not None and function_named(name) is None and unknown_to_excel(call, parts):
            return self._name_error(name, not_computed(name))
        return self.call_by_name(name, arguments, scope)

    def _name_error(self, name: str, unless_saved: FormulaError | None) -> int:
        """The node of a name or function that Excel does not know; `unless_saved` is raised if it saved no #NAME?."""
        if self._unknown is not None:
            self._unknown[name] = unless_saved
        return self.error(ErrorCode.NAME)

    def call_by_name(self, name: str, arguments: tuple[ir.Expression, ...], scope: Scope) -> int:
        """The node of a function of values."""
        function = function_named(name)
        if function is None:
            raise not_computed(name)
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
        """A call of a function of the registry; some of its arguments go through another function first."""
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
        found = tuple(node for position in range(len(arguments)) for node in parts[position])
        return self.apply(function_here, found)

    def _as_read(
        self, function: Function, picked: int, tree: ir.Expression, scope: Scope, given: Mapping[int, list[int]]
    ) -> int | None:
        """The node of a range of which a function reads a few cells; None where it is to be read whole."""
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
        """The nodes of an argument of a call: several of joined areas, where the function takes any number of them."""
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
        """The node of a function that takes more than values; None of one that takes values alone."""
        for special in (CHOICES, REFERENCE_FUNCTIONS, lambdas.LAMBDAS, WRITTEN_OUT):
            if name in special:
                try:
                    return special[name](self, arguments, scope)
                except NoReference as found:
                    return self.error(found.code)
        return None

    def _stack(self, parts: list[int]) -> int:
        """Joined areas as one, for a function that takes a single range: their cells in one column."""
        if len(parts) == 1:
            return parts[0]
        cells = []
        for part in parts:
            rows, columns = size_of(self.dag, part) or (1, 1)
            cells += [element(self.dag, part, r, c) for r in range(rows) for c in range(columns)]
        return grid(self.dag, len(cells), 1, lambda r, _: cells[r])

    def whole(self, tree: ir.Expression, scope: Scope) -> list[int]:
        """An argument that may be a range: ranges whole, joined areas one by one, anything else as it computes."""
        try:
            areas = areas_of(self, tree, scope)
        except NoReference as found:
            return [self.error(found.code)]
        if areas is None:
            passing_on = isinstance(tree, _PASSING_ON)
            return [lower_reference(self, tree, scope.wanted_whole()) if passing_on else self.lower(tree, scope)]
        return [self.range(area) for area in areas]

    def range(self, area: Area) -> int:
        """The node of all cells of an area, which are looked up once.

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

    @abstractmethod
    def not_there(self, area: Area) -> Collection[Cell]:
        """The cells of an area that are in a circle and have no value yet."""

    @abstractmethod
    def read_first(self, cells: Iterable[Cell]) -> None:
        """Ask for all cells that must be lowered first."""

    def _range(self, area: Area) -> int:
        rows = range(area.top, area.bottom + 1)
        columns = range(area.left, area.right + 1)
        return self.dag.add(Range(tuple(tuple(self.cell(Cell(area.sheet, r, c)) for c in columns) for r in rows)))
