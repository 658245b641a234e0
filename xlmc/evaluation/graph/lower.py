"""Resolved formula trees to the graph of nodes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property, partial
from itertools import groupby
from typing import assert_never

from xlmc.address import Area, Cell, host_of
from xlmc.errors import ErrorCode, FormulaError, Notice
from xlmc.evaluation.engine import Target
from xlmc.evaluation.graph import choices, lambdas, whole_columns
from xlmc.evaluation.graph.arrays import element, grid, size_of, spread
from xlmc.evaluation.graph.counts import check_count
from xlmc.evaluation.graph.dag import Apply, Constant, Dag, Input, Range
from xlmc.evaluation.graph.either import shared_out
from xlmc.evaluation.graph.empty_cells import refused
from xlmc.evaluation.graph.not_computed import not_computed, unknown_to_excel
from xlmc.evaluation.graph.one_cell import of_one_cell
from xlmc.evaluation.graph.places import PLACES
from xlmc.evaluation.graph.recipes import Recipes
from xlmc.evaluation.graph.recursion import Recursions
from xlmc.evaluation.graph.references import NoReference, NotYetNeeded, areas_of
from xlmc.evaluation.graph.running import FOLDS, RunningTotals
from xlmc.evaluation.graph.scope import Scope
from xlmc.evaluation.graph.settings import as_set
from xlmc.evaluation.graph.written_out import WRITTEN_OUT
from xlmc.formula import Filled, Graph, Resolver, ir
from xlmc.formula.callables import gives_function
from xlmc.functions import Function, Kind
from xlmc.functions.budget import CallCount, ask_for_reading
from xlmc.functions.facts import Facts
from xlmc.functions.families import REGISTRY, function_named
from xlmc.functions.fifteen_digits import SETTLED
from xlmc.functions.logical import zero_if_blank
from xlmc.functions.operators import ALL_BITS
from xlmc.functions.registry import Anything, Ranges
from xlmc.functions.values import BLANK, Value, constant

__all__ = ["Lowering"]


_PASSING_ON = ir.Call | ir.Let | ir.Invoke
"""Trees that may give a range whole where one is wanted: choices, INDEX, LET, LAMBDA."""

_SHOWN = Function("shown", (Anything,), zero_if_blank, Kind.ANY, facts=Facts(unrounded=True))


class Lowering:
    """The nodes of every needed cell of a graph.

    Args:
        graph: the needed cells, in dependency order.
        inputs: the assumption cells and the names of their inputs; any other cell that holds a value is constant.
        held: cells held at a value of their own: frozen assumptions.
        audit: every formula sees what Excel saved in the cells it needs, so that each is checked on its own; one that
            cannot be computed is a fault, not an exception.

    Attributes:
        graph, inputs, held: as given.
        saved: the cells that xlmc cannot compute, with the values that Excel saved.
        faults: why it cannot.
        more: formula cell -> cells that OFFSET and its like turned out to need and the graph does not hold. Where there
            are any, the graph must be built again with them.
        led_to: formula cell -> inputs and formula cells that OFFSET and its like lead to.
        dag: the nodes.
        notices: what the person should know.
        calls: of LAMBDAs, which must not be too many.
        recursions: the LAMBDAs that call themselves.
    """

    def __init__(
        self, graph: Graph, inputs: Mapping[Cell, str], held: Mapping[Cell, float], *, audit: bool = False
    ) -> None:
        self.dag = Dag()
        self.notices: list[Notice] = []
        self.saved: dict[Cell, object] = {}
        self.faults: dict[Cell, FormulaError] = {}
        self.more: dict[Cell, set[Cell]] = {}
        self.led_to: dict[Cell, set[Cell]] = {}
        self._led: set[Cell] = set()
        self._unknown: dict[str, FormulaError | None] | None = None  # in the cell at hand; None between cells
        self.inputs, self.held, self.graph, self._audit = inputs, held, graph, audit
        self._computed: dict[Cell, int] = {}
        self._arrays: dict[Cell, int] = {}
        self._numbers: dict[float, int] = {}
        self._ranges: dict[Area, int] = {}
        self.calls, self.recursions = CallCount(), Recursions()
        self._cells: dict[Cell, int] = {cell: self.dag.input(name) for cell, name in inputs.items()}
        self._cells |= {cell: self.dag.constant(constant(value)) for cell, value in held.items()}
        trees = (placed for placed in graph.formulas.placed.values() if not isinstance(placed, Filled))
        self._recipes, self._totals = Recipes(self.dag), RunningTotals(self.dag, trees, self.cell)
        for cell, placed in graph.formulas.placed.items():
            self._computed[cell] = place = self._formula_cell(cell, placed)
            self.dag.host_ends(cell)
            self.calls.next_formula()
            saved = graph.workbook.content(cell).value if audit else None
            self._cells[cell] = place if saved is None else self._held_cell(cell)

    def cell(self, cell: Cell) -> int:
        """The node of a cell's value."""
        if cell not in self._cells:
            self._cells[cell] = self._held_cell(cell)
        return self._cells[cell]

    def array(self, cell: Cell) -> int:
        """The node of all that an array formula in a cell gives."""
        return self._arrays.get(cell, self.cell(cell))

    def spilled(self, cell: Cell) -> int:
        """The node of the cells that it fills, which show 0 for an empty one."""
        place = self.array(cell)
        constant_ = isinstance(self.dag.nodes[place], Constant)
        return self.zero_if_blank(place) if constant_ else self.made(_SHOWN, (place,))

    def is_saved(self, cell: Cell) -> bool:
        """Whether formulas see what Excel saved in a formula's cell, rather than what it gives."""
        return self._audit or cell in self.saved

    def target(self, target: Target) -> int:
        """The node of a target."""
        return self.single(self.lower(target.tree, Scope(target.cell)))

    def known(self, target: Target) -> Value | None:
        """The target's value where no input reaches it; None where one does."""
        return self.known_single(self.target(target))

    def value(self, cell: Cell) -> Value | None:
        """What a formula cell computes where that is constant; None where it is not."""
        return self.known_single(self._computed[cell])

    def filled(self, cell: Cell, anchor: Cell) -> Value | None:
        """What the array formula of another cell puts into a cell, where that is constant; None where it is not."""
        return self.known_single(self._filled_cell(cell, anchor))

    def last_step(self, cell: Cell) -> tuple[str, list[Value]] | None:
        """The function that a formula cell ends with, and its arguments, where all is constant; None otherwise."""
        place = self._computed[cell]
        node = self.dag.origins.get(place, self.dag.nodes[place])
        if not isinstance(node, Apply):
            return None
        known = [self.known_single(argument) for argument in node.arguments]
        return (
            (node.function.name, values) if len(values := [v for v in known if v is not None]) == len(known) else None
        )

    @property
    def read(self) -> frozenset[Cell]:
        """Every cell that the targets read: formulas, inputs, constants, and blank cells of ranges."""
        unread = (self.inputs.keys() | self.held.keys()) - self.graph.reached
        return frozenset(self._cells) - unread

    def awaits(self, cell: Cell) -> bool:
        """Whether a cell must be lowered before it can be referred to, and was not."""
        if cell in self.inputs or cell in self._computed:
            self._led.add(cell)
        if cell in self.inputs:
            return cell not in self.graph.reached
        return cell not in self._cells and self.graph.workbook.content(cell).formula is not None

    @cached_property
    def resolver(self) -> Resolver:
        """Reads the references in texts."""
        return Resolver(self.graph.workbook, self.inputs, strict=False)

    def number(self, value: float) -> int:
        """The node of a number."""
        if value not in self._numbers:
            self._numbers[value] = self.dag.constant(constant(value))
        return self._numbers[value]

    def error(self, code: ErrorCode) -> int:
        """The node of an error."""
        return self.dag.constant(constant(code))

    def _formula_cell(self, cell: Cell, placed: ir.Expression | Filled) -> int:
        if not isinstance(placed, Filled):
            return self._resolved_cell(cell, placed)
        stencil, cells = placed
        if self._audit:
            return self._resolved_cell(cell, stencil.at(cell))
        known = self._cells
        leaves = [known[leaf] if leaf in known else self.cell(leaf) for leaf in cells]
        return self._recipes.lowered(stencil, leaves, lambda: self._resolved_cell(cell, stencil.at(cell)))

    def _resolved_cell(self, cell: Cell, tree: ir.Expression) -> int:
        formula = self.graph.workbook.content(host_of(cell)).formula
        self._led, self._unknown = set(), {}
        try:
            if cell in self.graph.faults:
                raise self.graph.faults[cell]
            if formula is None:
                return self._filled_cell(cell, tree)
            place = self._whole_formula(tree, Scope(cell, formula.array is not None or formula.dynamic))
            self._arrays[cell] = place
            place = self._shown(self.single(place))
            self._tell_unknown(cell, self.known_single(place))
        except NotYetNeeded as needed:
            self.more.setdefault(cell, set()).update(needed.cells)
            return self._held_cell(cell)  # only until the graph is built again
        except FormulaError as error:
            return self._uncomputed(cell, error)
        finally:
            self._unknown = None
        if self._led:
            self.led_to[cell] = self._led
        return place

    def _tell_unknown(self, cell: Cell, value: Value | None) -> None:
        """Tell of the names and functions in a cell that Excel does not know.

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

    def _whole_formula(self, tree: ir.Expression, scope: Scope) -> int:
        """The node of a cell's formula; a LAMBDA that nothing calls is `#CALC!` there."""
        try:
            return self.lower(tree, scope)
        except lambdas.NothingCallsError:
            if not gives_function(tree):
                raise
            return self.error(ErrorCode.CALC)

    def _shown(self, place: int) -> int:
        """What a formula's cell shows: 0 for an empty one, in each trial."""
        if self.dag.types[place] is Kind.ANY and not isinstance(self.dag.nodes[place], Constant | Input):
            return self.dag.add(Apply(_SHOWN, (place,)))
        return self.zero_if_blank(place)

    def _filled_cell(self, cell: Cell, anchor: ir.Expression) -> int:
        """A cell that the array formula of another fills."""
        assert isinstance(anchor, Cell)
        if anchor in self.saved:
            return self._saved(cell, self.faults[anchor])
        place = element(self.dag, self.array(anchor), cell.row - anchor.row, cell.column - anchor.column)
        return self._shown(place)

    def _uncomputed(self, cell: Cell, error: FormulaError) -> int:
        """Excel's own value stands in for what we cannot compute, as long as no assumption reaches it."""
        text = self.graph.text(cell)
        complete = FormulaError(error.message, where=cell, hint=error.hint, text=text, span=error.span)
        saved = self.graph.workbook.content(cell).value
        if not self._audit and (cell in self.graph.varying or saved is None):
            raise complete from None
        self.notices.append(Notice(f"{error.message}; Excel's saved value is used (no assumption reaches it)", cell))
        return self._saved(cell, complete)

    def _saved(self, cell: Cell, fault: FormulaError) -> int:
        self.saved[cell] = self.graph.workbook.content(cell).value
        self.faults[cell] = fault
        return self._held_cell(cell)

    def single(self, place: int) -> int:
        """One cell of a value: the first of many."""
        return element(self.dag, place, 0, 0)

    def _held_cell(self, cell: Cell) -> int:
        return self.dag.constant(constant(self.graph.workbook.content(cell).value))

    def known_single(self, place: int) -> Value | None:
        """The value of a single constant."""
        node = self.dag.nodes[place]
        return node.value if isinstance(node, Constant) and self.dag.sizes[place] is None else None

    def _is_blank(self, place: int) -> bool:
        known = self.known_single(place)
        return known is not None and int(known.kinds[0]) == BLANK

    def zero_if_blank(self, place: int) -> int:
        """What a formula gives for an empty cell."""
        return self.number(0.0) if self._is_blank(place) else place

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
                return self.range(tree) if scope.array or scope.whole else self._intersected(tree, scope.cell)
            case ir.Array(rows):
                return self.dag.add(Range(tuple(tuple(self.lower(part, scope) for part in row) for row in rows)))
            case ir.Unary("+", operand):
                return self.lower(operand, scope.inside())
            case ir.Unary(operator, operand):
                return self.call("%" if operator == "%" else "u-", (self.lower(operand, scope.inside()),))
            case ir.Binary():
                return self._chain(tree, scope)
            case ir.Call():
                return self._function_call(tree, scope)
            case ir.Variable() | ir.Let() | ir.Lambda() | ir.FunctionName() | ir.Invoke():
                return lambdas.lower(self, tree, scope)
            case ir.Reference() | ir.Name() | ir.TableReference():
                raise TypeError(f"not resolved: {tree}")
            case _:
                assert_never(tree)

    def _chain(self, tree: ir.Binary, scope: Scope) -> int:
        if tree.operator in (",", ":", " "):
            return self._joined(tree, scope)
        scope = scope.inside()
        if tree.all_bits:
            return self.made(ALL_BITS[tree.operator], (self.lower(tree.left, scope), self.lower(tree.right, scope)))
        first, rest = ir.chain(tree)
        place = before = self.lower(first, scope)
        for operator, run in groupby(rest, lambda step: step[0]):
            parts = [self.lower(right, scope) for _, right in run]
            if operator == "&":
                place = self.call(operator, (place, *parts))
                continue
            for part in parts:
                before, place = place, self.call(operator, (place, part))
        if not tree.last or place in (before, parts[-1]):
            return place
        return self.made(SETTLED, (place, before))

    def _joined(self, tree: ir.Binary, scope: Scope) -> int:
        """References put together, where one value is wanted."""
        try:
            areas = areas_of(self, tree, scope)
        except NoReference as found:
            return self.error(found.code)
        if areas is None or len(areas) != 1:
            raise FormulaError("several areas joined by commas stand where one value is needed")
        return self.lower(areas[0], scope)

    def _intersected(self, area: Area, host: Cell) -> int:
        """The cell of a one-column (one-row) area in the host's row (column), as a plain formula takes it."""
        area = area.whole
        if area.rows == area.columns == 1:
            return self.cell(Cell(area.sheet, area.top, area.left))
        if area.left == area.right and area.top <= host.row <= area.bottom:
            return self.cell(Cell(area.sheet, host.row, area.left))
        if area.top == area.bottom and area.left <= host.column <= area.right:
            return self.cell(Cell(area.sheet, area.top, host.column))
        return self.error(ErrorCode.VALUE)

    def _function_call(self, call: ir.Call, scope: Scope) -> int:
        name, arguments = call.name, call.arguments
        check_count(name, arguments)
        made = self._special(name, arguments, scope)
        if made is not None:
            return made
        parts = self.graph.workbook.parts
        if self._unknown is not None and function_named(name) is None and unknown_to_excel(call, parts):
            return self._name_error(name, not_computed(name))
        return self.applied(name, arguments, scope)

    def _name_error(self, name: str, unless_saved: FormulaError | None) -> int:
        """The node of a name or a function that Excel does not know; the error if what it saved does not say so."""
        if self._unknown is not None:
            self._unknown[name] = unless_saved
        return self.error(ErrorCode.NAME)

    def applied(self, name: str, arguments: tuple[ir.Expression, ...], scope: Scope) -> int:
        """The node of a function of values."""
        function = function_named(name)
        if function is None:
            raise not_computed(name)
        if function.volatile and not self._audit:
            hint = "put it in a cell of its own: the value Excel saved for it is then used, and the run can be repeated"
            raise FormulaError(f"{name} gives another value each time", hint=hint)
        if name in FOLDS and len(arguments) == 1 and isinstance(arguments[0], Area):
            area = arguments[0].filled
            return self._totals.of_area(name, area, lambda: self._call_of(function, (area,), scope, {}))
        scope = scope.inside()

        def make(parts: tuple[ir.Expression, ...], first: Mapping[int, Function]) -> int:
            return self._call_of(function, parts, scope, first)

        return whole_columns.lowered(self, name, function, arguments, scope, make)

    def _call_of(
        self,
        function: Function,
        arguments: tuple[ir.Expression, ...],
        scope: Scope,
        first: Mapping[int, Function],
    ) -> int:
        """A call of a function of the registry; some of its arguments go through another function first."""
        book = self.graph.workbook
        found: list[int] = []
        for position, argument in enumerate(arguments):
            parameter = function.parameter(position)
            beside = scope.of(parameter.ranges)
            if parameter.ranges is Ranges.ONE_CELL:
                argument = of_one_cell(self, argument, beside)
            whole = parameter.ranged and (beside.array or parameter.ranges is not Ranges.SINGLE)
            part = self.whole(argument, beside) if whole else [self.lower(argument, beside)]
            if position in first:
                part = [self.made(first[position], (place,)) for place in part]
            found += part if parameter.repeat else [self._stacked(part)]
        return self.made(as_set(function, book.date1904, book.macintosh), tuple(found))

    def _special(self, name: str, arguments: tuple[ir.Expression, ...], scope: Scope) -> int | None:
        """The node of a function that is more than a function of values; None where it is no more."""
        for special in (choices.CHOICES, PLACES, lambdas.LAMBDAS, WRITTEN_OUT):
            if name in special:
                try:
                    return special[name](self, arguments, scope)
                except NoReference as found:
                    return self.error(found.code)
        return None

    def _stacked(self, parts: list[int]) -> int:
        """Joined areas as one, for a function that takes a single range: their cells in one column."""
        if len(parts) == 1:
            return parts[0]
        cells = []
        for part in parts:
            rows, columns = size_of(self.dag, part) or (1, 1)
            cells += [element(self.dag, part, r, c) for r in range(rows) for c in range(columns)]
        return grid(self.dag, len(cells), 1, lambda r, _: cells[r])

    def made(self, function: Function, arguments: tuple[int, ...]) -> int:
        """The node of a function of nodes, cell by cell where it takes single values and is given many."""
        if function.facts.factor is not None:
            return self.call("*", (arguments[0], self.number(function.facts.factor)))
        if function.name == "/" and (factor := self._inverse(arguments[1])) is not None:
            return self.call("*", (arguments[0], self.number(factor)))
        chosen = self._shared_out(function, arguments)
        if chosen is not None:
            return chosen
        if function.takes_sets:
            return self._totals.made(function, arguments)
        if all(self.dag.sizes[place] is None for place in arguments):
            return self.dag.add(Apply(function, arguments))
        loose = tuple(p for i, p in enumerate(arguments) if not function.parameter(i).ranged)
        cells = spread(
            self.dag, function, loose, lambda picked: self.made(function, _merged(function, arguments, picked))
        )
        return self.dag.add(Apply(function, arguments)) if cells is None else cells

    def _shared_out(self, function: Function, arguments: tuple[int, ...]) -> int | None:
        """The function of a choice between sizes, as a choice between two results; None without such an argument."""
        return shared_out(
            self.dag,
            arguments,
            partial(self.made, function),
            lambda place: self.call("ISERROR", (place,)),
            partial(choices.select, self),
        )

    def _inverse(self, place: int) -> float | None:
        """1 / the number, where to multiply by it is to divide by the number, to the last bit: of powers of two."""
        node = self.dag.nodes[place]
        if not isinstance(node, Constant) or self.dag.types[place] is not Kind.NUMBER:
            return None
        number = float(node.value.numbers[0])
        return 1.0 / number if abs(math.frexp(number)[0]) == 0.5 and 2.0**-60 < abs(number) < 2.0**60 else None

    def whole(self, tree: ir.Expression, scope: Scope) -> list[int]:
        """An argument that may be a range: ranges whole, joined areas one by one, anything else as it computes."""
        try:
            areas = areas_of(self, tree, scope)
        except NoReference as found:
            return [self.error(found.code)]
        if areas is None:
            return [self.lower(tree, scope.wanted_whole() if isinstance(tree, _PASSING_ON) else scope)]
        return [self.range(area) for area in areas]

    def range(self, area: Area) -> int:
        """The node of all cells of an area, which are looked up once.

        Raises:
            TooLargeError: they are too many.
        """
        if area.is_cut:
            raise refused("what takes all cells")
        if area not in self._ranges:
            ask_for_reading(area.rows, area.columns)
            self._ranges[area] = self._range(area)
        return self._ranges[area]

    def _range(self, area: Area) -> int:
        rows = range(area.top, area.bottom + 1)
        columns = range(area.left, area.right + 1)
        return self.dag.add(Range(tuple(tuple(self.cell(Cell(area.sheet, r, c)) for c in columns) for r in rows)))

    def call(self, name: str, arguments: tuple[int, ...]) -> int:
        """The node of an operator, or of a function that takes single values."""
        if name == "+" and self.number(0.0) in arguments:
            other = arguments[arguments[0] == self.number(0.0)]
            if self.dag.types[other] is Kind.NUMBER:
                return other
        if name == "^" and arguments[1] == self.number(2.0):
            return self.call("*", (arguments[0], arguments[0]))
        return self.made(REGISTRY[name], arguments)


def _merged(function: Function, arguments: tuple[int, ...], picked: tuple[int, ...]) -> tuple[int, ...]:
    """The arguments with those that take single values replaced, in order."""
    singles = iter(picked)
    return tuple(p if function.parameter(i).ranged else next(singles) for i, p in enumerate(arguments))
