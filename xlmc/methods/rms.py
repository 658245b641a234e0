"""Root mean square errors over replicates, and the straight lines that they lie on in logarithms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

__all__ = ["Rms", "line", "rms_of"]

_ENOUGH: Final = 8
"""Replicates from which on chance hardly makes them agree."""


@dataclass(frozen=True, slots=True)
class Rms:
    """The root mean square error of a number, over `n` replicates.

    Attributes:
        value: in the units of the number; NaN where no replicate gave one.
        error: its standard error, from the spread of the squares.
        bias: the mean error: what more replicates would not average away.
        n: replicates that gave a number.
    """

    value: float
    error: float
    bias: float
    n: int

    @property
    def biased(self) -> bool:
        """Whether most of the error is the same in every replicate, and beyond chance; few replicates cannot tell."""
        spread = max(self.value**2 - self.bias**2, 0.0) ** 0.5
        return self.n >= _ENOUGH and self.bias**2 > 0.5 * self.value**2 and abs(self.bias) > 4.0 * spread / self.n**0.5


def rms_of(errors: ArrayLike) -> Rms:
    """The root mean square of errors, NaNs left out.

    >>> rms_of([3.0, -4.0, float("nan")]).value
    3.5355339059327378
    """
    found = np.asarray(errors, np.float64)
    found = found[~np.isnan(found)]
    if not found.size:
        return Rms(np.nan, np.nan, np.nan, 0)
    value = float(np.sqrt(np.mean(found**2)))
    spread = float(np.std(found**2, ddof=1)) if found.size > 1 else np.nan
    error = spread / (2.0 * value * found.size**0.5) if value > 0.0 else 0.0
    return Rms(value, error, float(np.mean(found)), int(found.size))


def line(x: Sequence[float], y: Sequence[float]) -> tuple[float, float]:
    """Slope and height at 1 of the straight line through logarithms; NaN where fewer than two points make one.

    >>> [round(each, 6) for each in line([1, 100], [3, 0.3])]
    [-0.5, 3.0]
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        across, up = np.log(np.asarray(x, np.float64)), np.log(np.asarray(y, np.float64))
    known = np.isfinite(across) & np.isfinite(up)
    across, up = across[known], up[known]
    if across.size < 2 or np.ptp(across) < 1e-9:
        return np.nan, np.nan
    slope = float(np.sum((across - across.mean()) * (up - up.mean())) / np.sum((across - across.mean()) ** 2))
    return slope, float(np.exp(up.mean() - slope * across.mean()))
