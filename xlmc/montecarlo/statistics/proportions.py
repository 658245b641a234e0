"""Shares of trials: acceptance, certainty, the probability above a threshold.

**Interval.** It is Wilson's, or Clopper and Pearson's, which is wider and never covers less than asked. Wilson's lower
end is too high for a few hits (where 0.17 are expected, the interval holds the truth in 84 % of the runs): there it is
lowered as in Brown, Cai & DasGupta (2001, 4.1.1), and the upper end is raised for a few misses. With weights or
replicates, the interval is that of as many independent trials as would give the same error, or of fewer, to allow for
Student's t (Korn & Graubard 1998). If replicates differ by one hit at most, it also holds the interval that follows
from the share of replicates with one hit more.

**Error.** It is √(p(1 − p)/n), or comes from the spread between weighted trials or replicates (as that of a ratio,
because replicates may differ in size). It is never less than the error of a share of 0, half of Wilson's interval over
1.96: that no trial was seen does not prove that there are none, so a share is never 0 ± 0.

**Until there are enough successes.** If trials go on until the N-th success, their number n has a negative binomial
distribution. N/n is then too large on average; (N − 1)/(n − 1) is right on average (Haldane 1945), and p(1 − p)/(n − 2)
is so for its variance (Finney 1949). The interval is exact (George & Elston 1993): at its lower end, so few trials or
fewer have the probability of one tail, at its upper end so many or more. That n ≤ k means that k trials have N
successes or more, so the ends are quantiles of beta distributions, like Clopper and Pearson's.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.montecarlo.columns import release
from xlmc.montecarlo.statistics.estimate import LEAST_DOF, Estimate, one_tail, t_quantile
from xlmc.montecarlo.statistics.sample import Sample, Values

__all__ = [
    "Method",
    "complement",
    "inverse_proportion",
    "probability_above",
    "probability_between",
    "proportion",
    "replicated_proportion",
    "share",
]

Floats = NDArray[np.float64]
Method = Literal["wilson", "clopper-pearson"]


def complement(share: Estimate) -> Estimate:
    """Return the share of all other trials: its error is the same, and its interval the other way round."""
    interval = None if share.interval is None else (1.0 - share.interval[1], 1.0 - share.interval[0])
    return replace(share, value=1.0 - share.value, interval=interval)


def proportion(successes: int, trials: int, *, confidence: float = 0.95, method: Method = "wilson") -> Estimate:
    """Estimate the share of successes among independent trials, such as the accepted ones.

    Raises:
        ValueError: successes outside 0 … trials.

    >>> proportion(1, 4).value
    0.25
    >>> proportion(0, 1000).error > 0
    True
    """
    if not 0 <= successes <= trials:
        raise ValueError(f"{successes} successes of {trials} trials")
    if trials == 0:
        return Estimate(np.nan)
    p = successes / trials
    error = max((p * (1.0 - p) / trials) ** 0.5, least_error(trials))
    return Estimate(p, error, _INTERVALS[method](p, float(trials), confidence), trials)


def replicated_proportion(
    successes: ArrayLike, trials: ArrayLike, *, confidence: float = 0.95, method: Method = "wilson"
) -> Estimate:
    """Estimate the share of successes from (R,) counts of R independent replicates; the error is that between them.

    Raises:
        ValueError: successes outside 0 … trials in a replicate, or counts of different length.
    """
    hits, totals = np.asarray(successes, dtype=np.float64), np.asarray(trials, dtype=np.float64)
    if hits.ndim != 1 or hits.shape != totals.shape or not np.all((hits >= 0.0) & (hits <= totals)):
        raise ValueError("successes and trials must be counts per replicate, 0 ≤ successes ≤ trials")
    n = float(totals.sum())
    if n == 0.0:
        return Estimate(np.nan)
    return _pool(hits, totals, n, hits.size - 1.0, int(n), confidence, method)


def inverse_proportion(successes: int, trials: int, *, confidence: float = 0.95) -> Estimate:
    """Estimate the share of successes if trials went on until there were so many; the last trial is one.

    Raises:
        ValueError: fewer than 2 successes, or fewer trials than successes.

    >>> inverse_proportion(3, 9).value
    0.25
    """
    from scipy.special import betaincinv

    if not 2 <= successes <= trials:
        raise ValueError(f"{successes} successes, waited for in {trials} trials")
    tail, misses = one_tail(confidence), trials - successes
    p = (successes - 1) / (trials - 1)
    error = least_error(trials) if misses == 0 else max((p * (1.0 - p) / (trials - 2)) ** 0.5, least_error(trials))
    low = float(betaincinv(successes, misses + 1.0, tail))
    high = 1.0 if misses == 0 else float(betaincinv(successes, misses, 1.0 - tail))
    return Estimate(p, error, (low, high), trials)


def share(
    hits: ArrayLike,
    weights: ArrayLike | None = None,
    replicate: ArrayLike | None = None,
    *,
    confidence: float = 0.95,
    method: Method = "wilson",
) -> Estimate:
    """Estimate the share of (n,) trials that are TRUE."""
    return probability_above(hits, 0.5, weights, replicate, confidence=confidence, method=method)


def probability_above(
    values: Values,
    threshold: float,
    weights: ArrayLike | None = None,
    replicate: ArrayLike | None = None,
    *,
    confidence: float = 0.95,
    method: Method = "wilson",
) -> Estimate:
    """Estimate P(value > threshold) from (n,) values.

    >>> probability_above([1.0, 2.0, 3.0, 4.0], 3.0).value
    0.25
    """
    sample = Sample.of(values, weights, replicate)
    first = int(np.searchsorted(sample.x, threshold, side="right"))
    release(sample.x)
    return _estimate_between(sample, first, sample.n, confidence, method)


def probability_between(
    values: Values,
    low: float,
    high: float,
    weights: ArrayLike | None = None,
    replicate: ArrayLike | None = None,
    *,
    confidence: float = 0.95,
    method: Method = "wilson",
) -> Estimate:
    """Estimate P(low ≤ value ≤ high) from (n,) values, which Crystal Ball calls certainty; an end may be infinite.

    Raises:
        ValueError: the range ends below its beginning.

    >>> probability_between([1.0, 2.0, 3.0, 4.0], 2.0, 3.0).value
    0.5
    """
    if not low <= high:
        raise ValueError(f"a range cannot reach from {low} to {high}")
    sample = Sample.of(values, weights, replicate)
    first, stop = int(np.searchsorted(sample.x, low, "left")), int(np.searchsorted(sample.x, high, "right"))
    release(sample.x)
    return _estimate_between(sample, first, stop, confidence, method)


def _estimate_between(sample: Sample, first: int, stop: int, confidence: float, method: Method) -> Estimate:
    """Estimate the share of the trials from rank `first` to before `stop`, counted from 0; exact where none varies."""
    if sample.still and sample.n:
        all_or_none = float(stop > first)
        return Estimate(all_or_none, 0.0, (all_or_none, all_or_none), sample.n)
    if sample.w is None and sample.group is None:
        return proportion(stop - first, sample.n, confidence=confidence, method=method)
    if sample.n == 0:
        return Estimate(np.nan)
    w = np.ones(sample.n) if sample.w is None else sample.w
    hits = np.zeros(sample.n)
    hits[first:stop] = w[first:stop]
    return _pool(sample.per_unit(hits), sample.per_unit(w), sample.effective, sample.dof, sample.n, confidence, method)


def _pool(
    hits: Floats, totals: Floats, effective: float, dof: float, n: int, confidence: float, method: Method
) -> Estimate:
    """Estimate the ratio of two sums over independent units, (units,) each, worth `effective` equal trials."""
    p = float(hits.sum() / totals.sum())
    if dof < LEAST_DOF:
        return Estimate(p, n=n)
    error = error_of_share(hits, totals, effective, dof)
    if p in (0.0, 1.0):
        return Estimate(p, error, _INTERVALS[method](p, effective, confidence), n)
    widening = t_quantile(dof, confidence) / t_quantile(np.inf, confidence)
    equal_trials = p * (1.0 - p) / (error * widening) ** 2
    low, high = _INTERVALS[method](p, equal_trials, confidence)
    least, most = _one_hit_interval(hits, totals, confidence, method)
    return Estimate(p, error, (min(low, least), max(high, most)), n)


def _one_hit_interval(hits: Floats, totals: Floats, confidence: float, method: Method) -> tuple[float, float]:
    """Return the interval for replicates of one size that differ by one hit at most; (1, 0), an empty one, for others.

    If one input decides, m evenly spread draws have k or k + 1 hits, and no other number. How many replicates have
    k + 1 is a binomial number, with a trial for each replicate; its interval gives that of the share. If all have k,
    others might have one hit more, or one less.
    """
    k = float(hits.min())
    if not (np.all(totals == totals[0]) and np.all((hits == k) | (hits == k + 1.0))):
        return 1.0, 0.0
    low, high = _INTERVALS[method](float(np.mean(hits - k)), float(hits.size), confidence)
    if hits.max() == k:
        low = -high
    return max(0.0, (k + low) / float(totals[0])), min(1.0, (k + high) / float(totals[0]))


def error_of_share(hits: Floats, totals: Floats, effective: float, dof: float) -> float:
    """Return the standard error of Σhits/Σtotals over independent units, together worth `effective` equal trials."""
    apart = (hits - hits.sum() / totals.sum() * totals) / totals.sum()
    return max(math.sqrt(np.sum(apart**2) * (dof + 1.0) / dof), least_error(effective))


def least_error(trials: float) -> float:
    """Return the error of a share of 0: half of Wilson's 95 % interval over 1.96."""
    z = t_quantile(np.inf, 0.95)
    return z / (2.0 * (trials + z * z))


