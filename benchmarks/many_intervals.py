"""Mean, SD, percentiles and a share of many runs at once, with the intervals and notices that xlmc gives each of them.

The formulas of `xlmc.montecarlo.statistics` on arrays with one row a run, without weights: some ten times as fast as
its functions run by run. `tail_coverage.py` compares the two in every batch, and does not go on where they differ.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import bdtrik, betaincinv, stdtrit

from xlmc.montecarlo.statistics import pulls
from xlmc.montecarlo.statistics.estimate import LENGTHENED

__all__ = ["Numbers", "deviation_of_share", "mean_and_deviation", "percentile", "share"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

Z = float(stdtrit(np.inf, 0.975))


class Numbers(NamedTuple):
    """(runs,) each: values, ends of their 95 % intervals, whether there is a notice of a tail."""

    value: Floats
    low: Floats
    high: Floats
    told: Bools


class _Shape:
    """What the moments of each run are, (runs,) each; `totals` is (4 or 2, runs, replicates) or None."""

    def __init__(self, x: Floats, kept: Bools, replicates: int) -> None:
        self.n = kept.sum(axis=1).astype(float)
        self.mean = np.where(kept, x, 0.0).sum(axis=1) / self.n
        apart = np.where(kept, x - self.mean[:, None], 0.0)
        self.scale = np.sqrt((apart * apart).sum(axis=1) / self.n)
        z = apart / self.scale[:, None]
        square = z * z
        self.farthest = square.max(axis=1) / self.n
        cube = square * z
        self.skewness, self.kurtosis = cube.sum(axis=1) / self.n, (square * square).sum(axis=1) / self.n
        self.fifth, self.sixth = (cube * square).sum(axis=1) / self.n, (cube * cube).sum(axis=1) / self.n
        self.totals: Floats | None = None
        self.steps: tuple[Floats, Floats] = self.n, self.n
        if replicates:
            ordered = np.sort(np.where(kept, z, np.nan), axis=1)
            self.steps = _step(ordered), _step(ordered * ordered)
            runs = len(x), replicates, -1
            second = np.where(kept, square - 1.0, 0.0)
            self.totals = np.stack([each.reshape(runs).sum(axis=2) / self.n[:, None] for each in (z, second)])


def _step(ordered: Floats) -> Floats:
    """(runs,) the largest step between neighbours; what is not kept is no number, and comes last."""
    return np.asarray(np.nanmax(np.abs(np.diff(ordered, axis=1)), axis=1))


def mean_and_deviation(x: Floats, kept: Bools, replicates: int) -> tuple[Numbers, Numbers, Floats]:
    """Of (runs, trials) values those that are kept; and the farthest trial's part in the sum of squares."""
    m = _Shape(x, kept, replicates)
    if m.totals is None:
        errors = [_trial_error(m, (1.0, 0.0)), _trial_error(m, (0.0, 1.0))]
        deviation, units = m.scale * np.sqrt(m.n / (m.n - 1.0)), m.n
    else:
        units = _groups(_each(kept, replicates))
        errors = list(np.sqrt((m.totals**2).sum(axis=2) * units / (units - 1.0)))
        deviation = m.scale * np.sqrt(1.0 + errors[0] ** 2)
    of_variance = np.sqrt(errors[1] ** 2 + errors[0] ** 4 * 2.0 * (units - 1.0) / units)
    mean = _interval(m, m.mean, m.scale, (1.0, 0.0), errors[0], units)
    log = _interval(m, np.zeros(len(x)), np.full(len(x), 0.5), (0.0, 1.0), of_variance, units)
    spread = Numbers(deviation, deviation * np.exp(log.low), deviation * np.exp(log.high), log.told)
    return mean, spread, m.farthest


def _variance(m: _Shape, pull: pulls.Pull) -> Floats:
    a, b = pull
    return a * a + 2.0 * a * b * m.skewness + b * b * (m.kurtosis - 1.0)


def _trial_error(m: _Shape, pull: pulls.Pull) -> Floats:
    return np.asarray(np.sqrt(_variance(m, pull).clip(0.0) / (m.n - 1.0)))


