"""Formulas walked back to one assumption: what it must be, all others given, for the filters to hold.

The assumption occurs once on the way from a comparison, below operations that can be undone; or the value is
a + b·x, or a ratio of two such, however often x occurs: x is the assumption, or a cell that all that depends on the
assumption depends on it through (a gate), and is undone in turn. The parts that do not depend on it are computed as any
formula is. Where a comparison cannot be undone, it is left out: what is found then holds more than the accepted
values, never less.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import count
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Target
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir
from xlmc.montecarlo.rare import inverse_image
from xlmc.montecarlo.rare.limit_state import Leaf, LimitState, Together
from xlmc.montecarlo.rare.spans import Spans, choose, intersection, union

__all__ = ["Inverting", "Region", "conjuncts"]

Floats = NDArray[np.float64]

Known = Sequence[Floats]
"""The values of the targets that were asked for, (n,) each; NaN where one is an error."""

Region = Callable[[Known], Spans]
"""The values that the assumption may have, given what is known."""

Undo = Callable[[Spans, Known], Spans]
"""The same for a formula to have a value within bounds."""

_Pair = tuple[ir.Expression, ir.Expression]

_DEEPEST: Final = 150
"""Operations from a filter to the assumption."""

_MOST_STEPS: Final = 2_000
"""Parts of a formula that is written out as a line."""

_MOST_CELLS: Final = 200
"""The most cells of an area that is written out."""


def conjuncts(filters: Sequence[LimitState]) -> Iterator[LimitState]:
    """Yield what must hold, all of it, in the smallest parts."""
    for each in filters:
        if isinstance(each, Together) and each.every:
            yield from conjuncts(each.parts)
        else:
            yield each


class Inverting:
    """Undoes formulas down to one assumption.

    Args:
        assumption: its cell.
        formulas: the resolved formulas of the cells that may lead to it.
        depends: whether a tree depends on the assumption.
        gates: cells that all that depends on the assumption depends on it through, one after the other.

    Attributes:
        targets: what must be known in each trial.
        turned: trees, among them, whose values must lie within `inverse_image.TURNS` of 0.
    """

    def __init__(
        self,
        assumption: Cell,
        formulas: Mapping[Cell, ir.Expression],
        depends: Callable[[ir.Expression], bool],
        gates: Sequence[Cell] = (),
    ) -> None:
        self._assumption, self._formulas, self._depends = assumption, formulas, depends
        self._gates = (assumption, *gates)
        self._depth = 0
        self.targets: list[Target] = []
        self.turned: list[int] = []

    def region(self, of: LimitState) -> Region | None:
        """Return the values with which a condition can hold; None if they are not known."""
        if isinstance(of, Leaf):
            return self._comparison(of.holds)
        if not isinstance(of, Together):
            return None
        parts = [self.region(part) for part in of.parts]
        result = [part for part in parts if part is not None]
        if not result or (not of.every and len(result) < len(parts)):
            return None
        together = intersection if of.every else union
        return lambda known: together([part(known) for part in result])

    def _comparison(self, holds: Target) -> Region | None:
        tree, cell = holds.tree, holds.cell
        if not self._depends(tree):
            index = self._known(tree, cell)
            return lambda known: Spans.where(known[index] == 1.0)
        if not isinstance(tree, ir.Binary) or tree.operator not in ("<", "<=", ">", ">="):
            return None
        left, right = (tree.left, tree.right) if tree.operator[0] == ">" else (tree.right, tree.left)
        if not self._depends(right):
            return self._bounded(left, right, cell, below=False)
        if not self._depends(left):
            return self._bounded(right, left, cell, below=True)
        return self._bounded(ir.Binary("-", left, right), ir.Number(0.0), cell, below=False)

    def _bounded(self, tree: ir.Expression, bound: ir.Expression, cell: Cell, *, below: bool) -> Region | None:
        undo = self._undo(tree, cell)
        if undo is None:
            return None
        index, endless = self._known(bound, cell), np.full(1, -np.inf if below else np.inf)

        def result(known: Known) -> Spans:
            end = known[index]
            far = np.broadcast_to(endless, end.shape)
            return undo(Spans.between(far, end) if below else Spans.between(end, far), known)

        return result

    def _known(self, tree: ir.Expression, cell: Cell) -> int:
        """Return the place in which the number that a tree gives will be known."""
        self.targets.append(Target(ir.Binary("+", tree, ir.Number(0.0)), cell))
        return len(self.targets) - 1

    def _undo(self, tree: ir.Expression, cell: Cell) -> Undo | None:
        """See `Undo`; None if the tree cannot be undone."""
        if self._depth > _DEEPEST:
            return None
        self._depth += 1
        try:
            return self._undone(tree, cell)
        finally:
            self._depth -= 1

    def _undone(self, tree: ir.Expression, cell: Cell) -> Undo | None:
        match tree:
            case Cell() if tree == self._assumption:
                return lambda value, _: value
            case Cell() if tree in self._formulas:
                return self._undo(self._formulas[tree], tree)
            case ir.Unary(operator, operand):
                return self._through(operator, operand, cell)
            case ir.Binary(operator, left, right):
                return self._of_two(operator, left, right, cell)
            case ir.Call("IF", (condition, yes, no)) if not self._depends(condition):
                return self._branches(condition, yes, no, cell)
            case ir.Call("SUM" | "SUMSQ" | "MAX" | "MIN" | "PRODUCT", _):
                return self._of_many(tree, cell)
            case ir.Call("POWER", (base, power)):
                return self._undo(ir.Binary("^", base, power), cell)
            case ir.Call("LOG", (part,)) | ir.Call("LOG", (part, ir.Number(10.0))):
                return self._through("LOG10", part, cell)
            case ir.Call("PI", ()):
                return None
            case ir.Call(name, (part,)):
                return self._through(name, part, cell)
        return None

    def _through(self, name: str, part: ir.Expression, cell: Cell) -> Undo | None:
        """Through a function of one argument."""
        function = inverse_image.FUNCTIONS.get(name)
        undo = None if function is None else self._undo(part, cell)
        if function is None or undo is None:
            return None
        if name in inverse_image.PERIODIC:
            self.turned.append(self._known(part, cell))
        return lambda value, known: undo(function(value), known)

    def _of_two(self, operator: str, left: ir.Expression, right: ir.Expression, cell: Cell) -> Undo | None:
        if self._depends(left) and self._depends(right):
            both = (left, right) if operator == "/" else (ir.Binary(operator, left, right),)
            return self._straight(both, cell)
        if operator == "^" and isinstance(right, ir.Number):
            return self._power(left, right.value, cell)
        if self._depends(left):
            step = {"+": inverse_image.term, "-": _minus, "*": inverse_image.factor, "/": inverse_image.numerator}.get(
                operator
            )
            return None if step is None else self._beside(step, left, right, cell)
        step = {
            "+": inverse_image.term,
            "-": lambda value, o: inverse_image.negated(inverse_image.term(value, o)),
            "*": inverse_image.factor,
            "/": inverse_image.divisor,
            "^": inverse_image.exponent,
        }.get(operator)
        return None if step is None else self._beside(step, right, left, cell)

    def _beside(
        self, step: Callable[[Spans, Floats], Spans], part: ir.Expression, other: ir.Expression, cell: Cell
    ) -> Undo | None:
        undo = self._undo(part, cell)
        if undo is None:
            return None
        index = self._known(other, cell)
        return lambda value, known: undo(step(value, known[index]), known)

    def _power(self, base: ir.Expression, power: float, cell: Cell) -> Undo | None:
        undo = self._undo(base, cell)
        if undo is None or not 1e-3 < abs(power) < 1e3:
            return None
        return lambda value, known: undo(inverse_image.powered(value, power), known)

    def _branches(self, condition: ir.Expression, yes: ir.Expression, no: ir.Expression, cell: Cell) -> Undo | None:
        first, second = self._value(yes, cell), self._value(no, cell)
        if first is None or second is None:
            return None
        index = self._known(ir.Call("IF", (condition, ir.Number(1.0), ir.Number(0.0))), cell)
        return lambda value, known: choose(known[index] == 1.0, first(value, known), second(value, known))

    def _value(self, tree: ir.Expression, cell: Cell) -> Undo | None:
        """How to undo a tree that may not depend on the assumption at all: then all values are possible, or none."""
        if self._depends(tree):
            return self._undo(tree, cell)
        index = self._known(tree, cell)
        return lambda value, known: Spans.where(value.contain(known[index]))

    def _of_many(self, tree: ir.Call, cell: Cell) -> Undo | None:
        """How to undo a function of several arguments, one of which depends on the assumption."""
        parts = list(_written_out(tree.arguments))
        varying = [part for part in parts if self._depends(part)]
        rest = tuple(part for part in parts if not self._depends(part))
        if tree.name in ("SUM", "SUMSQ") and len(varying) > 1:
            return self._straight((tree,), cell) if tree.name == "SUM" else None
        if len(varying) != 1 or (tree.name == "PRODUCT" and len(parts) > len(tree.arguments)):
            return None
        one: ir.Expression = ir.Binary("^", varying[0], ir.Number(2.0)) if tree.name == "SUMSQ" else varying[0]
        if not rest:
            return self._undo(one, cell)
        step = {"MAX": inverse_image.largest, "MIN": inverse_image.smallest, "PRODUCT": inverse_image.factor}.get(
            tree.name, inverse_image.term
        )
        return self._beside(step, one, ir.Call(tree.name, rest), cell)

    def _straight(self, trees: Sequence[ir.Expression], cell: Cell) -> Undo | None:
        """How to undo a + b·x, or (a + b·x) / (c + d·x) where there are two trees; x is the assumption or a gate."""
        for gate in self._gates:
            lines = [self._line(each, gate) for each in trees]
            known = [each for each in lines if each is not None]
            undo = self._undo(gate, cell) if len(known) == len(lines) else None
            if undo is not None:
                return self._after(undo, known, cell)
        return None

    def _after(self, undo: Undo, lines: Sequence[_Pair], cell: Cell) -> Undo:
        indices = [self._known(each, cell) for line in lines for each in line]
        step = inverse_image.ratio if len(lines) > 1 else inverse_image.line
        return lambda value, given: undo(step(value, *(given[index] for index in indices)), given)

    def _line(self, tree: ir.Expression, x: Cell) -> _Pair | None:
        """Return the formulas a and b of a + b·x; None if the tree is no such line, or a long one."""
        steps = count()
        expression = self._line_of(tree, x, steps)
        return expression if next(steps) <= _MOST_STEPS else None

    def _line_of(self, tree: ir.Expression, x: Cell, steps: Iterator[int]) -> _Pair | None:
        line = partial(self._line_of, x=x, steps=steps)
        if next(steps) >= _MOST_STEPS:
            return None
        if not self._depends(tree):
            return tree, ir.Number(0.0)
        match tree:
            case Cell() if tree == x:
                return ir.Number(0.0), ir.Number(1.0)
            case Cell() if tree in self._formulas:
                return line(self._formulas[tree])
            case ir.Unary(operator, operand):
                return _both(line(operand), lambda part: ir.Unary(operator, part))
            case ir.Binary("+" | "-", left, right):
                first, second = line(left), line(right)
                if first is None or second is None:
                    return None
                return ir.Binary(tree.operator, first[0], second[0]), ir.Binary(tree.operator, first[1], second[1])
            case ir.Binary("*", left, right) if not self._depends(left):
                return _both(line(right), lambda part: ir.Binary("*", left, part))
            case ir.Binary("*" | "/", left, right) if not self._depends(right):
                return _both(line(left), lambda part: ir.Binary(tree.operator, part, right))
            case ir.Call("SUM", arguments):
                lines = [line(part) for part in _written_out(arguments)]
                known = [each for each in lines if each is not None]
                if len(known) < len(lines):
                    return None
                return ir.Call("SUM", tuple(a for a, _ in known)), ir.Call("SUM", tuple(b for _, b in known))
        return None


def _minus(value: Spans, o: Floats) -> Spans:
    """Invert s − o."""
    return inverse_image.term(value, -o)


def _both(line: _Pair | None, made: Callable[[ir.Expression], ir.Expression]) -> _Pair | None:
    return None if line is None else (made(line[0]), made(line[1]))


def _written_out(arguments: Sequence[ir.Expression]) -> Iterator[ir.Expression]:
    """Arguments, areas of few cells as these cells."""
    for each in arguments:
        if isinstance(each, Area) and each.rows * each.columns <= _MOST_CELLS:
            yield from each.cells()
        else:
            yield each
