"""Directions that are averaged as numbers: the mean of 359° and 1° is 180°, the opposite of both."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.analysis.studies.stability.case import Case, Floats
from xlmc.analysis.studies.stability.digit_findings import Finding, Level
from xlmc.analysis.studies.stability.formula_trees import replace_part, terms
from xlmc.engine.graph.nodes import Constant
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir
from xlmc.montecarlo.number_text import styled_text

__all__ = ["averaged_directions"]

_MEANS: Final = frozenset({"AVERAGE", "AVERAGEA", "MEDIAN", "TRIMMEAN"})

_MOST: Final = 1000
"""Directions in a mean that are looked at."""

_DEGREES, _RADIANS = 360.0, 2.0 * math.pi


@dataclass(frozen=True, slots=True)
class _Mean:
    """A mean in a formula.

    Attributes:
        tree: the part of the formula.
        of: what it is the mean of, cell by cell.
        given: the same as written, ranges among them.
    """

    tree: ir.Expression
    of: tuple[ir.Expression, ...]
    given: tuple[ir.Expression, ...]


def averaged_directions(case: Case) -> Iterator[Finding]:
    """Return the cells that average directions which lie more than half a turn apart as numbers in some trials.

    A direction is what MOD by a whole turn, ATAN2 or an arctangent in degrees gives: there its numbers jump by a turn.
    """
    for cell in case.cells:
        for mean in _means(case, cell):
            turn, *others = {_turn(case, one, cell) for one in mean.of}
            if others or turn is None:
                continue
            numbers = _numbers(case, cell, mean.of)
            apart = None if numbers is None else numbers.max(axis=0) - numbers.min(axis=0) > turn / 2.0
            if apart is not None and apart.any():
                yield _finding(case, cell, mean, turn, apart)


def _means(case: Case, cell: Cell) -> Iterator[_Mean]:
    """Return the means in a formula: calls of AVERAGE and its kin, and sums divided by the number of their terms."""
    for part in case.trees.parts(cell):
        match part:
            case ir.Call(name, arguments) if name in _MEANS:
                given = arguments[:1] if name == "TRIMMEAN" else arguments
                yield from _mean(part, given)
            case ir.Binary("/", above, ir.Number(count)):
                yield from _of_sum(part, above, count)
            case ir.Binary("*", ir.Number(share), total) | ir.Binary("*", total, ir.Number(share)) if share > 0.0:
                yield from _of_sum(part, total, 1.0 / share)


def _of_sum(tree: ir.Expression, total: ir.Expression, count: float) -> Iterator[_Mean]:
    signed = terms(total)
    given = tuple(term for _, term in signed)
    if isinstance(total, ir.Call) and total.name == "SUM":
        given = total.arguments
    means = list(_mean(tree, given))
    if all(sign > 0 for sign, _ in signed) and means and abs(len(means[0].of) - count) < 1e-9:
        yield from means


def _mean(tree: ir.Expression, given: Sequence[ir.Expression]) -> Iterator[_Mean]:
    size = sum(one.rows * one.columns if isinstance(one, Area) else 1 for one in given)
    if 2 <= size <= _MOST:
        of: list[ir.Expression] = [cell for one in given for cell in (one.cells() if isinstance(one, Area) else (one,))]
        yield _Mean(tree, tuple(of), tuple(given))


def _turn(case: Case, tree: ir.Expression, cell: Cell) -> float | None:
    """Return a full turn in the units of a direction; otherwise None."""
    host = cell
    while isinstance(tree, Cell) and tree not in case.lowering.inputs and tree in case.lowering.graph.formulas:
        host, tree = tree, case.trees.formula(tree)
    match tree:
        case ir.Call("MOD", (_, divisor)):
            node = case.trees.node_of(divisor, host)
            known = None if node is None else case.dag.nodes[node]
            size = float(known.value.numbers.flat[0]) if isinstance(known, Constant) else 0.0
            return next((turn for turn in (_DEGREES, _RADIANS) if math.isclose(size, turn)), None)
        case ir.Call("DEGREES", (ir.Call("ATAN2", _),)):
            return _DEGREES
        case ir.Call("ATAN2", _):
            return _RADIANS
    return None


def _numbers(case: Case, cell: Cell, of: Sequence[ir.Expression]) -> Floats | None:
    """`(k, n)` the numbers of k directions; None if one has no node."""
    nodes = [case.trees.node_of(one, cell) for one in of]
    if any(node not in case.values for node in nodes):
        return None
    return np.array([np.broadcast_to(case.number(node), (case.n,)) for node in nodes if node is not None])


def _finding(
    case: Case, cell: Cell, mean: _Mean, turn: float, apart: np.ndarray[tuple[int], np.dtype[np.bool_]]
) -> Finding:
    accepted = apart[case.first_accepted :]
    among, trials = (accepted, "accepted trials") if accepted.any() else (apart[case.special :], "trials drawn")
    share = float(among.mean()) if among.size else 1.0
    half = "180°" if turn == _DEGREES else "π"
    whole = replace_part(case.trees.formula(cell), mean.tree, _of_vectors(mean.given, turn))
    node = case.trees.node_of(mean.tree, cell)
    return Finding(
        Level.WRONG if accepted.any() else Level.DOUBTFUL,
        "direction",
        cell,
        case.trees.title(cell),
        case.trees.written_formula(cell),
        f"{case.trees.text(mean.tree, cell)} averages directions as numbers, and these jump by a full turn",
        f"in {styled_text(share, '.1%')} of the {trials} they lie on both sides of the jump: there the "
        f"mean is up to {half} off, and "
        "no error is shown",
        () if node is None else case.where(apart, node),
        case.trees.offer_formula(whole, cell),
        share,
    )


def _of_vectors(given: Sequence[ir.Expression], turn: float) -> ir.Expression:
    """Return the direction of the sum of unit vectors, from 0 to a full turn."""
    in_degrees = turn == _DEGREES
    sums = []
    for function in ("COS", "SIN"):
        expression: ir.Expression | None = None
        for one in given:
            angle = ir.Call("RADIANS", (one,)) if in_degrees else one
            part: ir.Expression = ir.Call(function, (angle,))
            part = ir.Call("SUMPRODUCT", (part,)) if isinstance(one, Area) else part
            expression = part if expression is None else ir.Binary("+", expression, part)
        assert expression is not None
        sums.append(expression)
    direction: ir.Expression = ir.Call("ATAN2", tuple(sums))
    if in_degrees:
        return ir.Call("MOD", (ir.Call("DEGREES", (direction,)), ir.Number(_DEGREES)))
    return ir.Call("MOD", (direction, ir.Binary("*", ir.Number(2.0), ir.Call("PI", ()))))
