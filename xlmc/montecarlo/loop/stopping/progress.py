"""How a run stands: mean and standard deviation of columns that come block by block, and what is said after each.

The moments take constant memory, whatever the number of trials.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.loop.stopping.rule import Observed
from xlmc.montecarlo.statistics.estimate import Estimate, with_error, with_relative_error
from xlmc.montecarlo.statistics.proportions import proportion
from xlmc.montecarlo.statistics.pulls import Pull, Shape, trial_skewness
from xlmc.montecarlo.statistics.yes_no import are_yes_no, deviation_of_share

__all__ = ["Progress", "ProgressTracker", "RunningMoments"]

Floats = NDArray[np.float64]


class RunningMoments:
    """Numbers so far: how many, their mean, and the sums of the powers of what lies between them and it.

    Blocks are merged as by Chan, Golub & LeVeque (1979) and, for powers above the second, by Pébay (2008).

    Args:
        spread: keep what the interval of the standard deviation needs too: powers to the sixth instead of the third.
    """

    def __init__(self, *, spread: bool = True) -> None:
        self.n = 0
        self._pivot = self._mean = 0.0
        self._sums = np.zeros(7 if spread else 4)
        """The sums of the powers 0, 1, 2, … about the mean; that of the first power is always 0."""
        self._yes_no = True

    def add(self, column: Floats) -> None:
        """Take `(m,)` more; NaN is no number."""
        x = column[~np.isnan(column)]
        if x.size == 0:
            return
        if self.n == 0:
            self._pivot = float(x[0])  # all is counted from here, so that 1e9 ± 1 keeps its digits
        self._yes_no = self._yes_no and are_yes_no(x)
        with np.errstate(over="ignore", invalid="ignore"):  # beyond the largest number nothing is ever precise
            x = x - self._pivot
            mean = float(x.mean())
            self._merge(mean, _sums_of_powers(x - mean, self._sums.size))

    def _merge(self, mean: float, sums: Floats) -> None:
        n = self.n + int(sums[0])
        delta = mean - self._mean
        moved = _moved(self._sums, delta * sums[0] / n) + _moved(sums, -delta * self.n / n)
        moved[1] = 0.0
        self._mean += delta * sums[0] / n
        self.n, self._sums = n, moved

    @property
    def deviation(self) -> float:
        """Sample standard deviation; NaN of fewer than two."""
        return math.sqrt(float(self._sums[2]) / (self.n - 1)) if self.n > 1 else math.nan

    def mean(self, confidence: float = 0.95) -> Estimate:
        """As `statistics.mean`, to rounding."""
        if self.n == 0:
            return Estimate(math.nan)
        if self._yes_no and self.n > 1:
            return proportion(round((self._pivot + self._mean) * self.n), self.n, confidence=confidence)
        value, error = self._pivot + self._mean, self.deviation / math.sqrt(self.n)
        return with_error(value, error, self.n - 1.0, confidence, self.n, self._skewness((1.0, 0.0)))

    def standard_deviation(self, confidence: float = 0.95) -> Estimate:
        """As `statistics.standard_deviation`, to rounding: Var(s²) ≈ (m₄ − s⁴(n − 3)/(n − 1))/n."""
        n, value = self.n, self.deviation
        if n > 1 and self._yes_no:
            return deviation_of_share(self.mean(confidence), value, confidence)
        if n < 2 or self._sums[2] == 0.0:
            return with_error(value, 0.0, n - 1.0, confidence, n)
        kurtosis = float(self._standardised()[4])
        error = 0.5 * value * math.sqrt(max(kurtosis - (n - 3.0) / (n - 1.0), 0.0) / n)
        return with_relative_error(value, error, n - 1.0, confidence, n, self._skewness((0.0, 1.0)))

    def _skewness(self, pull: Pull) -> float:
        if not 0.0 < self._sums[2] < math.inf:
            return 0.0
        return trial_skewness(Shape(*self._standardised()[3:]), pull, self.n)

    def _standardised(self) -> Floats:
        """Return the means of the powers of the standardised values."""
        root = (self._sums[2] / self.n) ** 0.5
        values = self._sums / self.n
        for power in range(2, values.size):
            values[power:] /= root if power > 2 else root * root
        return values


def _sums_of_powers(apart: Floats, count: int) -> Floats:
    """Return the sums of the powers 0, 1, … of values about their mean."""
    sums, power = np.zeros(count), apart
    sums[0] = apart.size
    for exponent in range(2, count):
        power = power * apart
        sums[exponent] = power.sum()
    return sums


def _moved(sums: Floats, step: float) -> Floats:
    """Return the sums of powers about a mean that is `step` higher."""
    return np.array([sum(math.comb(p, k) * (-step) ** k * sums[p - k] for k in range(p + 1)) for p in range(sums.size)])


@dataclass(frozen=True, slots=True)
class Progress:
    """How a run stands.

    Attributes:
        trials, accepted: so far.
        share: how much of the run is done, 0 to 1; an estimate where it goes on until something is reached.
        means: forecast -> its mean so far.
        searching: whether accepted trials are being looked for where they are rare; `accepted` counts none of these.
    """

    trials: int
    accepted: int
    share: float
    means: Mapping[str, Estimate]
    searching: bool = False


class ProgressTracker:
    """Follows a run, and says how it stands after each block.

    Args:
        forecasts: the names of all.
        follow: of those whose means are wanted; None for all.
    """

    def __init__(self, forecasts: Sequence[str], follow: Collection[str] | None = None) -> None:
        self._moments = {
            name: (number, RunningMoments(spread=False))
            for number, name in enumerate(forecasts)
            if follow is None or name in follow
        }
        self._trials = self._accepted = 0

    def after(self, block: Observed, share: float) -> Progress:
        """How the run stands after this block too."""
        self._trials += block.trials
        self._accepted += block.accepted.size
        for number, moments in self._moments.values():
            moments.add(block.forecasts[number])
        means = {name: moments.mean() for name, (_, moments) in self._moments.items()}
        return Progress(self._trials, self._accepted, share, means)
