"""Distributions so heavy in their tails that a mean or a standard deviation never converges.

The tail is measured by Hill's estimator of its index α: P(|x - median| > t) falls as t^-α. The mean exists above 1, the
standard deviation above 2. A quotient whose divisor goes through 0 has α = 1.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from xlmc.address import Cell
from xlmc.formula import ir
from xlmc.statistics.heavy_tails import heavy_tail
from xlmc.studies.stability.case import Case
from xlmc.studies.stability.findings import Finding, Level
from xlmc.studies.stability.rewriting import without_quotient

__all__ = ["heavy_tails"]


def heavy_tails(case: Case) -> Iterator[Finding]:
    """Forecasts among accepted trials; and cells that filters look at, among all of them."""
    for forecast in case.model.forecasts:
        x = np.asarray(case.run[forecast.name].values)
        if (found := heavy_tail(x)) is not None:
            index, _ = found
            effect = f"{_statistic(*found)} as far as these trials show: more of them do not help; report percentiles"
            yield _finding(case, Level.DOUBTFUL, forecast.cell, forecast.name, index, effect, None)
    for filter_ in case.model.filters:
        x = case.number(case.node[filter_.cell])[case.special : case.first_accepted]
        if (found := heavy_tail(x)) is not None:
            index, _ = found
            host = _quotient_of(case, filter_.cell)
            better = without_quotient(case, filter_, host) if host is not None else None
            effect = "a filter only compares it, so that the forecasts are not harmed; its mean and SD mean nothing"
            yield _finding(case, Level.NOTE, filter_.cell, filter_.name, index, effect, better)


def _statistic(index: float, error: float) -> str:
    if index + 2 * error < 1:
        return "neither its mean nor its SD converges"
    return f"its SD does not converge{', and its mean hardly or not at all' if index - 2 * error <= 1 else ''}"


def _quotient_of(case: Case, cell: Cell) -> ir.Expression | None:
    """The formula behind a cell that may only refer to it."""
    formulas = case.lowering.graph.formulas
    tree: ir.Expression | None = case.trees.formula(cell) if cell in formulas else None
    while isinstance(tree, Cell):
        tree = case.trees.formula(tree) if tree in formulas else None
    return tree


def _finding(
    case: Case, level: Level, cell: Cell, name: str, index: float, effect: str, better: ir.Expression | None
) -> Finding:
    return Finding(
        level,
        "tail",
        cell,
        name,
        case.trees.written(cell),
        f"it has a heavy tail: large values fall off as slowly as t^-{index:.1f}, as those of a quotient whose divisor "
        "goes through 0",
        effect,
        (),
        case.trees.offered(better, cell),
        1 / index,
    )
