"""How heavy a distribution's tail is, by Hill's estimator of its index α: P(|x - median| > t) falls as t^-α.

The mean exists above 1, the standard deviation above 2. A quotient whose divisor goes through 0 has α = 1.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["heavy_tail", "tail_index"]

Floats = NDArray[np.float64]

_SHARE: Final = 0.02
_FEWEST: Final = 40
"""Of the numbers, and how many at least, that count as the tail: α is known to a sixth of itself, or better."""

_FAR: Final = 0.25
"""Of the tail: there it must be as heavy, or it is but a few trials that lie apart from the rest."""


def tail_index(x: Floats, part: float = 1.0) -> tuple[float, float]:
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
    index, error = tail_index(x)
    return (index, error) if index + 2 * error < _LIMIT and tail_index(x, _FAR)[0] < _LIMIT else None
