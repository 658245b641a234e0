"""Which part of a formula loses the digits.

Two operations do: a division by something near 0, and a difference of nearly equal numbers. Where it is neither, parts
are tried: the culprit is the innermost part whose exact value, put in instead of it, takes the error away.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.analysis.studies.stability.case import Case, Floats
from xlmc.analysis.studies.stability.formula_trees import factors, terms
from xlmc.engine.graph.nodes import Input
from xlmc.engine.passes.random_rounding import closure, evaluate, evaluate_changes, formula_of, numbers_of
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value

__all__ = ["Cancellation", "Division", "cancellation", "culprit", "divisions", "left_of", "only_assumption", "zeros"]

_HEALED: Final = 0.1
_SURELY_HEALED: Final = 1e-3
"""Shares of the error that may be left: the first if that is no more than a sound formula has."""

_SOUND: Final = 10.0
"""Times what rounding the assumptions alone would bring."""

_MOST_PARTS: Final = 300

_GRID: Final = 4001
_BISECTIONS: Final = 80


@dataclass(frozen=True, slots=True)
class Division:
    """A division in a formula by a product of which one factor comes near 0.

    Attributes:
        tree: the quotient.
        factor: below the line.
        node: of the factor.
        least: how small it gets, as a share of the size it usually has, or could have.
        crosses: whether it has either sign among the trials.
    """

    tree: ir.Expression
    factor: ir.Expression
    node: int
    least: float
    crosses: bool


@dataclass(frozen=True, slots=True)
class Cancellation:
    """A sum in a formula that is small beside its terms.

    Attributes:
        tree: the sum.
        left: what is left of its terms in a trial, as a share of them.
    """

    tree: ir.Expression
    left: float


def divisions(case: Case, cell: Cell) -> list[Division]:
    """Return the divisions of a cell's formula by what varies, the smallest divisor first."""
    result = []
    for tree in case.trees.parts(cell):
        if isinstance(tree, ir.Binary) and tree.operator == "/":
            for factor in factors(tree.right)[0]:
                one = _division(case, cell, tree, factor)
                if one is not None:
                    result.append(one)
    return sorted(result, key=lambda division: division.least)


def _division(case: Case, cell: Cell, tree: ir.Expression, factor: ir.Expression) -> Division | None:
    node = case.trees.node_of(factor, cell)
    if node not in case.values or isinstance(factor, ir.Number):
        return None
    values = case.number(node)
    values = values[np.isfinite(values)]
    if not values.size:
        return None
    size = 1.0 if _is_bounded(factor) else float(np.median(np.abs(values))) or float(np.abs(values).max())
    least = float(np.abs(values).min()) / size if size else 0.0
    return Division(tree, factor, node, least, bool(values.min() < 0 < values.max()))


def _is_bounded(tree: ir.Expression) -> bool:
    """Whether it is a sine or its like, which could be as large as 1."""
    row = function_named(tree.name) if isinstance(tree, ir.Call) else None
    return row is not None and row.facts.result_range == (-1.0, 1.0)


def cancellation(case: Case, cell: Cell, trial: int) -> Cancellation | None:
    """Return the sum of a cell's formula of which least is left in a trial."""
    cancellations = [
        Cancellation(tree, left_of(case, cell, tree, trial))
        for tree in case.trees.parts(cell)
        if isinstance(tree, ir.Binary) and tree.operator in "+-" and not _is_given(case, tree)
    ]
    return min(cancellations, key=lambda one: one.left, default=None)


def _is_given(case: Case, tree: ir.Expression) -> bool:
    """Whether all terms are assumptions and typed numbers, so that none of them has an error to hand on."""
    inputs = case.lowering.inputs
    return all(isinstance(term, ir.Number) or (isinstance(term, Cell) and term in inputs) for _, term in terms(tree))


def left_of(case: Case, cell: Cell, tree: ir.Expression, trial: int) -> float:
    """Return what is left of a sum in a trial, as a share of its terms; 1 where it has none."""
    size = sum(_size(case, cell, term, trial) for _, term in terms(tree))
    return _size(case, cell, tree, trial) / size if size > 0 else 1.0


