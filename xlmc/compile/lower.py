"""Resolved formula trees to the graph of nodes."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from typing import assert_never

import numpy as np

from xlmc.address import Area, Cell
from xlmc.compile.dag import Apply, Constant, Dag, Range, Rescue, Select
from xlmc.compile.engine import Target
from xlmc.errors import ErrorCode, FormulaError, Notice
from xlmc.formula import Graph, ir
from xlmc.functions import REGISTRY, Function, Kind, function_named
from xlmc.functions.registry import Cells
from xlmc.functions.values import BLANK, ERROR, Value, constant

__all__ = ["Lowering"]


_FACTORS = {"RADIANS": np.pi / 180, "DEGREES": 180 / np.pi}
"""Functions that are a multiplication, to the last bit; NumPy's own are several times slower."""

_OVER_ARRAYS = {"SUMPRODUCT"}
"""Functions that evaluate their arguments cell by cell, as an array formula does; all others have Excel pick the cell
of a range that stands beside the formula."""


def _first_cell(value: Value) -> Value:
    """What a plain formula shows of many cells: the first. (n, r, c) -> (n,)."""
    picked = [None if a is None else np.broadcast_to(a, value.shape)[:, 0, 0] for a in (value.numbers, value.texts)]
    return Value(picked[0], np.broadcast_to(value.kinds, value.shape)[:, 0, 0], picked[1])  # type: ignore[arg-type]


_FIRST_CELL = Function("first cell", (Cells,), _first_cell, Kind.ANY)


