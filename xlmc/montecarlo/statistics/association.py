"""Spearman's rank correlation of two columns, with its error."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.montecarlo.statistics.estimate import Estimate, with_error

__all__ = ["centred_ranks", "rank_correlation"]

Floats = NDArray[np.float64]

LEAST_TRIALS = 10
"""With fewer trials, a replicate says nothing about its correlation."""


def rank_correlation(
    x: ArrayLike, y: ArrayLike, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """Spearman's correlation of (n,) x and y, ties sharing their mean rank; nan where one of them does not vary.

    With independent trials, Fisher's z has the error √((1 + r²/2)/(n − 3)) (Bonett & Wright 2000), and its interval is
    converted back. With R replicates, the error is their standard deviation over √R; there is none if some have fewer
    than 10 trials.

    Raises:
        ValueError: the lengths differ.

    >>> rank_correlation([1.0, 2.0, 3.0, 4.0], [1.0, 4.0, 9.0, 8.0]).value
    0.8
    """
    first, second = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    if first.shape != second.shape or first.ndim != 1:
        raise ValueError(f"two columns of one length, not of shapes {first.shape} and {second.shape}")
    value, n = _spearman(first, second), first.size
    if replicate is None:
        return _estimate_from_trials(value, n, confidence)
    names, ids = np.unique(np.asarray(replicate), return_inverse=True)
    if names.size < 2 or np.bincount(ids).min() < LEAST_TRIALS:
        return Estimate(value, n=n)
    parts = np.split(np.argsort(ids, kind="stable"), np.cumsum(np.bincount(ids))[:-1])
    each = np.array([_spearman(first[part], second[part]) for part in parts])
    return with_error(value, float(np.std(each, ddof=1)) / math.sqrt(names.size), names.size - 1.0, confidence, n)


def _estimate_from_trials(value: float, n: int, confidence: float) -> Estimate:
    if n <= 3 or not abs(value) < 1.0:
        return Estimate(value, n=n)
    error = math.sqrt((1.0 + value**2 / 2.0) / (n - 3.0))
    interval = with_error(math.atanh(value), error, math.inf, confidence, n).interval
    assert interval is not None
    return Estimate(value, (1.0 - value**2) * error, (math.tanh(interval[0]), math.tanh(interval[1])), n)


def _spearman(x: Floats, y: Floats) -> float:
    if x.size == 0:
        return math.nan
    first, second = centred_ranks(x), centred_ranks(y)
    scale = math.sqrt(float(np.sum(first**2)) * float(np.sum(second**2)))
    return min(1.0, max(-1.0, float(np.sum(first * second)) / scale)) if scale else math.nan


def centred_ranks(x: Floats) -> Floats:
    """Return the (n,) ranks minus their mean: multiples of a half; equal values share their mean rank."""
    order = np.argsort(x)
    ascending = x[order]
    starts = np.flatnonzero(np.concatenate([[True], ascending[1:] != ascending[:-1]]))
    counts = np.diff(np.append(starts, x.size))
    ranks = np.empty(x.size)
    ranks[order] = np.repeat(starts + (counts - 1) / 2.0, counts)
    return ranks - (x.size - 1) / 2.0
