"""Where a part of a formula that depends on one assumption is 0, in its range or near it."""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.evaluation.graph.nodes import Input
from xlmc.evaluation.passes.random_rounding import closure, evaluation, formula_of, numbers
from xlmc.studies.stability.case import Case

__all__ = ["only_assumption", "zeros"]

_GRID: Final = 4001
_BISECTIONS: Final = 80


def only_assumption(case: Case, place: int) -> str | None:
    """The key of the only assumption that a node depends on; None where there are none or several."""
    found = {
        node.name
        for part in closure(case.dag, [place])
        if isinstance(node := formula_of(case.dag, part), Input) and node.name in case.draws
    }
    return found.pop() if len(found) == 1 else None


def zeros(case: Case, place: int, key: str) -> list[float]:
    """Where a node is 0 as its only assumption goes through its range, and as far again to either side.

    Rounded to 12 digits where that is as near, so that 270° is 270.
    """
    places = closure(case.dag, [place])

    def at(x: np.ndarray[tuple[int], np.dtype[np.float64]]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        return np.array(numbers(evaluation(case.dag, places, {key: x})[place], x.size))

    low, high = float(case.draws[key].min()), float(case.draws[key].max())
    width = (high - low) or max(abs(low), 1.0) / 100
    grid = np.linspace(low - width, high + width, _GRID)
    values = at(grid)
    with np.errstate(invalid="ignore"):
        turns = np.flatnonzero((np.sign(values[:-1]) * np.sign(values[1:]) < 0) | (values[:-1] == 0))
    found = []
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
            found.append(round_)
    return found
