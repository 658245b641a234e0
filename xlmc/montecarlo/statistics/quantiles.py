"""Percentiles, median, central range and extremes.

**Value.** Linear interpolation as Excel's PERCENTILE.INC. With weights, a trial stands at the probability p where the
weight below it is to the weight above it as p to 1 − p; equal weights give PERCENTILE.INC again, and whole-number
weights agree at every trial with a sample in which each trial is repeated that often.

**Interval, independent trials.** The number of n trials below the true quantile is binomial (n, p), whatever the
distribution. Its α/2 and 1 − α/2 quantiles, continued between the integers, are the ranks of the two ends, and ranks
between two trials are interpolated (Hutson 1999, fractional order statistics). Coverage is nominal to about 1/n; if
even the outermost trial is not far enough, that end is infinite. With weights the binomial has the n at which its error
equals that of the weighted share below the quantile (Woodruff 1952, Korn & Graubard 1998).

**Error.** The half width of the 95 % interval over 1.96.

**Replicates.** The binomial has the n at which its error equals that of the share of trials below the quantile, which
is taken from the differences between replicates; trials that are equal to the quantile are below it by one share in
all replicates, since they are in no order. For the interval n is multiplied by (z/t)², which widens it by
Student's t with R − 1 degrees of freedom, as for shares.

(Two other ways were tried. To leave out one replicate at a time and compute the quantile again covers 75 to 93 %,
because too few trials about the quantile decide it. A symmetric interval of t errors covers 93.6 % with 12 accepted
trials in each of 16 replicates, where this one covers 95 %.)

**Extremes.** Minimum, maximum and range width are facts about the trials and have no error: without assuming a
distribution, no sample can bound what lies beyond the largest of n trials.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.montecarlo.statistics.estimate import LEAST_DOF, Estimate, one_tail, t_quantile
from xlmc.montecarlo.statistics.proportions import error_of_share
from xlmc.montecarlo.statistics.sample import Sample, Values, positions_of

__all__ = [
    "central_interval",
    "maximum",
    "median",
    "minimum",
    "percentile",
    "percentiles",
    "range_width",
]

Floats = NDArray[np.float64]

_LEAST_SHARE = 1e-12
"""No sample has a trial beyond such a percentile, and the binomial distribution is not computed further out."""


def percentiles(
    values: Values,
    percents: Sequence[float],
    weights: ArrayLike | None = None,
    replicate: ArrayLike | None = None,
    *,
    confidence: float = 0.95,
) -> dict[float, Estimate]:
    """Percent -> percentile of (n,) values; 0 and 100 are the extremes and have no error.

    Raises:
        ValueError: a percent is not between 0 and 100, or a value is not finite.

    >>> percentiles([10.0, 20.0, 40.0], [0, 50, 75])[75].value
    30.0
    """
    sample = Sample.of(values, weights, replicate)
    p = np.asarray(percents, dtype=np.float64) / 100.0
    if not np.all((p >= 0.0) & (p <= 1.0)):
        raise ValueError(f"percentiles lie between 0 and 100: {list(percents)}")
    return dict(zip((float(each) for each in percents), _estimates(sample, p, confidence), strict=True))


def percentile(
    values: Values,
    percent: float,
    weights: ArrayLike | None = None,
    replicate: ArrayLike | None = None,
    *,
    confidence: float = 0.95,
) -> Estimate:
    """One percentile, `percent` between 0 and 100."""
    return percentiles(values, [percent], weights, replicate, confidence=confidence)[float(percent)]


def median(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """Return the 50th percentile."""
    return percentile(values, 50.0, weights, replicate, confidence=confidence)


def central_interval(
    values: Values,
    share: float = 0.51,
    weights: ArrayLike | None = None,
    replicate: ArrayLike | None = None,
    *,
    confidence: float = 0.95,
) -> tuple[Estimate, Estimate]:
    """Return the range that leaves (1 − share)/2 on either side: 24.5 to 75.5 % for 51 %. It is not the shortest range.

    Raises:
        ValueError: the share is not between 0 and 1.
    """
    if not 0.0 <= share <= 1.0:
        raise ValueError(f"a share lies between 0 and 1, not at {share}")
    tail = (1.0 - share) / 2.0
    sample = Sample.of(values, weights, replicate)
    lower, upper = _estimates(sample, np.array([tail, 1.0 - tail]), confidence)
    return lower, upper


def minimum(values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None) -> Estimate:
    """Return the smallest of (n,) values that carries weight."""
    sample = Sample.of(values, weights, replicate)
    return Estimate(float(sample.x[0]) if sample.n else np.nan, n=sample.n)


def maximum(values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None) -> Estimate:
    """Return the largest of (n,) values that carries weight."""
    sample = Sample.of(values, weights, replicate)
    return Estimate(float(sample.x[-1]) if sample.n else np.nan, n=sample.n)


def range_width(values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None) -> Estimate:
    """Largest less smallest; nan where that is too large for a number."""
    sample = Sample.of(values, weights, replicate)
    width = maximum(sample).value - minimum(sample).value
    return Estimate(np.nan if math.isinf(width) else width, n=sample.n)


def _estimates(sample: Sample, p: Floats, confidence: float) -> list[Estimate]:
    if sample.n == 0:
        return [Estimate(np.nan) for _ in p]
    estimate = _from_trials if sample.group is None else _from_replicates
    inner = iter(estimate(sample, p[(p > 0.0) & (p < 1.0)], confidence))
    ends = {0.0: Estimate(float(sample.x[0]), n=sample.n), 1.0: Estimate(float(sample.x[-1]), n=sample.n)}
    return [ends[each] if each in ends else next(inner) for each in p.tolist()]


def _from_trials(sample: Sample, p: Floats, confidence: float) -> list[Estimate]:
    """Estimate quantiles at 0 < p < 1 of independent trials, with intervals from order statistics."""
    n = _binomial_trials(sample, p)
    return _estimates_by_rank(sample, p, n, n, confidence)


def _from_replicates(sample: Sample, p: Floats, confidence: float) -> list[Estimate]:
    """Estimate quantiles at 0 < p < 1 of replicates; no error if there is only one."""
    if sample.dof < LEAST_DOF:
        return [Estimate(float(point), n=sample.n) for point in sample.quantile(p)]
    n = p * (1.0 - p) / _errors_below(sample, p) ** 2
    widening = t_quantile(sample.dof, confidence) / t_quantile(np.inf, confidence)
    return _estimates_by_rank(sample, p, n, n / widening**2, confidence)


def _estimates_by_rank(
    sample: Sample, p: Floats, n: Floats, n_of_interval: Floats, confidence: float
) -> list[Estimate]:
    """Estimate quantiles with the errors and intervals of binomial counts of n equal trials, (len(p),) each."""
    intervals = _rank_intervals(sample, p, n_of_interval, confidence)
    halves = np.diff(_rank_intervals(sample, p, n, 0.95) / 2.0).ravel() / t_quantile(np.inf, 0.95)
    return [
        Estimate(
            float(point),
            float(half) if np.isfinite(half) else None,
            (float(low), float(high)) if np.isfinite([low, high]).any() else None,
            sample.n,
        )
        for point, half, (low, high) in zip(sample.quantile(p), halves, intervals, strict=True)
    ]


def _rank_intervals(sample: Sample, p: Floats, n: Floats, confidence: float) -> Floats:
    """Return (len(p), 2) ends; infinite where the binomial count asks for a trial beyond the outermost."""
    p = p.clip(_LEAST_SHARE, 1.0 - _LEAST_SHARE)
    tail = one_tail(confidence)
    low, high = _ranks(tuple(p.tolist()), tuple(n.tolist()), tail)
    open_below, open_above = (1.0 - p) ** n > tail, p**n > tail
    last = np.maximum(n - 1.0, 1.0)
    ends = np.stack([low / last, high / last], axis=1).clip(0.0, 1.0)
    ends = sample.quantile(ends.ravel()).reshape(ends.shape)
    least, most = (0.0, 1.0) if sample.yes_no else (-np.inf, np.inf)
    ends[open_below, 0], ends[open_above, 1] = least, most
    return np.asarray(ends)


@lru_cache(maxsize=256)
def _ranks(p: tuple[float, ...], n: tuple[float, ...], tail: float) -> tuple[Floats, Floats]:
    """Return two (len(p),), counted from 0; forecasts of one run often have the same number of trials."""
    from scipy.special import bdtrik

    return bdtrik(tail, n, p), bdtrik(1.0 - tail, n, p)


def _binomial_trials(sample: Sample, p: Floats) -> Floats:
    """Return (len(p),) the number of equal trials whose share below the quantile would be known as well as here.

    The share's variance is (1 − p)² Σw² below and p² Σw² above; Σw² is split where the quantile splits Σw.
    """
    if sample.w is None or sample.n == 1:
        return np.full(p.shape, float(sample.n))
    below = np.interp(p, sample.positions, positions_of(sample.w**2))
    return np.asarray(sample.effective * p * (1.0 - p) / ((1.0 - p) ** 2 * below + p**2 * (1.0 - below)))


def _errors_below(sample: Sample, p: Floats) -> Floats:
    """Return (len(p),) the error of the share of trials below the quantile, from its spread between replicates."""
    w = np.ones(sample.n) if sample.w is None else sample.w
    totals = sample.per_unit(w)
    below = [sample.per_unit(_below(sample, w, each)) for each in p.tolist()]
    return np.array([error_of_share(hits, totals, sample.effective, sample.dof) for hits in below])


def _below(sample: Sample, w: Floats, p: float) -> Floats:
    """Return (n,) the weight of each trial as far as it is below the quantile at p.

    Trials that are equal to it are in no order: each of them is below it by the share that the curve has passed.
    """
    passed = int(np.searchsorted(sample.positions, p, "right"))
    first, stop = (int(np.searchsorted(sample.x, sample.x[passed - 1], side)) for side in ("left", "right"))
    below = np.zeros(sample.n)
    below[:first] = w[:first]
    below[first:stop] = w[first:stop] * (w[first:passed].sum() / w[first:stop].sum())
    return below
