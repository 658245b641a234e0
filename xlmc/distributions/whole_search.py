"""The smallest whole number for which something holds, for every trial at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from xlmc.distributions.base import Array

__all__ = ["smallest"]

FARTHEST = 2.0**52
"""Whole numbers are told apart up to here."""

Holds = Callable[[Array, NDArray[np.intp]], NDArray[np.bool_]]
"""Of candidates `(m,)` and the trials `(m,)` they belong to: where it holds. It does from some number up."""


def smallest(holds: Holds, guess: Array, low: Array, high: Array) -> Array:
    """The smallest whole number in [low, high] for which `holds`; `high` where it holds nowhere below.

    Steps that double lead from the guess to a bracket, halving narrows it: a right guess costs two questions.

    Args:
        holds: the condition.
        guess: `(n,)`; NaN in trials that have no answer.
        low: `(n,)`, where to begin.
        high: `(n,)`, where to end; may be infinite.
    """
    below, above = low - 1, np.minimum(high, FARTHEST)
    k = np.clip(np.rint(guess), low, above)
    step = np.ones_like(k)
    open_ = np.flatnonzero(np.isfinite(k) & (above - below > 1))
    while open_.size:
        here = k[open_]
        held = holds(here, open_)
        above[open_] = np.where(held, here, above[open_])
        below[open_] = np.where(held, below[open_], here)
        onward = np.where(held, here - step[open_], here + step[open_])
        within = (onward > below[open_]) & (onward < above[open_])
        k[open_] = np.where(within, onward, np.floor((below[open_] + above[open_]) / 2))
        step[open_] *= 2
        open_ = open_[above[open_] - below[open_] > 1]
    return np.where(np.isfinite(k), above, np.nan)