def _size(case: Case, cell: Cell, tree: ir.Expression, trial: int) -> float:
    node = case.trees.node_of(tree, cell)
    if node not in case.values:
        return 0.0
    size = abs(float(case.number(node)[trial]))
    return size if np.isfinite(size) else 0.0


def culprit(case: Case, cell: Cell, trials: Sequence[int]) -> ir.Expression | None:
    """Return the innermost part of a cell's formula that is to blame for its error; otherwise None.

    Args:
        case: the evidence.
        cell: whose formula.
        trials: in which it is off.
    """
    parts = list(case.trees.parts(cell))
    if len(parts) > _MOST_PARTS:
        return None
    return next((part for part in reversed(parts) if _heals(case, cell, part, trials)), None)


def _heals(case: Case, cell: Cell, part: ir.Expression, trials: Sequence[int]) -> bool:
    whole, node = case.node[cell], case.trees.node_of(part, cell)
    if node not in case.values or isinstance(part, ir.Number):
        return False
    wanted, cured = _exact(case, whole, trials), _exact(case, node, trials)
    before = np.abs(case.number(whole)[list(trials)] - wanted)
    after = np.abs(_with(case, whole, node, cured, trials) - wanted)
    known = np.isfinite(before) & (before > 0)
    if not known.any() or not np.isfinite(after[known]).all():
        return False
    inherent = np.nan_to_num(case.inherent(cell)[list(trials)])[known]
    left = float(np.median(after[known] / before[known]))
    return left <= _SURELY_HEALED or (left <= _HEALED and bool(np.median(after[known] - _SOUND * inherent) <= 0))


def _exact(case: Case, node: int, trials: Sequence[int]) -> Floats:
    return np.array([case.exact_number(node, trial) for trial in trials])


def _with(case: Case, whole: int, node: int, cured: Floats, trials: Sequence[int]) -> Floats:
    """Return a cell's numbers where a part of it has its exact value, `(m,)` of m trials."""
    rows = np.asarray(trials, np.intp)
    after = set(case.after(node))
    order = [one for one in closure(case.dag, [whole]) if one in after]
    fixed = {one: case.values[one].take(rows) for one in closure(case.dag, [whole])}
    return np.array(
        numbers_of(evaluate_changes(case.dag, order, fixed, {node: Value.of_numbers(cured)})[whole], rows.size)
    )


def only_assumption(case: Case, node: int) -> str | None:
    """Return the name of the only assumption that a node depends on; None if it depends on none or several."""
    result = {
        formula.name
        for part in closure(case.dag, [node])
        if isinstance(formula := formula_of(case.dag, part), Input) and formula.name in case.draws
    }
    return result.pop() if len(result) == 1 else None


def zeros(case: Case, node: int, key: str) -> list[float]:
    """Return the values of its only assumption at which a node is 0, within the range and as far again to either side.

    Rounded to 12 digits where that is as near, so that 270° is 270.
    """
    nodes = closure(case.dag, [node])

    def at(x: np.ndarray[tuple[int], np.dtype[np.float64]]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        return np.array(numbers_of(evaluate(case.dag, nodes, {key: x})[node], x.size))

    low, high = float(case.draws[key].min()), float(case.draws[key].max())
    width = (high - low) or max(abs(low), 1.0) / 100
    grid = np.linspace(low - width, high + width, _GRID)
    values = at(grid)
    with np.errstate(invalid="ignore"):
        turns = np.flatnonzero((np.sign(values[:-1]) * np.sign(values[1:]) < 0) | (values[:-1] == 0))
    result = []
    for turn in turns:
        left, right = grid[turn : turn + 1].copy(), grid[turn + 1 : turn + 2].copy()
        sign = np.sign(at(left))
        for _ in range(_BISECTIONS):
            middle = (left + right) / 2
            if np.sign(at(middle)) == sign:
                left = middle
            else:
                right = middle
        round_ = float(f"{right[0]:.12g}")
        jumps = abs(at(left)[0] - at(right)[0]) > 1e-6 * np.nanmax(np.abs(values))
        if not jumps:
            result.append(round_)
    return result
