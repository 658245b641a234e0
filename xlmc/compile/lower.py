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
from xlmc.functions.values import BLANK, Value, constant

__all__ = ["Lowering"]


_FACTORS = {"RADIANS": np.pi / 180, "DEGREES": 180 / np.pi}
"""Functions that are a multiplication, to the last bit; NumPy's own are several times slower."""


class Lowering:
    """The nodes of every needed cell of a graph.

    Args:
        graph: the needed cells, in dependency order.
        inputs: the assumption cells and the names of their inputs; any other cell that holds a value is constant.
        held: cells held at a value of their own: frozen assumptions.

    Attributes:
        graph, inputs, held: as given.
        dag: the nodes.
        notices: what the person should know.
    """

    def __init__(self, graph: Graph, inputs: Mapping[Cell, str], held: Mapping[Cell, float]) -> None:
        self.dag = Dag()
        self.notices: list[Notice] = []
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
        return self._lower(target.tree, target.cell)

    def known(self, target: Target) -> Value | None:
        """The target's value where no input reaches it; None where one does."""
        node = self.dag.nodes[self.target(target)]
        return node.value if isinstance(node, Constant) else None

    def _number(self, value: float) -> int:
        return self.dag.constant(constant(value))

    def _formula_cell(self, cell: Cell, tree: ir.Expression) -> int:
        try:
            self._refuse_arrays(cell)
            place = self._lower(tree, cell)
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
        return self.dag.constant(constant(value))

    def _refuse_arrays(self, cell: Cell) -> None:
        formula = self.graph.workbook.content(cell).formula
        if formula is not None and (formula.array is not None or formula.dynamic):
            raise FormulaError("array formulas are not supported in this version")

    def _held_cell(self, cell: Cell) -> int:
        return self.dag.constant(constant(self.graph.workbook.content(cell).value))

    def _is_blank(self, place: int) -> bool:
        node = self.dag.nodes[place]
        return isinstance(node, Constant) and node.value.numbers.ndim == 1 and int(node.value.kinds[0]) == BLANK

    def _lower(self, tree: ir.Expression, host: Cell) -> int:
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
                return self._intersected(tree, host)
            case ir.Array(rows):
                return self._lower(rows[0][0], host)
            case ir.Unary(operator, operand):
                return self._call(_prefixed(operator), (self._lower(operand, host),))
            case ir.Binary(operator, left, right):
                return self._operation(operator, left, right, host)
            case ir.Call(name, arguments):
                return self._function_call(name, arguments, host)
            case ir.Reference() | ir.Name() | ir.TableReference():
                raise TypeError(f"not resolved: {tree}")
            case _:
                assert_never(tree)

    def _operation(self, operator: str, left: ir.Expression, right: ir.Expression, host: Cell) -> int:
        if operator == ",":
            raise FormulaError("several areas joined by commas stand where one value is needed")
        return self._call(operator, (self._lower(left, host), self._lower(right, host)))

    def _intersected(self, area: Area, host: Cell) -> int:
        """The cell of a one-column (one-row) area in the host's row (column), as a plain formula takes it."""
        if area.left == area.right and area.top <= host.row <= area.bottom:
            return self.cell(Cell(area.sheet, host.row, area.left))
        if area.top == area.bottom and area.left <= host.column <= area.right:
            return self.cell(Cell(area.sheet, area.top, host.column))
        return self.dag.constant(constant(ErrorCode.VALUE))

    def _function_call(self, name: str, arguments: tuple[ir.Expression, ...], host: Cell) -> int:
        if name == "SINGLE":
            return self._lower(arguments[0], host)
        function = function_named(name)
        if function is None:
            raise _unknown_function(name)
        fewest, most = function.arity()
        if not fewest <= len(arguments) <= most:
            raise FormulaError(f"{name} has {len(arguments)} arguments; it takes {_count(fewest, most)}")
        places: list[int] = []
        for position, argument in enumerate(arguments):
            whole = function.parameter(position).ranged
            places += self._whole(argument, host) if whole else [self._lower(argument, host)]
        return self._made(function, tuple(places))

    def _made(self, function: Function, places: tuple[int, ...]) -> int:
        if function.name == "IF":
            no = places[2] if len(places) == 3 else self.dag.constant(constant(False))
            return self.dag.add(Select(places[0], self._zero_if_blank(places[1]), self._zero_if_blank(no)))
        if function.name in ("IFERROR", "IFNA"):
            value, instead = (self._zero_if_blank(place) for place in places)
            return self.dag.add(Rescue(value, instead, function.name == "IFNA"))
        if function.name in _FACTORS:
            return self._call("*", (places[0], self._number(_FACTORS[function.name])))
        return self.dag.add(Apply(function, places))

    def _zero_if_blank(self, place: int) -> int:
        return self._number(0.0) if self._is_blank(place) else place

    def _whole(self, tree: ir.Expression, host: Cell) -> list[int]:
        """An argument that may be a range: ranges whole, joined areas one by one, anything else as one value."""
        match tree:
            case Cell():
                return [self.dag.add(Range(((self.cell(tree),),)))]
            case Area():
                return [self._range(tree)]
            case ir.Binary(",", left, right):
                return self._whole(left, host) + self._whole(right, host)
            case ir.Array(rows):
                return [self.dag.add(Range(tuple(tuple(self._lower(part, host) for part in row) for row in rows)))]
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
        return self.dag.add(Apply(REGISTRY[name], places))


def _prefixed(operator: str) -> str:
    return operator if operator == "%" else f"u{operator}"


def _count(fewest: int, most: int) -> str:
    if most == 255:
        return f"{fewest} or more"
    return str(fewest) if fewest == most else f"{fewest} to {most}"


def _unknown_function(name: str) -> FormulaError:
    close = get_close_matches(name, [key for key in REGISTRY if key[0].isalpha()], n=1)
    hint = f"did you mean {close[0]}?" if close else "check its spelling, or replace it by functions xlmc knows"
    return FormulaError(f"the function {name} is not known to xlmc", hint=hint)
