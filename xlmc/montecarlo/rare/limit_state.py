"""What a filter asks, as distances: by how much each of its comparisons fails in a trial.

`at least 0 and below 1` are two comparisons of a cell with a number. A filter that must be TRUE is followed into its
formula, through AND, OR, NOT and IF, to the comparisons there. What is no comparison of numbers is 1 while it fails.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Column, Target
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir

__all__ = ["Fails", "Leaf", "LimitState", "Together", "comparisons_of", "leaves", "lengths", "limit_state", "measure"]

Floats = NDArray[np.float64]

_NEGATED: Final = {"<": ">=", "<=": ">", ">": "<=", ">=": "<", "=": "<>", "<>": "="}
_LEAST: Final = float(np.finfo(np.float64).tiny)
_MOST: Final = 1e300


@dataclass(frozen=True, slots=True, eq=False)
class Leaf:
    """A comparison.

    Attributes:
        holds: whether it does, 1 or 0.
        gap: by how much it fails where it does; None if that is no number.
    """

    holds: Target
    gap: Target | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Together:
    """Several that must all hold, or any of them."""

    parts: tuple[LimitState, ...]
    every: bool


@dataclass(frozen=True, slots=True, eq=False)
class Fails:
    """One that must not hold; by how much it does is not asked."""

    part: LimitState


LimitState = Leaf | Together | Fails


def limit_state(tree: ir.Expression, cell: Cell, formulas: Mapping[Cell, ir.Expression]) -> LimitState:
    """Return what a condition asks.

    Args:
        tree: the condition, as `needed.filter_condition` makes it.
        cell: that it speaks for.
        formulas: the resolved formulas of the cells that it may lead to.
    """
    match tree:
        case ir.Binary("<>", ir.Binary("+", Cell() as truth, ir.Number(0.0)), ir.Number(0.0)) if truth in formulas:
            return comparisons_of(truth, cell, formulas, wanted=True)
    return comparisons_of(tree, cell, formulas, wanted=True)


def comparisons_of(
    tree: ir.Expression, cell: Cell, formulas: Mapping[Cell, ir.Expression], *, wanted: bool
) -> LimitState:
    """Return the comparisons that decide whether a tree, in a cell, is TRUE, or FALSE where that is wanted.

    Args:
        tree: a condition.
        cell: that it stands in.
        formulas: see `limit_state`.
        wanted: TRUE or FALSE.
    """
    match tree:
        case Cell() if tree in formulas:
            return comparisons_of(formulas[tree], tree, formulas, wanted=wanted)
        case ir.Call("NOT", (part,)):
            return comparisons_of(part, cell, formulas, wanted=not wanted)
        case ir.Call("AND" | "OR", parts) if parts and not any(isinstance(part, Area | ir.Missing) for part in parts):
            result = tuple(comparisons_of(part, cell, formulas, wanted=wanted) for part in parts)
            return Together(result, (tree.name == "AND") is wanted)
        case ir.Call("IF", (condition, yes, no)) if not isinstance(yes, ir.Missing) and not isinstance(no, ir.Missing):
            return _either(condition, yes, no, cell, formulas, wanted=wanted)
        case ir.Binary(relation, left, right) if relation in _NEGATED:
            relation = relation if wanted else _NEGATED[relation]
            holds = Target(replace(tree, operator=relation), cell)
            gap = _gap(relation, left, right)
            return Leaf(holds, None if gap is None else Target(gap, cell))
    return Leaf(Target(ir.Binary("<>" if wanted else "=", tree, ir.Number(0.0), all_bits=True), cell))


def _either(
    condition: ir.Expression,
    yes: ir.Expression,
    no: ir.Expression,
    cell: Cell,
    formulas: Mapping[Cell, ir.Expression],
    *,
    wanted: bool,
) -> LimitState:
    """Return the condition and the one part, or neither."""
    sides = (comparisons_of(condition, cell, formulas, wanted=side) for side in (True, False))
    values = (comparisons_of(part, cell, formulas, wanted=wanted) for part in (yes, no))
    return Together(tuple(Together(both, every=True) for both in zip(sides, values, strict=True)), every=False)


def _gap(relation: str, left: ir.Expression, right: ir.Expression) -> ir.Expression | None:
    match relation:
        case "<" | "<=":
            return ir.Binary("-", left, right)
        case ">" | ">=":
            return ir.Binary("-", right, left)
        case "=":
            return ir.Call("ABS", (ir.Binary("-", left, right),))
    return None


def leaves(of: LimitState) -> list[Leaf]:
    """Return the leaves, in order."""
    if isinstance(of, Leaf):
        return [of]
    return [leaf for part in (of.parts if isinstance(of, Together) else (of.part,)) for leaf in leaves(part)]


def measure(of: LimitState, result: Mapping[Leaf, Floats]) -> Floats:
    """(n,) how far each trial is from what is asked, given how far from each comparison: 0 where it holds."""
    if isinstance(of, Leaf):
        return result[of]
    if isinstance(of, Fails):
        return np.asarray(measure(of.part, result) <= 0.0, dtype=np.float64)
    parts = [measure(part, result) for part in of.parts]
    return np.asarray((np.maximum if of.every else np.minimum).reduce(parts))


def lengths(holds: Column, gap: Column | None) -> Floats:
    """(n,) by how much a comparison fails: 0 where it holds, 1 where that is no number, infinite where undecided."""
    known = holds.values != 0 if holds.codes is None else (holds.values != 0) & (holds.codes == 0)
    if gap is None:
        values = np.ones(known.size)
    else:
        apart = gap.as_floats()
        values = np.where(np.isfinite(apart), np.clip(apart, _LEAST, _MOST), 1.0)
    values[known] = 0.0
    if holds.codes is not None:
        values[holds.codes > 0] = np.inf
    return values
