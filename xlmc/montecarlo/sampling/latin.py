"""Latin hypercube: in every replicate, each of its equally likely intervals holds one draw of every assumption.

Source: McKay, Beckman & Conover 1979. Sorting random numbers, one for each trial, gives the order of the intervals. So
all orders are equally likely (ties in 50 bits or more apart), and no earlier draw is needed.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.sampling.streams import Stream

__all__ = ["LatinHypercube"]

_LARGEST = 1.0 - 2.0**-53


class LatinHypercube:
    """The stratified uniforms of one assumption, in any order of blocks. For one thread.

    Args:
        seed: of the run.
        name: of the assumption.
        strata: the intervals in a replicate, and so its trials; 1 to 16,384.

    Within its interval a trial keeps the position that it would have in [0, 1) under Monte Carlo.
    """

    def __init__(self, seed: int, name: str, strata: int) -> None:
        self._within, self._order = Stream(seed, name), Stream(seed, name, "Latin hypercube")
        self._strata = strata

    def uniforms(self, start: int, out: NDArray[np.float64]) -> None:
        """Fill `out` (n,) with the uniforms of trials `start` to `start + n - 1`, in [0, 1)."""
        first, last = start // self._strata, -(-(start + out.size) // self._strata)
        skipped = start - first * self._strata
        self._within.uniforms(start, out)
        out += self._intervals(first, last)[skipped : skipped + out.size]
        out /= self._strata
        np.minimum(out, _LARGEST, out=out)

    def _intervals(self, first: int, last: int) -> NDArray[np.uint64]:
        """Return the interval of every trial of the replicates from `first` to before `last`."""
        shape = last - first, self._strata
        keys = self._order.raw(first * self._strata, shape[0] * shape[1]).reshape(shape)
        low = np.uint64((1 << (self._strata - 1).bit_length()) - 1)
        keys &= ~low
        keys |= np.arange(self._strata, dtype=np.uint64)
        keys.sort(axis=1)
        keys &= low
        return keys.ravel()