def _wilson(p: float, trials: float, confidence: float) -> tuple[float, float]:
    z = t_quantile(np.inf, confidence)
    pull = z * z / trials
    centre = (p + pull / 2.0) / (1.0 + pull)
    half = (pull * (p * (1.0 - p) + pull / 4.0)) ** 0.5 / (1.0 + pull)
    hits, misses = p * trials, (1.0 - p) * trials
    low = min(centre - half, _lower_for_few(hits, misses, confidence))
    high = max(centre + half, 1.0 - _lower_for_few(misses, hits, confidence))
    # At 0 and 1 one end is the share itself; rounding must not say otherwise.
    return 0.0 if p == 0.0 else low, 1.0 if p == 1.0 else high


def _lower_for_few(hits: float, misses: float, confidence: float) -> float:
    """Return the share with which so many hits or more have the probability of both tails; 1, no bound, for no hits.

    For a few hits it is below Wilson's lower end.
    """
    from scipy.special import betaincinv

    return float(betaincinv(hits, misses + 1.0, 1.0 - confidence)) if hits > 0.0 else 1.0


def _clopper_pearson(p: float, trials: float, confidence: float) -> tuple[float, float]:
    from scipy.special import betaincinv

    tail, hits = one_tail(confidence), p * trials
    misses = trials - hits
    low = 0.0 if p == 0.0 else float(betaincinv(hits, misses + 1.0, tail))
    high = 1.0 if p == 1.0 else float(betaincinv(hits + 1.0, misses, 1.0 - tail))
    return low, high


_INTERVALS: dict[Method, Callable[[float, float, float], tuple[float, float]]] = {
    "wilson": _wilson,
    "clopper-pearson": _clopper_pearson,
}
