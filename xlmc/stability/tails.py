"""Distributions so heavy in their tails that a mean or a standard deviation never converges.

The tail is measured by Hill's estimator of its index α: P(|x - median| > t) falls as t^-α. The mean exists above 1, the
standard deviation above 2. A quotient whose divisor goes through 0 has α = 1.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from xlmc.address import Cell
from xlmc.formula import ir
from xlmc.stability.case import Case, Floats
from xlmc.stability.findings import Finding, Level
from xlmc.stability.rewriting import without_quotient

__all__ = ["heavy_tails", "tail_index"]

_SHARE: Final = 0.02
_FEWEST: Final = 40
"""Of the numbers, and how many at least, that count as the tail: α is known to a sixth of itself, or better."""


_FAR: Final = 0.25
"""Of the tail: there it must be as heavy, or it is but a few trials that lie apart from the rest."""


def tail_index(x: Floats, part: float = 1.0) -> tuple[float, float]:
    """Hill's index of the heavier tail, and its standard error; infinite where there are too few numbers.

    Args:
        x: the numbers.
        part: of the tail, from the far end.
    """
    known = x[np.isfinite(x)]
    k = int(max(_FEWEST, _SHARE * known.size))
    if known.size < 10 * k:
        return np.inf, 0.0
    middle = np.median(known)
    best = np.inf
    for side in (known - middle, middle - known):
        largest = np.sort(side)[-int(part * k) - 1 :]
        if largest[0] > 0:
            best = min(best, 1.0 / max(float(np.mean(np.log(largest[1:] / largest[0]))), 1e-300))
    return best, best / np.sqrt(k)


def heavy_tails(case: Case) -> Iterator[Finding]:
    """Forecasts among accepted trials; and cells that filters look at, among all of them."""
    for forecast in case.model.forecasts:
        x = np.asarray(case.run[forecast.name].values)
        index, error = tail_index(x)
        if index + 2 * error < _LIMIT and tail_index(x, _FAR)[0] < _LIMIT:
            effect = f"{_statistic(index + 2 * error)}: more trials do not bring it nearer; report percentiles"
            yield _finding(case, Level.DOUBTFUL, forecast.cell, forecast.name, index, effect, None)
    for filter_ in case.model.filters:
        x = case.number(case.node[filter_.cell])[case.special : case.first_accepted]
        index, error = tail_index(x)
        if index + 2 * error < _LIMIT and tail_index(x, _FAR)[0] < _LIMIT:
            host = _quotient_of(case, filter_.cell)
            better = without_quotient(case, filter_, host) if host is not None else None
            effect = "a filter only compares it, so that the forecasts are not harmed; its mean and SD mean nothing"
            yield _finding(case, Level.NOTE, filter_.cell, filter_.name, index, effect, better)


_LIMIT: Final = 2.0


def _statistic(most: float) -> str:
    return "neither its mean nor its SD converges" if most < 1 else "its SD does not converge"


def _quotient_of(case: Case, cell: Cell) -> ir.Expression | None:
    """The formula behind a cell that may only refer to it."""
    tree: ir.Expression | None = case.lowering.graph.formulas.get(cell)
    while isinstance(tree, Cell):
        tree = case.lowering.graph.formulas.get(tree)
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
        None if better is None else f"={case.trees.text(better, cell)}",
        1 / index,
    )
