"""SplitMix64: random numbers that the bits of others decide, wherever and in whatever order they are asked for.

The k-th number of a seed is `mixed(seed + k·GOLDEN)`. Source: Steele, Lea and Flood, Fast Splittable Pseudorandom
Number Generators, OOPSLA 2014.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["GOLDEN", "mixed"]

GOLDEN: Final = np.uint64(0x9E3779B97F4A7C15)


def mixed(bits: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Mix the bits so that each of them changes half of the others, `(n,)`."""
    bits = (bits ^ (bits >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    bits = (bits ^ (bits >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return np.asarray(bits ^ (bits >> np.uint64(31)))
