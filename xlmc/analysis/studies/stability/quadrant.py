"""An angle from `ATAN(y/x)` is wrong by half a turn wherever x is negative, unless other formulas put it right.

Whether they do is tried out. In the trials with a negative x the angle is turned by half a turn, and then also every
comparison that tells the sign of x is turned over. What follows from the angle is guarded where the one undoes the
other, up to whole turns: it is in `IF(x<0,PI(),0)+ATAN(y/x)`, and it is not in `IF(x<0,1,2)+ATAN(y/x)`. What does not
change with the angle needs no guard.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.stability.case import RELATIONS, Bools, Case, Floats
from xlmc.analysis.studies.stability.digit_findings import Finding, Level
from xlmc.analysis.studies.stability.formula_trees import factors
from xlmc.analysis.studies.stability.momentum import times
from xlmc.analysis.studies.stability.rewriting import with_quadrant
from xlmc.engine.graph.node_values import Ragged
from xlmc.engine.graph.nodes import Apply, uses
from xlmc.engine.passes.random_rounding import evaluate_changes, formula_of
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.excel.functions.values import TEXT, Value
from xlmc.montecarlo.number_text import styled_text

__all__ = ["Arctangent", "Guards", "arctangents", "guards", "lost_quadrants"]

_SLIGHT: Final = 1e-4
"""Radians: a small turn of the angle, which tells how a cell follows it."""

_ALIKE: Final = 1e-9
"""A share of a number or of a turn: numbers that differ by less count as the same."""

_MOST: Final = 256
"""Trials in which it is tried out."""

_MOST_COMPARISONS: Final = 2000
"""The most comparisons that are searched for those that tell the divisor's sign without naming it, as `x2<x1` for
`x2-x1`. A book with more has a column of them; there only those that name the divisor count."""


@dataclass(frozen=True, slots=True)
class Arctangent:
    """The arctangent of a quotient in a cell's formula.

    Attributes:
        tree: the call of ATAN.
        above, below: the quotient's two parts.
        node, divisor: the nodes of the call and of what stands below the line.
    """

    tree: ir.Call
    above: ir.Expression
    below: ir.Expression
    node: int
    divisor: int


def arctangents(case: Case, cell: Cell) -> Iterator[Arctangent]:
    """Return the arctangents of quotients in a cell's formula, each once; the quotient may stand in a cell of
    its own.
    """
    seen: set[int] = set()
    for part in case.trees.parts(cell):
        if isinstance(part, ir.Call) and part.name == "ATAN" and len(part.arguments) == 1:
            ratio = _quotient(case, part.arguments[0])
            node = case.trees.node_of(part, cell)
            if ratio is not None and node in case.values and node not in seen:
                seen.add(node)
                above, below = ratio
                divisor = case.trees.node_of(below, cell)
                if divisor is not None and divisor in case.values:
                    yield Arctangent(part, above, below, node, divisor)


def _quotient(case: Case, tree: ir.Expression) -> tuple[ir.Expression, ir.Expression] | None:
    """Return what stands above and below the line, if there is one below it; None for anything else."""
    while isinstance(tree, Cell) and tree not in case.lowering.inputs:
        if tree not in case.lowering.graph.formulas:
            return None
        tree = case.trees.formula(tree)
    if isinstance(tree, ir.Binary) and tree.operator == "/":
        return tree.left, tree.right
    above, below = factors(tree)
    return (times(*above), below[0]) if len(below) == 1 and above else None


def lost_quadrants(case: Case) -> Iterator[Finding]:
    """Return the cells that take the arctangent of a quotient whose divisor is negative in some trials.

    Formulas that put it right where the divisor is negative are not reported; see `guards`. Nor are those that
    take only its tangent. A formula in which the angle is meant to be of another size cannot be told from others.
    """
    for cell in case.cells:
        for arctangent in arctangents(case, cell):
            negative: Bools = np.asarray(case.number(arctangent.divisor) < 0)
            if negative.any() and case.node[cell] in guards(case, arctangent.node, arctangent.divisor).lost:
                yield _finding(case, cell, arctangent, negative)


def _finding(case: Case, cell: Cell, arctangent: Arctangent, negative: Bools) -> Finding:
    accepted = negative[case.first_accepted :]
    among = accepted if accepted.any() else negative
    share = float(among.mean())
    tree = case.trees.formula(cell)
    divisor = case.trees.text(arctangent.below, cell)
    trials = "accepted trials" if accepted.any() else "trials drawn, none of them accepted"
    how_many = f"in every one of the {trials}" if share == 1.0 else f"in {styled_text(share, '.1%')} of the {trials}"
    half = "180°" if any(isinstance(one, ir.Call) and one.name == "DEGREES" for one in case.trees.parts(cell)) else "π"
    better = with_quadrant(tree, arctangent.tree, arctangent.above, arctangent.below)
    return Finding(
        Level.WRONG if accepted.any() else Level.DOUBTFUL,
        "quadrant",
        cell,
        case.trees.title(cell),
        case.trees.written_formula(cell),
        f"{case.trees.text(arctangent.tree, cell)} loses the quadrant: as the direction of a vector it is {half} off "
        f"wherever {divisor} is negative",
        f"{how_many} {divisor} is negative: there the direction is wrong by {half}, and no error is shown",
        () if share == 1.0 else case.where(negative, arctangent.divisor),
        case.trees.offer_formula(better, cell),
        (180.0 if half == "180°" else np.pi) * share / case.scale(cell),
    )


@dataclass(frozen=True, slots=True)
class Guards:
    """What becomes of one arctangent.

    Attributes:
        lost: the nodes that take the angle with its quadrant lost; none where no forecast and no filter is among them.
        holding: the nodes that put the angle right.
    """

    lost: frozenset[int]
    holding: frozenset[int]


def guards(case: Case, angle: int, divisor: int) -> Guards:
    """Return what the formulas make of `ATAN(y/divisor)`.

    Args:
        case: the evidence.
        angle: the node of the arctangent.
        divisor: that of x, which is negative in some trial.
    """
    negative = np.asarray(case.number(divisor) < 0)
    rows = np.flatnonzero(negative)
    rows = rows[np.linspace(0, rows.size - 1, min(rows.size, _MOST)).astype(int)]
    trial = _Trial(case, angle, rows)
    return trial.of(dict(_signs(case, divisor, trial.values, negative)))


def _signs(case: Case, divisor: int, values: Mapping[int, Value], negative: Bools) -> Iterator[tuple[int, Value]]:
    """Return the comparisons that tell the sign of the divisor, with what they would give for the other sign."""
    turned = Value(-values[divisor].numbers, values[divisor].kinds)
    for node in case.users.get(divisor, ()):
        formula = formula_of(case.dag, node)
        if isinstance(formula, Apply) and formula.function.name in (*RELATIONS, "SIGN"):
            yield node, evaluate_changes(case.dag, [node], values, {divisor: turned})[node]
    compared = [node for node in case.comparisons if divisor not in uses(formula_of(case.dag, node))]
    for node in compared if len(compared) <= _MOST_COMPARISONS else ():
        if _tells(case, node, negative):
            yield node, Value(1.0 - values[node].numbers, values[node].kinds)


def _tells(case: Case, node: int, negative: Bools) -> bool:
    """Whether a comparison is true where the divisor is negative, or where it is not, in all trials."""
    value = case.values[node]
    if isinstance(value, Ragged) or value.numbers.ndim != 1 or value.has_errors:
        return False
    result = np.broadcast_to(value.numbers, negative.shape) != 0
    return bool((result == negative).all() or (result != negative).all())


class _Trial:
    """The trials in which it is tried out: `values` of all nodes in them."""

    def __init__(self, case: Case, angle: int, rows: NDArray[np.intp]) -> None:
        self._case, self._angle = case, angle
        self._after = case.after(angle)
        self.values = _Taken(case.values, rows)

    def of(self, signs: Mapping[int, Value]) -> Guards:
        """Which nodes the angle reaches with its quadrant lost."""
        turned, both = self._with(np.pi), self._with(np.pi, signs)
        slight = self._with(_SLIGHT)
        lost, holding = {self._angle}, set()
        for node in self._after:
            if not any(part in lost for part in uses(formula_of(self._case.dag, node))):
                continue
            plain = self.values[node]
            if node not in turned or _same(plain, turned[node], 0.0):
                continue
            if node in both and _same(plain, both[node], _turn(plain, slight[node])):
                holding.add(node)
            else:
                lost.add(node)
        targets = {*(self._case.node[row.cell] for row in self._case.model.forecasts), *self._case.conditions}
        return Guards(frozenset(lost if targets & lost else ()), frozenset(holding))

    def _with(self, turn: float, signs: Mapping[int, Value] | None = None) -> dict[int, Value]:
        angle = self.values[self._angle]
        given = {self._angle: Value(angle.numbers + turn, angle.kinds), **(signs or {})}
        return evaluate_changes(self._case.dag, self._case.after(*given), self.values, given)


class _Taken(Mapping[int, Value]):
    """Node -> its values in some trials, taken when they are asked for."""

    def __init__(self, values: Mapping[int, Value], rows: NDArray[np.intp]) -> None:
        self._values, self._rows = values, rows
        self._taken: dict[int, Value] = {}

    def __getitem__(self, node: int) -> Value:
        if node not in self._taken:
            self._taken[node] = self._values[node].take(self._rows)
        return self._taken[node]

    def __iter__(self) -> Iterator[int]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)


def _turn(plain: Value, slight: Value) -> float:
    """Return a whole turn in the units of a node that follows the angle evenly; 0 where it does not."""
    slopes: Floats = np.abs(slight.numbers - plain.numbers).ravel() / _SLIGHT
    if isinstance(plain, Ragged) or not slopes.size or np.ptp(slopes) > 1e-6 * slopes.max():
        return 0.0
    return float(2 * np.pi * np.median(slopes))


def _same(one: Value, other: Value, turn: float) -> bool:
    """Whether two values are the same in all trials, up to whole turns."""
    if isinstance(one, Ragged) or isinstance(other, Ragged) or one.numbers.shape[1:] != other.numbers.shape[1:]:
        return False
    if (one.kinds != other.kinds).any():
        return False
    if (one.kinds == TEXT).any():
        return bool(np.array_equal(one.objects(), other.objects()))
    off = other.numbers - one.numbers
    if turn:
        off = off - turn * np.rint(off / turn)
    size = np.maximum(np.maximum(np.abs(one.numbers), turn), _usual(one.numbers))
    return bool((np.abs(off) <= _ALIKE * size).all())


def _usual(values: Floats) -> float:
    """Return the size of most of a node's numbers: beside it, what is left of a 0 by rounding is nothing."""
    sizes = np.abs(values[np.isfinite(values)])
    return float(np.median(sizes)) if sizes.size else 0.0
