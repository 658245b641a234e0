"""How unevenly single trials pull a number, and so how much of its error the far ones decide.

The mean, the variance, the standard deviation and the coefficient of variation are, but for what is negligible, means
of a pull of each trial, a·z + b·(z² − 1) with z the standardised value. The skewness of the pulls over the root of the
number of units is the skewness of the number itself from run to run, to first order. Where it is large, the runs in
which the far trials have not come have too small a number and too small an error at once, and symmetric intervals miss.

**Interval.** Student's t of a skewed sample is brought to that of a symmetric one by Hall's monotone cubic (Hall 1992,
J. R. Statist. Soc. B 54, 221), on either side no shorter than without it, and longer by 0.15 of the skewness, for
a sample shows too little of its skewness.

**Replicates.** Of a forecast that one input decides, each replicate of a Latin hypercube or of Sobol points has one
trial in the outermost interval, and the error comes from these few, however many trials there are: 16 draws from the
tail. Where the pulls of all trials say that this tail is heavy, the 16 do not show it, and the error is that of
independent trials, which even draws keep below.

**Steps.** Of a forecast that takes few values, or that jumps, a replicate of even draws has k trials on one side of a
step or k + 1, and with 16 replicates that agree, one in five may yet differ. So the interval reaches at least as far as
what so many trials would change that cross the largest step between neighbouring values.
"""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from xlmc.statistics.estimate import Estimate, one_tail, t_quantile
from xlmc.statistics.moments import Moments

__all__ = [
    "Pull",
    "Shape",
    "Shaped",
    "beyond_reach",
    "few_decide",
    "replicate_skewness",
    "step_error",
    "trial_error",
    "trial_skewness",
    "wider",
]

Floats = NDArray[np.float64]
Pull = tuple[float, float]
"""The factors of z and of z²."""

SKEWED, SKEWED_BESIDE_ROOT = 7.0, 0.1
"""Skewness of the trials' pulls, and over √n, from which on the replicates do not show the error: 2 for the mean of an
exponential forecast, 2.8 for the SD of a normal one, 6 for the mean of a lognormal one with σ = 1, 11 for the SD of an
exponential one (docs/sampling.md has the coverage)."""

BEYOND, BEYOND_POWER = 0.63, 0.4
"""Above 0.63 n^0.4 not even the interval of a skewed sample holds: n pulls cannot have a skewness above √n."""

PEAKED_BESIDE_ROOT = 0.7
"""Kurtosis over √n, below which no tail is too heavy; a normal forecast has a kurtosis of 3, an exponential one 9."""


class Shaped(Protocol):
    """What has the means of the powers of standardised values."""

    @property
    def skewness(self) -> float: ...
    @property
    def kurtosis(self) -> float: ...
    @property
    def fifth(self) -> float: ...
    @property
    def sixth(self) -> float: ...


class Shape(NamedTuple):
    """The means of z³ to z⁶; the skewness alone is enough for the mean."""

    skewness: float
    kurtosis: float = 1.0
    fifth: float = 0.0
    sixth: float = 0.0


def trial_skewness(m: Shaped, pull: Pull, n: float) -> float:
    """Skewness of the trials' pulls over √n; 0 where they do not vary."""
    a, b = pull
    variance = _variance(m, pull)
    if not variance > 0.0:
        return 0.0
    third = a * a * a * m.skewness + 3.0 * a * a * b * (m.kurtosis - 1.0)
    third += 3.0 * a * b * b * (m.fifth - 2.0 * m.skewness) + b * b * b * (m.sixth - 3.0 * m.kurtosis + 2.0)
    return float(np.clip(third / variance**1.5 / n**0.5, -1.0, 1.0))


def trial_error(m: Shaped, pull: Pull, n: float) -> float:
    """The standard error of the mean pull of n independent trials."""
    return float((max(_variance(m, pull), 0.0) / (n - 1.0)) ** 0.5)


def _variance(m: Shaped, pull: Pull) -> float:
    a, b = pull
    return a * a + 2.0 * a * b * m.skewness + b * b * (m.kurtosis - 1.0)


def replicate_skewness(m: Moments, pull: Pull) -> float:
    """Skewness of the replicates' pulls over the root of their number; 0 where they do not vary."""
    assert m.totals is not None
    pulls = pull[0] * m.totals[0] + pull[1] * m.totals[1]
    square = float(np.sum(pulls * pulls))
    return float(np.sum(pulls**3) / square**1.5) if square > 0.0 else 0.0


def step_error(x: Floats, m: Moments, pull: Pull, replicates: int, n: float, confidence: float) -> float:
    """The error, times Student's t, of as many crossings of the largest step as replicates that agree may hide.

    Args:
        x: (n,) values in ascending order.
        m: their moments.
        pull: what a value pulls by.
        replicates: how many.
        n: trials of equal weight.
        confidence: of the interval.
    """
    z = (x - m.mean) / m.scale
    steps = np.abs(np.diff(pull[0] * z + pull[1] * z * z))
    hidden = replicates * (1.0 - float(one_tail(confidence) ** (1.0 / replicates)))
    return float(steps.max(initial=0.0)) * hidden / n / t_quantile(replicates - 1.0, confidence)


def few_decide(skewness: float, n: float) -> bool:
    """Whether the error of n trials in replicates is decided by a few far ones; the skewness is over √n."""
    return abs(skewness) > min(SKEWED_BESIDE_ROOT, SKEWED / math.sqrt(n))


def beyond_reach(m: Shaped, pull: Pull, n: float) -> bool:
    """Whether the tail of n trials is so heavy that their interval may be too short."""
    skewness = abs(trial_skewness(m, pull, n)) * math.sqrt(n)
    return m.kurtosis > PEAKED_BESIDE_ROOT * math.sqrt(n) and skewness > BEYOND * n**BEYOND_POWER


def wider(one: Estimate, other: Estimate) -> Estimate:
    """The estimate with the larger error, and both intervals."""
    if one.interval is None or other.interval is None or one.error is None or other.error is None:
        return one
    (low, high), (lower, higher) = one.interval, other.interval
    return Estimate(one.value, max(one.error, other.error), (min(low, lower), max(high, higher)), one.n)
