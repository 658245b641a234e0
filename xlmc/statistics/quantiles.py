"""Percentiles, median and central range, with errors that assume no distribution.

**Value.** Linear interpolation as Excel's PERCENTILE.INC. With weights, a trial stands at the probability p where the
weight below it is to the weight above it as p to 1 − p; equal weights give PERCENTILE.INC again, and whole-number
weights agree at every trial with a sample in which each trial is repeated that often.

**Interval, independent trials.** How many of n trials fall below the true quantile is binomial (n, p), whatever the
distribution. Its α/2 and 1 − α/2 quantiles, continued between the integers, are the ranks of the two ends, and ranks
between two trials are interpolated (Hutson 1999, fractional order statistics). Coverage is nominal to about 1/n; where
even the outermost trial does not suffice, that end is infinite. With weights the binomial has the n at which its error
equals that of the weighted share below the quantile (Woodruff 1952, Korn & Graubard 1998).

**Error.** The half width of the 95 % interval over 1.96.

**Replicates.** The error above, times how much the share of trials below the quantile varies between replicates against
how much it would between independent trials; Student's t with R − 1 degrees of freedom. (A delete-one-replicate jackknife
of the value itself covers 75 to 93 % where this covers 92 to 100 %: a handful of trials about the quantile decides it.)
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.statistics.estimate import Estimate, t_quantile, with_error
from xlmc.statistics.proportions import error_of_share
from xlmc.statistics.sample import Sample, Values, positions_of

__all__ = ["central_interval", "median", "percentile", "percentiles"]

Floats = NDArray[np.float64]

LEAST_SHARE = 1e-12
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
    """The 50th percentile."""
    return percentile(values, 50.0, weights, replicate, confidence=confidence)


def central_interval(
    values: Values,
    share: float = 0.51,
    weights: ArrayLike | None = None,
    replicate: ArrayLike | None = None,
    *,
    confidence: float = 0.95,
) -> tuple[Estimate, Estimate]:
    """The range that leaves (1 − share)/2 on either side: 24.5 to 75.5 % for 51 %. It is not the shortest range.

    Raises:
        ValueError: the share is not between 0 and 1.
    """
    if not 0.0 <= share <= 1.0:
        raise ValueError(f"a share lies between 0 and 1, not at {share}")
    tail = (1.0 - share) / 2.0
    sample = Sample.of(values, weights, replicate)
    lower, upper = _estimates(sample, np.array([tail, 1.0 - tail]), confidence)
    return lower, upper


def _estimates(sample: Sample, p: Floats, confidence: float) -> list[Estimate]:
    if sample.n == 0:
        return [Estimate(np.nan) for _ in p]
    points = _quantile(sample, p)
    inside = (p > 0.0) & (p < 1.0)
    estimates = [Estimate(float(point), n=sample.n) for point in points]
    found = _by_replicate if sample.group is not None else _by_rank
    for place, estimate in zip(
        np.flatnonzero(inside), found(sample, p[inside], points[inside], confidence), strict=True
    ):
        estimates[place] = estimate
    return estimates


def _quantile(sample: Sample, p: Floats) -> Floats:
    """The quantile curve at probabilities p."""
    if sample.w is not None and sample.n > 1:
        return np.interp(p, sample.positions, sample.x)
    rank = p * (sample.n - 1)
    low = np.floor(rank).astype(np.intp)
    left, right = sample.x[low], sample.x[np.minimum(low + 1, sample.n - 1)]
    return np.asarray(left + (right - left) * (rank - low))


def _by_rank(sample: Sample, p: Floats, points: Floats, confidence: float) -> list[Estimate]:
    """Independent trials: intervals from order statistics."""
    intervals = _rank_intervals(sample, p, confidence)
    halves = np.diff(_rank_intervals(sample, p, 0.95)).ravel() / 2.0 / t_quantile(np.inf, 0.95)
    return [
        Estimate(
            float(point),
            float(half) if np.isfinite(half) else None,
            (float(low), float(high)) if np.isfinite([low, high]).any() else None,
            sample.n,
        )
        for point, half, (low, high) in zip(points, halves, intervals, strict=True)
    ]


def _rank_intervals(sample: Sample, p: Floats, confidence: float) -> Floats:
    """(len(p), 2) ends; infinite where the binomial count asks for a trial beyond the outermost."""
    from scipy.special import bdtrik

    n, p = _binomial_trials(sample, p), p.clip(LEAST_SHARE, 1.0 - LEAST_SHARE)
    tail = (1.0 - confidence) / 2.0
    low, high = bdtrik(tail, n, p), bdtrik(1.0 - tail, n, p)  # ranks counted from 0
    open_below, open_above = (1.0 - p) ** n > tail, p**n > tail
    last = np.maximum(n - 1.0, 1.0)
    ends = np.stack([low / last, high / last], axis=1).clip(0.0, 1.0)
    ends = _quantile(sample, ends.ravel()).reshape(ends.shape)
    ends[open_below, 0], ends[open_above, 1] = -np.inf, np.inf
    return np.asarray(ends)


def _binomial_trials(sample: Sample, p: Floats) -> Floats:
    """(len(p),) the number of equal trials whose share below the quantile is known as well as here.

    The share's variance is (1 − p)² Σw² below and p² Σw² above; Σw² is split where the quantile splits Σw.
    """
    if sample.w is None or sample.n == 1:
        return np.full(p.shape, float(sample.n))
    below = np.interp(p, sample.positions, positions_of(sample.w**2))
    return np.asarray(sample.effective * p * (1.0 - p) / ((1.0 - p) ** 2 * below + p**2 * (1.0 - below)))


def _by_replicate(sample: Sample, p: Floats, points: Floats, confidence: float) -> list[Estimate]:
    """Replicates: the error of independent trials, times what stratification saves or clustering costs."""
    errors = [each.error for each in _by_rank(sample, p, points, confidence)]
    factors = _against_independent_trials(sample, p)
    return [
        Estimate(float(point), n=sample.n)
        if error is None
        else with_error(float(point), error * float(factor), sample.dof, confidence, sample.n)
        for point, error, factor in zip(points, errors, factors, strict=True)
    ]


def _against_independent_trials(sample: Sample, p: Floats) -> Floats:
    """(len(p),) the error of the share below the quantile, over that of independent trials (root design effect)."""
    w = np.ones(sample.n) if sample.w is None else sample.w
    totals = sample.per_unit(w)
    below = [sample.per_unit(np.where(sample.positions <= each, w, 0.0)) for each in p]
    errors = np.array([error_of_share(hits, totals, sample.effective) for hits in below])
    return np.asarray(errors / np.sqrt(p * (1.0 - p) / _binomial_trials(sample, p)))
