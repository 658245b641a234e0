"""Numbers that mpmath knows, kept as doubles: comparing with them again then takes no arithmetic of many digits."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import mpmath
import numpy as np


class Exact(NamedTuple):
    """Numbers, each as the nearest double and what is left, in units in the last place of that double: (n,), (n,).

    The unit of a subnormal is that of all subnormals.
    """

    nearest: np.ndarray
    left: np.ndarray

    @classmethod
    def of(cls, numbers: Iterable[mpmath.mpf]) -> Exact:
        """In the precision that mpmath has now."""
        numbers = [*numbers]
        nearest = np.array([float(number) for number in numbers])
        units = np.spacing(np.abs(nearest)).tolist()
        rows = zip(numbers, nearest.tolist(), units, strict=True)
        return cls(nearest, np.array([float((number - near) / unit) for number, near, unit in rows]))

    def take(self, which: np.ndarray) -> Exact:
        """Some of them."""
        return Exact(self.nearest[which], self.left[which])

    def distance(self, computed: np.ndarray) -> float:
        """How many such units lie between these numbers and doubles, at most; the difference of near ones is exact."""
        assert computed.shape == self.nearest.shape
        return float(np.max(np.abs((computed - self.nearest) / np.spacing(np.abs(self.nearest)) - self.left)))
