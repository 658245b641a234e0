"""Circles that are computed iteratively: whether the answer depends on where the iteration starts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from xlmc.analysis.studies.stability.case import Case, Floats
from xlmc.analysis.studies.stability.digit_findings import Finding, Level
from xlmc.engine.graph.iteration import IteratedCells
from xlmc.engine.graph.nodes import Constant
from xlmc.engine.passes.random_rounding import evaluate_changes, numbers_of
from xlmc.excel.functions.values import NUMBER, Value
from xlmc.montecarlo.number_text import count_text, number_text

__all__ = ["dependence_on_starts"]

_VISIBLE: Final = 1e-3
"""A share of a forecast's central range: a larger change is visible."""

_WRONG: Final = 0.1
"""The share from which on another start gives another answer, rather than another last digit."""


def dependence_on_starts(case: Case) -> Iterator[Finding]:
    """Return the circles from which a forecast comes out differently where they start from other values than the saved
    ones.

    They are started from 0, from 1, and from twice the saved values.
    """
    for circle in case.lowering.iterated:
        moved = {forecast.name: np.zeros(case.n) for forecast in case.model.forecasts}
        for start in _other_starts(case, circle):
            result = evaluate_changes(case.dag, case.nodes, case.values, {circle.start: start})
            for forecast in case.model.forecasts:
                node = case.node[forecast.cell]
                if node in result:
                    by = _difference(case.number(node), numbers_of(result[node], case.n)) / case.scale(forecast.cell)
                    moved[forecast.name] = np.fmax(moved[forecast.name], by)
        name = max(moved, key=lambda name: float(np.max(moved[name])), default="")
        if name and float(np.max(moved[name])) > _VISIBLE:
            yield _finding(case, circle, name, moved[name])


def _other_starts(case: Case, circle: IteratedCells) -> Iterator[Value]:
    saved = case.dag.nodes[circle.start]
    if not isinstance(saved, Constant) or circle.start not in case.values:
        return
    numbers = saved.value.numbers
    for start in (np.zeros_like(numbers), np.ones_like(numbers), 2.0 * numbers):
        yield Value(start, np.full(start.shape, NUMBER, np.uint8))


def _difference(one: Floats, other: Floats) -> Floats:
    """How far apart two numbers are; endlessly where only one of them is a number."""
    with np.errstate(over="ignore", invalid="ignore"):
        apart = np.abs(one - other)
    return np.where(np.isnan(one) & np.isnan(other), 0.0, np.where(np.isnan(apart), np.inf, apart))


def _finding(case: Case, circle: IteratedCells, name: str, moved: Floats) -> Finding:
    visible, size = moved > _VISIBLE, float(np.max(moved))
    cell = circle.cells[0]
    much = f"{number_text(size, 2)} of its central range" if np.isfinite(size) else "from a number to an error, or back"
    return Finding(
        Level.WRONG if size > _WRONG else Level.DOUBTFUL,
        "start",
        cell,
        "",
        case.trees.written_formula(cell),
        f"{circle.name} comes to another end where it starts from other values than those that Excel saved",
        f"{name!r} changes by up to {much}, visibly in {count_text(int(np.count_nonzero(visible)))} of "
        f"{count_text(case.n)} trials",
        case.where(visible, case.node[cell]),
        None,
        size,
    )