def _trial_skewness(m: _Shape, pull: pulls.Pull) -> Floats:
    third = m.skewness if pull[0] else m.sixth - 3.0 * m.kurtosis + 2.0
    return np.asarray((third / _variance(m, pull) ** 1.5 / np.sqrt(m.n)).clip(-1.0, 1.0))


def _interval(m: _Shape, value: Floats, size: Floats, pull: pulls.Pull, error: Floats, units: Floats) -> Numbers:
    of_trials = _trial_skewness(m, pull)
    messages = (m.kurtosis > pulls.PEAKED_BESIDE_ROOT * np.sqrt(m.n)) & (
        np.abs(of_trials) * np.sqrt(m.n) > [pulls.reach(float(n)) for n in m.n]
    )
    if m.totals is None:
        low, high = _t_range(units - 1.0, of_trials)
        return Numbers(value, value - size * high * error, value - size * low * error, messages)
    each = pull[0] * m.totals[0] + pull[1] * m.totals[1]
    low, high = _t_range(units - 1.0, (each**3).sum(axis=1) / (each**2).sum(axis=1) ** 1.5)
    hidden = units * (1.0 - 0.025 ** (1.0 / units)) * m.steps[0 if pull[0] else 1] / m.n * size
    ends = (
        np.minimum(value - size * high * error, value - hidden),
        np.maximum(value - size * low * error, value + hidden),
    )
    low, high = _t_range(m.n - 1.0, of_trials)
    plain = size * _trial_error(m, pull)
    few = np.abs(of_trials) > np.minimum(pulls.SKEWED_BESIDE_ROOT, pulls.SKEWED / np.sqrt(m.n))
    least = np.where(few, np.minimum(ends[0], value - high * plain), ends[0])
    most = np.where(few, np.maximum(ends[1], value - low * plain), ends[1])
    return Numbers(value, least, most, messages | few)


def _t_range(dof: Floats, skewness: Floats) -> tuple[Floats, Floats]:
    t = stdtrit(dof, 0.975)
    longer, r = t * (1.0 + LENGTHENED * np.abs(skewness)), np.where(np.abs(skewness) < 1e-9, 1e-9, skewness) / 6.0

    def uncorrected(y: Floats) -> Floats:
        inner = 6.0 * r * (y - r)
        near = np.expm1(np.log1p(np.where(np.abs(inner) < 1e-3, inner, 0.0)) / 3.0)
        return np.asarray(np.where(np.abs(inner) < 1e-3, near, np.cbrt(1.0 + inner) - 1.0) / (2.0 * r))

    return np.minimum(-longer, uncorrected(-longer)), np.maximum(longer, uncorrected(longer))


def share(hits: Bools, kept: Bools, replicates: int) -> Numbers:
    """The share of (runs, trials) hits among those that are kept."""
    n, nothing = kept.sum(axis=1).astype(float), np.zeros(len(hits), bool)
    p = ((hits & kept).sum(axis=1) / n).clip(0.0, 1.0)
    if not replicates:
        return Numbers(p, *_wilson(p, n), nothing)
    result, totals = _each(hits & kept, replicates), _each(kept, replicates)
    widening = stdtrit(_groups(totals) - 1.0, 0.975) / Z
    inside = (p > 0.0) & (p < 1.0)
    error = _error_of_share(result, totals, n)
    equal = np.where(inside, p * (1.0 - p) / (error * widening) ** 2, n)
    low, high = _wilson(p, equal)
    k, size = result.min(axis=1), np.maximum(totals[:, 0], 1)
    even = inside & (totals == totals[:, :1]).all(axis=1) & (result.max(axis=1) <= k + 1)
    more = np.where(even[:, None], result - k[:, None], 0).mean(axis=1)
    least, most = _wilson(more, np.full(len(p), float(replicates)))
    least = np.where(result.max(axis=1) == k, -most, least)
    low = np.where(even, np.minimum(low, ((k + least) / size).clip(0.0)), low)
    high = np.where(even, np.maximum(high, ((k + most) / size).clip(max=1.0)), high)
    return Numbers(p, low, high, nothing)


def deviation_of_share(mean: Numbers, value: Floats) -> Numbers:
    """The standard deviation, of the given value, of zeros and ones whose mean is known."""
    ends = np.sort([np.sqrt(p * (1.0 - p)) for p in (mean.low, mean.high)], axis=0)
    most = np.where((mean.low < 0.5) & (mean.high > 0.5), 0.5, ends[1])
    return Numbers(value, np.minimum(ends[0], value), np.maximum(most, value), mean.told)


