"""Two tests of forecasts that a few far trials decide: how much one trial contributes, and how heavy the tail is.

**One trial.** If a forecast has a variance, the part of it that comes from the farthest trial goes to 0 as trials are
added: with 1,000 trials it is about 1 % for a normal forecast, 4 % for an exponential one. If it has none, the part
does not go to 0: for a ratio whose denominator passes 0 (Cauchy) it is 25 to 100 %, however many trials there are. The
mean of such a forecast does not exist; the number printed for it depends on the seed alone, and so does its error.

**The tail.** Hill's estimator gives its index α: P(|x - median| > t) falls as t^-α. The mean exists if α is above 1,
the standard deviation if it is above 2. A ratio whose denominator passes 0 has α = 1.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.montecarlo.statistics.sample import Sample, Values

__all__ = ["farthest_part", "heavy_tail"]


def farthest_part(values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None) -> float:
    """Return the part of the sum of squares about the mean that the farthest trial gives; nan if nothing varies.

    >>> round(farthest_part([0.0, 0.0, 0.0, 4.0]), 12)
    0.75
    """
    sample = Sample.of(values, weights, replicate)
    m = sample.moments
    if sample.n == 0 or not m.scale > 0.0:
        return math.nan
    shares = (1.0 / sample.n,) * 2 if sample.w is None else (float(sample.w[0]), float(sample.w[-1]))
    ends = float(sample.x[0]), float(sample.x[-1])
    return max(share * ((end - m.mean) / m.scale) ** 2 for share, end in zip(shares, ends, strict=True))


Floats = NDArray[np.float64]

_SHARE: Final = 0.02
_FEWEST: Final = 40
"""The share of the numbers that counts as the tail, and the fewest: the error of α is a sixth of it, or less."""

_FAR: Final = 0.25
"""The share of the tail that must be as heavy by itself; if it is not, only a few trials lie apart from the rest."""


def _tail_index(x: Floats, part: float = 1.0) -> tuple[float, float]:
    """Return Hill's index of the heavier tail, and its standard error; infinite if there are too few numbers.

    Args:
        x: the numbers.
        part: the share of the tail that is used, from the far end.
    """
    known = x[np.isfinite(x)]
    k = int(max(_FEWEST, _SHARE * known.size))
    if known.size < 10 * k:
        return np.inf, 0.0
    middle = np.median(known)
    best = np.inf
    for side in (known - middle, middle - known):
        largest = np.sort(side)[-int(part * k) - 1 :]
        if largest[0] > 0:
            best = min(best, 1.0 / max(float(np.mean(np.log(largest[1:] / largest[0]))), 1e-300))
    return best, best / np.sqrt(k)


_LIMIT: Final = 2.0


def heavy_tail(x: Floats) -> tuple[float, float] | None:
    """Return index and standard error of a tail so heavy that the standard deviation does not converge, else None."""
    index, error = _tail_index(x)
    return (index, error) if index + 2 * error < _LIMIT and _tail_index(x, _FAR)[0] < _LIMIT else None
