"""Numbers that a few far trials decide: does the mean hang on one trial, and how heavy is the tail?

**One trial.** Of a forecast with a variance, the part that the farthest trial has in it goes to 0 as trials are added:
1,000 trials of a normal forecast give it about 1 %, of an exponential one 4 %. Of a forecast without one it never does:
of a ratio whose denominator passes 0 (Cauchy) it is 25 to 100 %, however many trials there are. The mean of such a
forecast does not exist; the number printed for it is an accident of the seed, and so is its error.

**The tail.** Hill's estimator of its index α: P(|x - median| > t) falls as t^-α. The mean exists above 1, the standard
deviation above 2. A ratio whose denominator passes 0 has α = 1.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.statistics.sample import Sample, Values

__all__ = ["farthest_part", "heavy_tail"]


def farthest_part(values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None) -> float:
    """The part that the trial farthest from the mean has in the sum of squares about it; nan where nothing varies.

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
"""Of the numbers, and how many at least, that count as the tail: α is known to a sixth of itself, or better."""

_FAR: Final = 0.25
"""Of the tail: there it must be as heavy, or it is but a few trials that lie apart from the rest."""


def _tail_index(x: Floats, part: float = 1.0) -> tuple[float, float]:
    """Hill's index of the heavier tail, and its standard error; infinite where there are too few numbers.

    Args:
        x: the numbers.
        part: of the tail, from the far end.
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
    """Index and its standard error where the tail is so heavy that the standard deviation does not converge."""
    index, error = _tail_index(x)
    return (index, error) if index + 2 * error < _LIMIT and _tail_index(x, _FAR)[0] < _LIMIT else None