def _each(trials: Bools, replicates: int) -> NDArray[np.int64]:
    """(runs, replicates) how many of the trials of each."""
    return trials.reshape(len(trials), replicates, -1).sum(axis=2)


def _groups(kept: NDArray[np.int64]) -> Floats:
    """(runs,) how many replicates kept any trial: others cannot be seen."""
    return np.asarray((kept > 0).sum(axis=1).astype(float))


def _error_of_share(result: NDArray[np.int64] | Floats, totals: NDArray[np.int64], n: Floats) -> Floats:
    apart = (result - (result.sum(axis=1) / n)[:, None] * totals) / n[:, None]
    groups = _groups(totals)
    error = np.sqrt((apart**2).sum(axis=1) * groups / (groups - 1.0))
    return np.maximum(error, Z / (2.0 * (n + Z * Z)))


def _wilson(p: Floats, n: Floats) -> tuple[Floats, Floats]:
    pull = Z * Z / n
    centre = (p + pull / 2.0) / (1.0 + pull)
    half = np.sqrt(pull * (p * (1.0 - p) + pull / 4.0)) / (1.0 + pull)
    hits, misses = p * n, (1.0 - p) * n
    low, high = (
        np.minimum(centre - half, _lowered(hits, misses)),
        np.maximum(centre + half, 1.0 - _lowered(misses, hits)),
    )
    return np.where(p == 0.0, 0.0, low), np.where(p == 1.0, 1.0, high)


def _lowered(hits: Floats, misses: Floats) -> Floats:
    return np.where(hits > 0.0, betaincinv(np.where(hits > 0.0, hits, 1.0), misses + 1.0, 0.05), 1.0)


def percentile(x: Floats, ascending: Floats, kept: Bools, p: float, replicates: int) -> Numbers:
    """The percentile 100 p of (runs, trials) values; `ascending` has those that are kept first, in order."""
    n, nothing = kept.sum(axis=1).astype(float), np.zeros(len(x), bool)
    equal = n
    if replicates:
        result, totals = _below(x, ascending, kept, p, replicates), _each(kept, replicates)
        error = _error_of_share(result, totals, n)
        widening = stdtrit(_groups(totals) - 1.0, 0.975) / Z
        equal = p * (1.0 - p) / error**2 / widening**2
    last = np.maximum(equal - 1.0, 1.0)
    low, high = ((bdtrik(tail, equal, p) / last).clip(0.0, 1.0) for tail in (0.025, 0.975))
    low, high = _quantile(ascending, n, low), _quantile(ascending, n, high)
    low, high = np.where((1.0 - p) ** equal > 0.025, -np.inf, low), np.where(p**equal > 0.025, np.inf, high)
    return Numbers(_quantile(ascending, n, np.full(len(x), p)), low, high, nothing)


def _below(x: Floats, ascending: Floats, kept: Bools, p: float, replicates: int) -> Floats:
    """(runs, replicates) how many trials of each stand at p or below; those that tie there, by one share in all."""
    count = np.array([_standing(int(n), p) for n in kept.sum(axis=1)])
    end = np.take_along_axis(ascending, count[:, None] - 1, axis=1)
    below, ties = kept & (x < end), kept & (x == end)
    shares = (count - below.sum(axis=1)) / ties.sum(axis=1)
    return np.asarray(_each(below, replicates) + shares[:, None] * _each(ties, replicates))


@cache
def _standing(n: int, p: float) -> int:
    """How many of n trials stand at p or below."""
    return int(np.searchsorted(np.linspace(0.0, 1.0, n), p, side="right"))


def _quantile(ascending: Floats, n: Floats, p: Floats) -> Floats:
    rank = p * (n - 1.0)
    low = np.floor(rank).astype(int)
    ends = [
        np.take_along_axis(ascending, each[:, None], axis=1)[:, 0]
        for each in (low, np.minimum(low + 1, n.astype(int) - 1))
    ]
    return np.asarray(ends[0] + (ends[1] - ends[0]) * (rank - low))
