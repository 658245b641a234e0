"""Formulas that jump inside the ranges: the two branches of an IF differ where its condition turns."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from xlmc.address import Cell
from xlmc.evaluation.graph.nodes import Constant, uses
from xlmc.evaluation.passes.random_rounding import formula_of, numbers
from xlmc.formula import ir
from xlmc.functions.families import function_named
from xlmc.studies.stability.case import Case, Floats
from xlmc.studies.stability.findings import Finding, Level, Where
from xlmc.studies.stability.guards import guards
from xlmc.studies.stability.quadrant import arctangents

__all__ = ["jumps"]

_NEAREST: Final = 20
"""Trials next to where the condition turns."""

_TOLD: Final = 0.01
"""Of the cell's central range."""


def jumps(case: Case) -> Iterator[Finding]:
    """The choices and lookups that take different ways in different trials, and by how much the cell jumps there."""
    mending = _mending(case)
    for cell in case.cells:
        for part in case.trees.parts(cell):
            if isinstance(part, ir.Call) and part.name == "IF" and len(part.arguments) > 1:
                if _is_among(case, cell, part, mending):
                    continue
                finding = _of_choice(case, cell, part)
                if finding is not None:
                    yield finding
    for kink in case.derivatives.kinks:
        row = function_named(kink.function)
        if row is not None and row.facts.finds and kink.cell in case.node:
            text = f"{kink.function} finds {kink.ways} different cells among the trials"
            yield _finding(case, kink.cell, text, "the cell steps from one to the next", kink.share)


def _mending(case: Case) -> set[int]:
    """The choices that mend the quadrant of an arctangent: they jump so that the angle does not."""
    found: set[int] = set()
    for cell in case.cells:
        for one in arctangents(case, cell):
            if (case.number(one.divisor) < 0).any():
                for place in guards(case, one.place, one.divisor).holding:
                    found |= {place, *uses(formula_of(case.dag, place))}
    return found


def _is_among(case: Case, cell: Cell, part: ir.Call, mending: set[int]) -> bool:
    place = case.trees.place(part, cell)
    return place is not None and place in mending


def _of_choice(case: Case, cell: Cell, part: ir.Call) -> Finding | None:
    test = part.arguments[0]
    if not (isinstance(test, ir.Binary) and test.operator in ("<", "<=", ">", ">=")):
        return None
    branches = [*part.arguments[1:], ir.Number(0.0)][:2]
    left, right, yes, no = (_numbers(case, cell, tree) for tree in (test.left, test.right, *branches))
    if left is None or right is None or yes is None or no is None:
        return None
    gap = left - right
    known = np.isfinite(gap) & np.isfinite(yes) & np.isfinite(no)
    if not ((gap[known] > 0).any() and (gap[known] < 0).any()):
        return None
    drawn = known & (np.arange(case.n) >= case.special)
    nearest = np.argsort(np.where(drawn if drawn.any() else known, np.abs(gap), np.inf))[:_NEAREST]
    share = float(np.median(np.abs(yes - no)[nearest])) / case.scale(cell)
    if share < _TOLD:
        return None
    near = np.zeros(case.n, bool)
    near[nearest] = True
    text = f"{case.trees.text(test, cell)} turns inside the ranges, and the two branches of the IF differ there"
    effect = f"the choice jumps by about {share:.2g} of the central range of the cell"
    place = case.trees.place(test, cell)
    return _finding(case, cell, text, effect, share, () if place is None else case.where(near, place))


def _numbers(case: Case, cell: Cell, tree: ir.Expression) -> Floats | None:
    place = case.trees.place(tree, cell)
    if place is None:
        return None
    node = case.dag.nodes[place]
    if place in case.values:
        return case.number(place)
    return numbers(node.value, case.n) if isinstance(node, Constant) else None


def _finding(
    case: Case,
    cell: Cell,
    what: str,
    effect: str,
    size: float,
    where: tuple[Where, ...] = (),
) -> Finding:
    return Finding(
        Level.NOTE,
        "jump",
        cell,
        case.trees.title(cell),
        case.trees.written(cell),
        what,
        effect,
        where,
        None,
        size,
    )
