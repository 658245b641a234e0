"""Mean and standard deviation of a column that comes block by block, with their errors, in constant memory."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from xlmc.statistics.estimate import Estimate, with_error, with_relative_error

__all__ = ["RunningMoments"]

Floats = NDArray[np.float64]


class RunningMoments:
    """Numbers so far: how many, their mean, and the sums of the powers of what lies between them and it.

    Blocks are merged as by Chan, Golub & LeVeque (1979) and, for the third and fourth powers, by Pébay (2008).

    Args:
        spread: keep what the error of the standard deviation needs too.
    """

    def __init__(self, *, spread: bool = True) -> None:
        self._spread = spread
        self.n = 0
        self._pivot = 0.0
        self._mean = self._m2 = self._m3 = self._m4 = 0.0

    def add(self, column: Floats) -> None:
        """Take `(m,)` more; NaN is no number."""
        x = column[~np.isnan(column)]
        if x.size == 0:
            return
        if self.n == 0:
            self._pivot = float(x[0])  # all is counted from here, so that 1e9 ± 1 keeps its digits
        with np.errstate(over="ignore", invalid="ignore"):  # beyond the largest number nothing is ever precise
            x = x - self._pivot
            mean = float(x.mean())
            apart = x - mean
            square = apart * apart
            m3 = m4 = 0.0
            if self._spread:
                m3, m4 = float(np.sum(square * apart)), float(np.sum(square * square))
            self._merge(x.size, mean, float(square.sum()), m3, m4)

    def _merge(self, b: int, mean: float, m2: float, m3: float, m4: float) -> None:
        a, delta = self.n, mean - self._mean
        n = a + b
        step = delta / n
        self._m4 += (
            m4
            + delta * step * step * step * a * b * (a * a - a * b + b * b)
            + 6.0 * step * step * (a * a * m2 + b * b * self._m2)
            + 4.0 * step * (a * m3 - b * self._m3)
        )
        self._m3 += m3 + delta * step * step * a * b * (a - b) + 3.0 * step * (a * m2 - b * self._m2)
        self._m2 += m2 + delta * step * a * b
        self._mean += step * b
        self.n = n

    @property
    def deviation(self) -> float:
        """Sample standard deviation; NaN of fewer than two."""
        return math.sqrt(self._m2 / (self.n - 1)) if self.n > 1 else math.nan

    def mean(self, confidence: float = 0.95) -> Estimate:
        """As `statistics.mean`, to rounding."""
        if self.n == 0:
            return Estimate(math.nan)
        return with_error(
            self._pivot + self._mean, self.deviation / math.sqrt(self.n), self.n - 1.0, confidence, self.n
        )

    def standard_deviation(self, confidence: float = 0.95) -> Estimate:
        """As `statistics.standard_deviation`, to rounding: Var(s²) ≈ (m₄ − s⁴(n − 3)/(n − 1))/n."""
        n, value = self.n, self.deviation
        if n < 2 or self._m2 == 0.0:
            return with_error(value, 0.0, n - 1.0, confidence, n)
        kurtosis = self._m4 / self._m2 * n / self._m2
        error = 0.5 * value * math.sqrt(max(kurtosis - (n - 3.0) / (n - 1.0), 0.0) / n)
        return with_relative_error(value, error, n - 1.0, confidence, n)
