"""Formulas that jump within the ranges: the two branches of an IF differ where its condition changes."""

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
from xlmc.studies.stability.digit_findings import Finding, Level, Where
from xlmc.studies.stability.quadrant import arctangents, guards

__all__ = ["jumps"]

_NEAREST: Final = 20
"""Trials nearest to where the condition changes."""

_TOLD: Final = 0.01
"""Of the cell's central range."""


def jumps(case: Case) -> Iterator[Finding]:
    """The choices and lookups that differ between trials, and by how much the cell jumps there."""
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
            yield _finding(case, kink.cell, text, "the result steps from one cell to the next", kink.share)


def _mending(case: Case) -> set[int]:
    """The choices that put the quadrant of an arctangent right: they jump so that the angle does not."""
    found: set[int] = set()
    for cell in case.cells:
        for one in arctangents(case, cell):
            if (case.number(one.divisor) < 0).any():
                for node in guards(case, one.node, one.divisor).holding:
                    found |= {node, *uses(formula_of(case.dag, node))}
    return found


def _is_among(case: Case, cell: Cell, part: ir.Call, mending: set[int]) -> bool:
    node = case.trees.node_of(part, cell)
    return node is not None and node in mending


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
    text = f"{case.trees.text(test, cell)} changes within the ranges, and the two branches of the IF differ there"
    effect = f"the choice jumps by about {share:.2g} of the central range of the cell"
    node = case.trees.node_of(test, cell)
    return _finding(case, cell, text, effect, share, () if node is None else case.where(near, node))


def _numbers(case: Case, cell: Cell, tree: ir.Expression) -> Floats | None:
    node = case.trees.node_of(tree, cell)
    if node is None:
        return None
    formula = case.dag.nodes[node]
    if node in case.values:
        return case.number(node)
    return numbers(formula.value, case.n) if isinstance(formula, Constant) else None


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
        case.trees.written_formula(cell),
        what,
        effect,
        where,
        None,
        size,
    )
