"""How high an envelope must be over weights, for trials that are kept by chance to be as good as of equal weight.

A trial of weight w under an envelope of height h is kept with probability w/h. One above the envelope would have to be
kept more than once: w/h times, on average. That is allowed as far as copies cost 1 % of the effective sample size
(Kish 1965): an envelope above all weights is several times to a hundred times higher, and keeps so many trials less.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["COPIED", "copies", "height"]

Floats = NDArray[np.float64]

COPIED: Final = 0.01
"""By how much Σc² may exceed Σc, c the copies of each trial, as a share of Σc."""

_STEPS: Final = 50


def height(logs: Floats, kept: float | None = None, least: float = -math.inf) -> float:
    """The logarithm of the lowest envelope, from `least` on, that costs no more than that.

    Args:
        logs: (m,) logarithms of the weights; those below `least` may be missing.
        kept: trials that will be kept in all; by default as many as the envelope keeps of these.
        least: from where on.
    """
    highest = float(logs.max(initial=-math.inf))
    if highest <= least or highest == -math.inf:
        return max(least, highest)
    low, high = max(least, highest - 50.0), highest
    if least > -math.inf and _fits(logs, low, kept):
        return low
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if _fits(logs, middle, kept) else (middle, high)
    return high


def _fits(logs: Floats, height_: float, kept: float | None) -> bool:
    ratios = np.exp(logs - height_)
    above = ratios[ratios > 1.0]
    return float(np.sum(above * above - above)) <= COPIED * (float(ratios.sum()) if kept is None else kept)


def copies(logs: Floats, luck: Floats, height_: float) -> NDArray[np.int64]:
    """(m,) how often each trial is kept.

    That is its weight over the envelope, rounded down, or up where its luck, (m,) in [0, 1), is less than the rest.
    """
    ratios = np.exp(logs - height_)
    whole = np.floor(ratios)
    return np.asarray(whole + (luck < ratios - whole), dtype=np.int64)
