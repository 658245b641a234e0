"""Which part of a formula loses the digits, found by trying: the one whose exact value, put in its place, heals all."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from xlmc.address import Cell
from xlmc.evaluation.passes.random_rounding import closure, follow, numbers
from xlmc.formula import ir
from xlmc.functions.values import Value
from xlmc.studies.stability.case import Case, Floats

__all__ = ["culprit"]

_HEALED: Final = 0.1
_SURELY_HEALED: Final = 1e-3
"""Of the error, that may be left: the first where that is no more than a sound formula has."""

_SOUND: Final = 10.0
"""Times what rounding the assumptions alone would bring."""

_MOST_PARTS: Final = 300


def culprit(case: Case, cell: Cell, trials: Sequence[int]) -> ir.Expression | None:
    """The innermost part of a cell's formula that is to blame for its error; None where there is none.

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
    node, place = case.node[cell], case.trees.place(part, cell)
    if place is None or place not in case.values or isinstance(part, ir.Number):
        return False
    wanted, cured = _exact(case, node, trials), _exact(case, place, trials)
    before = np.abs(case.number(node)[list(trials)] - wanted)
    after = np.abs(_with(case, node, place, cured, trials) - wanted)
    known = np.isfinite(before) & (before > 0)
    if not known.any() or not np.isfinite(after[known]).all():
        return False
    inherent = np.nan_to_num(case.inherent(cell)[list(trials)])[known]
    left = float(np.median(after[known] / before[known]))
    return left <= _SURELY_HEALED or (left <= _HEALED and bool(np.median(after[known] - _SOUND * inherent) <= 0))


def _exact(case: Case, place: int, trials: Sequence[int]) -> Floats:
    return np.array([case.exact_number(place, trial) for trial in trials])


def _with(case: Case, node: int, place: int, cured: Floats, trials: Sequence[int]) -> Floats:
    """A cell's numbers where a part of it has its exact value, `(m,)` of m trials."""
    rows = np.asarray(trials, np.intp)
    after = set(case.after(place))
    order = [one for one in closure(case.dag, [node]) if one in after]
    held = {one: case.values[one].take(rows) for one in closure(case.dag, [node])}
    return np.array(numbers(follow(case.dag, order, held, {place: Value.of_numbers(cured)})[node], rows.size))
