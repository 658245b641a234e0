"""Methods for rare acceptance side by side: trials for a relative error of 1 %, for rare_acceptance.py."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, ndtri

from xlmc.montecarlo.rare.search import SearchResult, find
from xlmc.montecarlo.rare.splitting import descend

__all__ = ["Distance", "Floats", "compared", "one_run"]

Floats = NDArray[np.float64]
Distance = Callable[[Floats], Floats]

MOST = 10**9

BINS = 64
"""Equally likely intervals of each uniform in the grid that proposals are compared with."""


def one_run(distance: Distance, dimensions: int, seed: int, wanted: int) -> SearchResult:
    """Accepted trials, from two streams of a seed."""
    learning, drawing = (np.random.default_rng((seed, purpose)) for purpose in (0, 1))
    return find(distance, lambda z: distance(z) == 0.0, dimensions, wanted, MOST, learning, drawing)


def compared(distance: Distance, dimensions: int, seeds: int = 8) -> dict[str, float]:
    """The methods on one problem: trials for a relative error of 1 % of the probability of acceptance, or of a mean.

    Splitting: from the spread of single populations. The others: from effective sample sizes of one proposal each, a
    grid of independent uniforms (as VEGAS learns it), the mixture, and its trials of equal weight.
    """
    logs, costs, grids, mixtures, equals = [], [], [], [], []
    for seed in range(seeds):
        way = descend(distance, dimensions, np.random.default_rng((seed, 2)))
        if way.reached:
            logs.append(way.log_probability)
            costs.append(way.evaluations)
            grids.append(grid_efficiency(distance, way.points, np.random.default_rng((seed, 3))))
        best = one_run(distance, dimensions, seed, 500).used
        assert best is not None
        weights = np.exp(best.logs - best.envelope)
        mixtures.append(float(weights.sum() ** 2 / np.square(weights).sum() / best.trials))
        equals.append(best.rate)
    return {
        "splitting": float(np.var(logs, ddof=1) * np.mean(costs) * 1e4),
        "grid": 1e4 / float(np.mean(grids)),
        "mixture": 1e4 / float(np.mean(mixtures)),
        "equal": 1e4 / float(np.mean(equals)),
        "learning": float(np.mean(costs)) * 2,
    }


def grid_efficiency(distance: Distance, points: Floats, random: np.random.Generator, count: int = 1 << 17) -> float:
    """The effective sample size of a proposal from independent histograms, one a uniform, learned from points."""
    cells = np.minimum((ndtr(points) * BINS).astype(int), BINS - 1)
    shares = np.array([np.bincount(column, minlength=BINS) for column in cells.T]) / len(points)
    shares = 0.9 * shares + 0.1 / BINS
    chosen = np.array([random.choice(BINS, count, p=share) for share in shares]).T
    u = (chosen + random.random(chosen.shape)) / BINS
    logs = -np.log(np.take_along_axis(shares.T, chosen, axis=0) * BINS).sum(axis=1)
    weights = np.exp(logs) * (distance(ndtri(np.maximum(u, 2.0**-54))) == 0.0)
    total = float(np.square(weights).sum())
    return float(weights.sum() ** 2 / total / count) if total else 1e-9
