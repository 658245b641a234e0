"""Root mean square errors over replicates, and the straight lines that they lie on in logarithms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

__all__ = ["NORMAL_95", "Rms", "line", "rms_of"]

NORMAL_95: Final = 1.959964
"""95 of 100 runs lie within so many root mean square errors."""

_BEYOND_CHANCE: Final = 4.0
"""Standard errors from which on a mean error counts as more than chance: many numbers are looked at."""


@dataclass(frozen=True, slots=True)
class Rms:
    """The root mean square error of a number, over `n` replicates, without the error of what it is measured against.

    Attributes:
        value: in the units of the number; NaN where no replicate gave one. The spread of the replicates about their own
            mean, and the mean error with it where that is more than chance and the reference's error explain.
        error: its standard error; of a single answer, the reference's own error.
        bias: the mean error: what more replicates would not average away. It has the reference's error in it.
        spread: standard deviation of the errors about their mean; NaN of a single answer.
        n: replicates that gave a number.
    """

    value: float
    error: float
    bias: float
    spread: float
    n: int

    @property
    def interval(self) -> tuple[float, float]:
        """Where the true root mean square error lies, with 95 % confidence (χ² of as many replicates).

        Of a single answer, within 1.96 standard errors of the reference.
        """
        if self.n < 2 or not self.value > 0.0:
            reach = NORMAL_95 * float(np.nan_to_num(self.error))
            return max(self.value - reach, 0.0), self.value + reach
        from scipy.special import chdtri

        free = self.n - 1
        low, high = (float(np.sqrt(free / chdtri(free, p))) for p in (0.025, 0.975))
        return low * self.value, high * self.value


def rms_of(errors: ArrayLike, reference: float = 0.0) -> Rms:
    """The root mean square of errors, NaNs left out.

    Args:
        errors: the differences from a reference.
        reference: its standard error.

    >>> rms_of([3.0, -4.0, 1.0, float("nan")]).value
    3.605551275463989
    """
    found = np.asarray(errors, np.float64)
    found = found[~np.isnan(found)]
    known = float(np.nan_to_num(reference))
    if not found.size:
        return Rms(np.nan, np.nan, np.nan, np.nan, 0)
    bias = float(np.mean(found))
    if found.size == 1:
        return Rms(abs(bias), known, bias, np.nan, 1)
    spread = float(np.std(found, ddof=1))
    chance = spread**2 / found.size + known**2
    more = max(bias**2 - chance, 0.0) if bias**2 > _BEYOND_CHANCE**2 * chance else 0.0
    value = float(np.sqrt(spread**2 + more))
    return Rms(value, value / float(np.sqrt(2.0 * (found.size - 1))), bias, spread, int(found.size))


def line(x: Sequence[float], y: Sequence[float], weights: Sequence[float] | None = None) -> tuple[float, float]:
    """Slope and height at 1 of the straight line through logarithms; NaN where fewer than two points make one.

    >>> [round(each, 6) for each in line([1, 100], [3, 0.3])]
    [-0.5, 3.0]
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        across, up = np.log(np.asarray(x, np.float64)), np.log(np.asarray(y, np.float64))
    known = np.isfinite(across) & np.isfinite(up)
    weigh = np.ones(across.shape) if weights is None else np.asarray(weights, np.float64)
    across, up, weigh = across[known], up[known], weigh[known]
    if across.size < 2 or np.ptp(across) < 1e-9:
        return np.nan, np.nan
    middle, height = np.average(across, weights=weigh), np.average(up, weights=weigh)
    slope = float(np.sum(weigh * (across - middle) * (up - height)) / np.sum(weigh * (across - middle) ** 2))
    return slope, float(np.exp(height - slope * middle))
