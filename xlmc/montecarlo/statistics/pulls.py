"""How unevenly the trials pull a number, and how much of its error a few far trials decide.

Apart from negligible terms, the mean, the variance, the standard deviation and the coefficient of variation are means
over all trials of a pull, a·z + b·(z² − 1), where z is the standardised value. The skewness of the pulls over the root
of the number of units is, to first order, the skewness of the number itself from run to run. If it is large, runs
without far trials have too small a number and too small an error at once, and symmetric intervals miss the truth.

**Interval.** Hall's monotone cubic (Hall 1992, J. R. Statist. Soc. B 54, 221) corrects Student's t for the skewness.
Neither side becomes shorter than without it, and both are longer by 0.15 of the skewness, because a sample shows too
little of its skewness.

**Replicates.** If one input decides a forecast, each replicate of a Latin hypercube or of Sobol points has one trial in
the outermost interval. The error comes from these few, 16 draws from the tail, however many trials there are. If the
pulls of all trials say that this tail is heavy, the 16 draws do not show it; then the error is that of independent
trials, which evenly spread draws do not exceed.

**Steps.** If a forecast takes few values, or jumps, a replicate of evenly spread draws has k trials on one side of a
step or k + 1. Even if 16 replicates agree, one in five of all replicates may differ. So the interval is at least as
wide as the change that so many trials would make by crossing the largest step between neighbouring values.
"""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.statistics.estimate import Estimate, one_tail, t_quantile
from xlmc.montecarlo.statistics.moments import Moments

__all__ = [
    "Pull",
    "Shape",
    "Shaped",
    "beyond_reach",
    "few_decide",
    "reach",
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
"""The replicates do not show the error if the skewness of the trials' pulls is above the first number, or over √n above
the second. It is 2 for the mean of an exponential forecast, 2.8 for the SD of a normal one, 6 for the mean of a
lognormal one with σ = 1, 11 for the SD of an exponential one (docs/sampling.md has the coverage)."""

BEYOND, BEYOND_POWER = 0.63, 0.4
"""Above a skewness of 0.63 n^0.4 even the corrected interval is too short: that of n pulls cannot exceed √n."""

PART_OF_ROOT = 1.0 / 3.0
"""With a few hundred trials it is too short above this part of √n already."""

PEAKED_BESIDE_ROOT = 0.7
"""No tail is too heavy if the kurtosis over √n is below this. A normal forecast has 3, an exponential one 9."""


class Shaped(Protocol):
    """An object that has the means of powers of the standardised values."""

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
    """Return the skewness of the trials' pulls over √n; 0 if they do not vary."""
    a, b = pull
    variance = _variance(m, pull)
    if not variance > 0.0:
        return 0.0
    third = a * a * a * m.skewness + 3.0 * a * a * b * (m.kurtosis - 1.0)
    third += 3.0 * a * b * b * (m.fifth - 2.0 * m.skewness) + b * b * b * (m.sixth - 3.0 * m.kurtosis + 2.0)
    return float(np.clip(third / variance**1.5 / n**0.5, -1.0, 1.0))


def trial_error(m: Shaped, pull: Pull, n: float) -> float:
    """Return the standard error of the mean pull of n independent trials."""
    return float((max(_variance(m, pull), 0.0) / (n - 1.0)) ** 0.5)


def _variance(m: Shaped, pull: Pull) -> float:
    a, b = pull
    return a * a + 2.0 * a * b * m.skewness + b * b * (m.kurtosis - 1.0)


def replicate_skewness(m: Moments, pull: Pull) -> float:
    """Return the skewness of the replicates' pulls over the root of their number; 0 if they do not vary."""
    assert m.totals is not None
    pulls = pull[0] * m.totals[0] + pull[1] * m.totals[1]
    square = float(np.sum(pulls * pulls))
    return float(np.sum(pulls**3) / square**1.5) if square > 0.0 else 0.0


def step_error(x: Floats, m: Moments, pull: Pull, replicates: int, n: float, confidence: float) -> float:
    """Return the error that, times Student's t, is the change by the crossings that agreeing replicates may hide.

    Args:
        x: (n,) values in ascending order.
        m: their moments.
        pull: the factors of z and z².
        replicates: how many there are.
        n: trials of equal weight.
        confidence: the confidence of the interval.
    """
    z = (x - m.mean) / m.scale
    steps = np.abs(np.diff(pull[0] * z + pull[1] * z * z))
    hidden = replicates * (1.0 - float(one_tail(confidence) ** (1.0 / replicates)))
    return float(steps.max(initial=0.0)) * hidden / n / t_quantile(replicates - 1.0, confidence)


def few_decide(skewness: float, n: float) -> bool:
    """Return whether a few far trials decide the error of n trials in replicates; the skewness is that over √n."""
    return abs(skewness) > min(SKEWED_BESIDE_ROOT, SKEWED / math.sqrt(n))


def beyond_reach(m: Shaped, pull: Pull, n: float) -> bool:
    """Return whether the tail of n trials is so heavy that their interval may be too short."""
    skewness = abs(trial_skewness(m, pull, n)) * math.sqrt(n)
    return m.kurtosis > PEAKED_BESIDE_ROOT * math.sqrt(n) and skewness > reach(n)


def reach(n: float) -> float:
    """Return the skewness of n pulls above which even the corrected interval of their mean is too short."""
    return float(min(BEYOND * n**BEYOND_POWER, PART_OF_ROOT * math.sqrt(n)))


def wider(one: Estimate, other: Estimate) -> Estimate:
    """Return the first estimate with the larger error and with an interval that holds both intervals."""
    if one.interval is None or other.interval is None or one.error is None or other.error is None:
        return one
    (low, high), (lower, higher) = one.interval, other.interval
    return Estimate(one.value, max(one.error, other.error), (min(low, lower), max(high, higher)), one.n)
