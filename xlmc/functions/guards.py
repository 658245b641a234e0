"""Where a ufunc and Excel agree, where that is a matter of size."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from xlmc.functions.values import Floats

__all__ = ["Within"]


@dataclass(frozen=True, slots=True)
class Within:
    """A guard: all numbers lie between -limit and limit."""

    limit: float

    def __call__(self, x: Floats) -> bool:
        """Whether they do; NaN does not."""
        least, most = np.minimum.reduce(x, axis=None, initial=0.0), np.maximum.reduce(x, axis=None, initial=0.0)
        return bool(least > -self.limit and most < self.limit)

    def surely(self, low: float, high: float) -> bool:
        """Whether numbers do that lie between these two, or past them by rounding."""
        return -0.5 * self.limit < low and high < 0.5 * self.limit