class Lowering:
    """The nodes of every needed cell of a graph.

    Args:
        graph: the needed cells, in dependency order.
        inputs: the assumption cells and the names of their inputs; any other cell that holds a value is constant.
        held: cells held at a value of their own: frozen assumptions.

    Attributes:
        graph, inputs, held: as given.
        saved: the cells that xlmc cannot compute and no assumption reaches, with the values that Excel saved.
        dag: the nodes.
        notices: what the person should know.
    """

    def __init__(self, graph: Graph, inputs: Mapping[Cell, str], held: Mapping[Cell, float]) -> None:
        self.dag = Dag()
        self.notices: list[Notice] = []
        self.saved: dict[Cell, object] = {}
        self.inputs, self.held = inputs, held
        self.graph = graph
        self._cells: dict[Cell, int] = {cell: self.dag.input(name) for cell, name in inputs.items()}
        self._cells |= {cell: self.dag.constant(constant(value)) for cell, value in held.items()}
        for cell, tree in graph.formulas.items():
            self._cells[cell] = self._formula_cell(cell, tree)

    def cell(self, cell: Cell) -> int:
        """The node of a cell's value."""
        if cell not in self._cells:
            self._cells[cell] = self._held_cell(cell)
        return self._cells[cell]

    def target(self, target: Target) -> int:
        """The node of a target."""
        return self._single(self._lower(target.tree, target.cell))

    def known(self, target: Target) -> Value | None:
        """The target's value where no input reaches it; None where one does."""
        return self._known_cell(self.target(target))

    def _number(self, value: float) -> int:
        return self.dag.constant(constant(value))

    def _formula_cell(self, cell: Cell, tree: ir.Expression) -> int:
        formula = self.graph.workbook.content(cell).formula
        if formula is None:  # filled by an array formula, which was refused or saved before
            return self._saved(cell)
        try:
            if formula.array is not None or formula.dynamic:
                raise FormulaError("array formulas are not supported in this version")
            place = self._single(self._lower(tree, cell))
        except FormulaError as error:
            text = self.graph.text(cell)
            complete = FormulaError(error.message, where=cell, hint=error.hint, text=text, span=error.span)
            if cell in self.graph.varying:
                raise complete from None
            return self._cached(cell, complete)
        return self._number(0.0) if self._is_blank(place) else place

    def _cached(self, cell: Cell, error: FormulaError) -> int:
        """Excel's own value stands in for what we cannot compute, as long as no assumption reaches it."""
        value = self.graph.workbook.content(cell).value
        if value is None:
            raise error
        self.notices.append(Notice(f"{error.message}; Excel's saved value is used (no assumption reaches it)", cell))
        return self._saved(cell)

    def _saved(self, cell: Cell) -> int:
        self.saved[cell] = self.graph.workbook.content(cell).value
        return self._held_cell(cell)

    def _single(self, place: int) -> int:
        return place if self.dag.sizes[place] is None else self.dag.add(Apply(_FIRST_CELL, (place,)))

    def _held_cell(self, cell: Cell) -> int:
        return self.dag.constant(constant(self.graph.workbook.content(cell).value))

    def _is_blank(self, place: int) -> bool:
        known = self._known_cell(place)
        return known is not None and int(known.kinds[0]) == BLANK

    def _lower(self, tree: ir.Expression, host: Cell | None) -> int:
        """The node of a tree in the formula of `host`; None where ranges are taken cell by cell, not beside a host."""
        match tree:
            case ir.Number(value) | ir.Text(value) | ir.Logical(value):
                return self.dag.constant(constant(value))
            case ir.ErrorLiteral(code):
                return self.dag.constant(constant(code))
            case ir.Missing():
                return self.dag.constant(constant(None))
            case Cell():
                return self.cell(tree)
            case Area():
                return self._range(tree) if host is None else self._intersected(tree, host)
            case ir.Array(rows):
                return self.dag.add(Range(tuple(tuple(self._lower(part, host) for part in row) for row in rows)))
            case ir.Unary("+", operand):
                return self._lower(operand, host)
            case ir.Unary(operator, operand):
                return self._call("%" if operator == "%" else "u-", (self._lower(operand, host),))
            case ir.Binary():
                return self._chain(tree, host)
            case ir.Call(name, arguments):
                return self._function_call(name, arguments, host)
            case ir.Variable() | ir.Let() | ir.Lambda() | ir.Invoke():
                raise FormulaError("LET and LAMBDA are not supported in this version")
            case ir.Reference() | ir.Name() | ir.TableReference():
                raise TypeError(f"not resolved: {tree}")
            case _:
                assert_never(tree)

    def _chain(self, tree: ir.Binary, host: Cell | None) -> int:
        first, rest = ir.chain(tree)
        place = self._lower(first, host)
        for operator, right in rest:
            if operator == ",":
                raise FormulaError("several areas joined by commas stand where one value is needed")
            place = self._call(operator, (place, self._lower(right, host)))
        return place

    def _intersected(self, area: Area, host: Cell) -> int:
        """The cell of a one-column (one-row) area in the host's row (column), as a plain formula takes it."""
        if area.left == area.right and area.top <= host.row <= area.bottom:
            return self.cell(Cell(area.sheet, host.row, area.left))
        if area.top == area.bottom and area.left <= host.column <= area.right:
            return self.cell(Cell(area.sheet, area.top, host.column))
        return self.dag.constant(constant(ErrorCode.VALUE))

    def _function_call(self, name: str, arguments: tuple[ir.Expression, ...], host: Cell | None) -> int:
        if name == "SINGLE":
            return self._picked(arguments[0], host)
        function = function_named(name)
        if function is None:
            raise _unknown_function(name)
        fewest, most = function.arity()
        if not fewest <= len(arguments) <= most:
            raise FormulaError(f"{name} has {len(arguments)} arguments; it takes {_count(fewest, most)}")
        places: list[int] = []
        for position, argument in enumerate(arguments):
            whole, beside = function.parameter(position).ranged, None if name in _OVER_ARRAYS else host
            places += self._whole(argument, beside) if whole else [self._lower(argument, host)]
        if host is None and name in ("IF", "IFERROR", "IFNA") and any(self.dag.sizes[place] for place in places):
            raise FormulaError(f"{name} over a range works in array formulas only, which are not supported")
        return self._made(function, tuple(places))

    def _picked(self, tree: ir.Expression, host: Cell | None) -> int:
        """`@tree`: the cell of a range beside the formula."""
        if host is None:
            raise FormulaError("@ is not supported here")
        return self._single(self._lower(tree, host))

    def _made(self, function: Function, places: tuple[int, ...]) -> int:
        if function.name == "IF":
            return self._selected(*places)
        if function.name in ("IFERROR", "IFNA"):
            return self._rescued(*places, only_na=function.name == "IFNA")
        if function.name in _FACTORS:
            return self._call("*", (places[0], self._number(_FACTORS[function.name])))
        return self._added(Apply(function, places))

    def _selected(self, condition: int, yes: int, no: int | None = None) -> int:
        yes = self._zero_if_blank(yes)
        no = self.dag.constant(constant(False)) if no is None else self._zero_if_blank(no)
        known = self._known_cell(condition)
        if known is not None and known.plain:
            return yes if known.numbers[0] else no
        return self._added(Select(condition, yes, no))

    def _rescued(self, value: int, instead: int, *, only_na: bool) -> int:
        value, instead = self._zero_if_blank(value), self._zero_if_blank(instead)
        known = self._known_cell(value)
        if known is None:
            return self._added(Rescue(value, instead, only_na))
        kind = int(known.kinds[0])
        return instead if kind == ERROR + ErrorCode.NA or (kind >= ERROR and not only_na) else value

    def _known_cell(self, place: int) -> Value | None:
        """The value of a single constant."""
        node = self.dag.nodes[place]
        return node.value if isinstance(node, Constant) and self.dag.sizes[place] is None else None

    def _added(self, node: Apply | Select | Rescue) -> int:
        try:
            return self.dag.add(node)
        except ValueError:
            raise FormulaError("arrays of different sizes meet", hint="give them as many rows and columns") from None

    def _zero_if_blank(self, place: int) -> int:
        return self._number(0.0) if self._is_blank(place) else place

    def _whole(self, tree: ir.Expression, host: Cell | None) -> list[int]:
        """An argument that may be a range: ranges whole, joined areas one by one, anything else as it computes."""
        match tree:
            case Cell():
                return [self.dag.add(Range(((self.cell(tree),),)))]
            case Area():
                return [self._range(tree)]
            case ir.Binary(",", _, _):
                first, rest = ir.chain(tree)
                return [place for part in (first, *(part for _, part in rest)) for place in self._whole(part, host)]
            case ir.Call("IF") if _gives_area(tree):
                hint = "move the function into the branches of the IF"
                raise FormulaError("an IF that gives a whole range is not supported in this version", hint=hint)
            case _:
                return [self._lower(tree, host)]

    def _range(self, area: Area) -> int:
        rows = range(area.top, area.bottom + 1)
        columns = range(area.left, area.right + 1)
        return self.dag.add(Range(tuple(tuple(self.cell(Cell(area.sheet, r, c)) for c in columns) for r in rows)))

    def _call(self, name: str, places: tuple[int, ...]) -> int:
        if name == "+" and places[1] == self._number(0.0) and self.dag.types[places[0]] is Kind.NUMBER:
            return places[0]
        if name == "^" and places[1] == self._number(2.0):
            return self._call("*", (places[0], places[0]))
        return self._added(Apply(REGISTRY[name], places))


def _gives_area(tree: ir.Expression) -> bool:
    """Whether an `IF` has a range for a branch, its own or that of an `IF` within."""
    if isinstance(tree, ir.Call) and tree.name == "IF":
        return any(_gives_area(branch) for branch in tree.arguments[1:])
    return isinstance(tree, Area)


def _count(fewest: int, most: int) -> str:
    if most == 255:
        return f"{fewest} or more"
    return str(fewest) if fewest == most else f"{fewest} to {most}"


def _unknown_function(name: str) -> FormulaError:
    close = get_close_matches(name, [key for key in REGISTRY if key[0].isalpha()], n=1)
    hint = f"did you mean {close[0]}?" if close else "check its spelling, or replace it by functions xlmc knows"
    return FormulaError(f"the function {name} is not known to xlmc", hint=hint)
