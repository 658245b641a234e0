"""How well a quantile is known, whatever the distribution: from the ranks of the trials about it.

**Interval, independent trials.** How many of n trials fall below the true quantile is binomial (n, p), whatever the
distribution. Its α/2 and 1 − α/2 quantiles, continued between the integers, are the ranks of the two ends, and ranks
between two trials are interpolated (Hutson 1999, fractional order statistics). Coverage is nominal to about 1/n; where
even the outermost trial does not suffice, that end is infinite. With weights the binomial has the n at which its error
equals that of the weighted share below the quantile (Woodruff 1952, Korn & Graubard 1998).

**Error.** The half width of the 95 % interval over 1.96.

**Replicates.** The binomial has the n at which its error equals that of the share of trials below the quantile, which
is taken from the differences between replicates. For the interval n is multiplied by (z/t)², which
widens it by Student's t with R − 1 degrees of freedom, as for shares.

(Two others were tried. Leaving out one replicate at a time and taking the quantile anew covers 75 to 93 %, because too
few trials about the quantile decide it. A symmetric interval of t errors covers 93.6 % with 12 accepted trials in each
of 16 replicates, where this covers 95 %.)
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from xlmc.statistics.estimate import LEAST_DOF, Estimate, one_tail, t_quantile
from xlmc.statistics.proportions import error_of_share
from xlmc.statistics.sample import Sample, positions_of

__all__ = ["by_rank", "by_replicate"]

Floats = NDArray[np.float64]

LEAST_SHARE = 1e-12
"""No sample has a trial beyond such a percentile, and the binomial distribution is not computed further out."""


def by_rank(sample: Sample, p: Floats, confidence: float) -> list[Estimate]:
    """Quantiles at 0 < p < 1 of independent trials, with intervals from order statistics."""
    n = _binomial_trials(sample, p)
    return _estimates(sample, p, n, n, confidence)


def by_replicate(sample: Sample, p: Floats, confidence: float) -> list[Estimate]:
    """Quantiles at 0 < p < 1 of replicates; no error where a single one stands behind them."""
    if sample.dof < LEAST_DOF:
        return [Estimate(float(point), n=sample.n) for point in sample.quantile(p)]
    n = p * (1.0 - p) / _errors_below(sample, p) ** 2
    widening = t_quantile(sample.dof, confidence) / t_quantile(np.inf, confidence)
    return _estimates(sample, p, n, n / widening**2, confidence)


def _estimates(sample: Sample, p: Floats, n: Floats, n_of_interval: Floats, confidence: float) -> list[Estimate]:
    """Errors and intervals of binomial counts of so many equal trials, (len(p),) each."""
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
    """(len(p), 2) ends; infinite where the binomial count asks for a trial beyond the outermost."""
    from scipy.special import bdtrik

    p = p.clip(LEAST_SHARE, 1.0 - LEAST_SHARE)
    tail = one_tail(confidence)
    low, high = bdtrik(tail, n, p), bdtrik(1.0 - tail, n, p)  # ranks counted from 0
    open_below, open_above = (1.0 - p) ** n > tail, p**n > tail
    last = np.maximum(n - 1.0, 1.0)
    ends = np.stack([low / last, high / last], axis=1).clip(0.0, 1.0)
    ends = sample.quantile(ends.ravel()).reshape(ends.shape)
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


def _errors_below(sample: Sample, p: Floats) -> Floats:
    """(len(p),) the error of the share of trials below the quantile, from how it varies between replicates."""
    w = np.ones(sample.n) if sample.w is None else sample.w
    totals = sample.per_unit(w)
    below = [sample.per_unit(np.where(sample.positions <= each, w, 0.0)) for each in p]
    return np.array([error_of_share(hits, totals, sample.effective, sample.dof) for hits in below])
