"""Statistics of one column of trials, and what each trial pulls them by: their errors, and those of differences."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.statistics.proportions import least_error

__all__ = [
    "Bools",
    "Floats",
    "Number",
    "deviation",
    "mean",
    "quantile",
    "share_of_hits",
    "share_of_yes",
    "variance",
    "variation",
]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Number = Callable[[Floats], tuple[float, Floats, float]]
"""Takes a column without trials that have no number, `(m,)`; gives a number, what each trial pulls it by, `(m,)`, and
the least error that it has."""


def mean(x: Floats) -> tuple[float, Floats, float]:
    """Return the mean; a trial pulls it by (x − mean)/m."""
    centre = float(x.mean())
    return centre, (x - centre) / x.size, 0.0


def deviation(x: Floats) -> tuple[float, Floats, float]:
    """Return the standard deviation s; a trial pulls it by ((x − mean)² − s²)/(2 s m)."""
    squares = (x - x.mean()) ** 2
    s = math.sqrt(float(squares.sum()) / (x.size - 1))
    return s, (squares - s * s) / (2.0 * s * x.size) if s else np.zeros(x.size), 0.0


def variance(x: Floats) -> tuple[float, Floats, float]:
    """Return the variance s²; a trial pulls it by ((x − mean)² − s²)/m."""
    squares = (x - x.mean()) ** 2
    square = float(squares.sum()) / (x.size - 1)
    return square, (squares - square) / x.size, 0.0


def variation(x: Floats) -> tuple[float, Floats, float]:
    """Return the coefficient of variation s/mean, as results tell it; its pulls are those of s and of the mean."""
    s, pulls_s, _ = deviation(x)
    centre, pulls, _ = mean(x)
    if not centre:
        return math.nan, np.zeros(x.size), 0.0
    return s / centre, pulls_s / centre - s / centre**2 * pulls, 0.0


def quantile(x: Floats, share: float) -> tuple[float, Floats, float]:
    """Return the quantile q at p, as PERCENTILE.INC; a trial pulls it by (p − [x ≤ q])/(m f).

    The density f at q comes from the order statistics that lie a standard error of their rank to both sides. Where
    hardly a trial crosses q the pulls say nothing: its least error is a step from one order statistic to the next.
    """
    last = x.size - 1
    rank = share * last
    aside = math.sqrt(share * (1.0 - share) * x.size)
    ranks = [math.floor(rank), math.ceil(rank), max(0, round(rank - aside)), min(last, round(rank + aside))]
    ordered = np.partition(x, sorted(set(ranks)))
    low, high, left, right = (float(ordered[each]) for each in ranks)
    value = low + (high - low) * (rank - ranks[0])
    step = (right - left) / max(ranks[3] - ranks[2], 1)
    below = x <= value
    return value, (below.mean() - below) * step, step


def share_of_yes(x: Floats) -> tuple[float, Floats, float]:
    """Return the share of yes, which is any number but 0."""
    return share_of_hits(x != 0.0)


def share_of_hits(hits: Bools) -> tuple[float, Floats, float]:
    """Return the share of hits; a trial pulls it by (hit − share)/m."""
    share = float(hits.mean())
    return share, (hits - share) / hits.size, least_error(hits.size)
