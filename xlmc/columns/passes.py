"""Passes over long columns, a part at a time, so that memory stays flat."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.columns.mapped import on_disk, release

__all__ = ["PART", "pairwise_sum", "parts", "picked"]

PART = 65_536
"""Values looked at together: a few arrays of so many fit in the processor's cache."""

_PICKED = 512


def parts(values: NDArray[Any], size: int = PART) -> Iterator[NDArray[Any]]:
    """The column in order, `size` values at a time; take what you keep before the next part."""
    for start in range(0, values.size, size):
        yield values[start : start + size]
        release(values)


def pairwise_sum(term: Callable[[slice], NDArray[np.float64]], n: int) -> float:
    """The sum of n terms, which are made for a slice of them at a time.

    To the bit what `np.sum` gives for all of them in one array: it halves in the same places.
    """
    return float(_between(term, 0, n))


def _between(term: Callable[[slice], NDArray[np.float64]], start: int, stop: int) -> np.float64:
    n = stop - start
    if n <= PART:
        found: np.float64 = np.add.reduce(term(slice(start, stop)))
        return found
    half = n // 2
    half -= half % 8  # as NumPy, which sums in eights
    return _between(term, start, start + half) + _between(term, start + half, stop)


def picked(values: NDArray[Any], places: NDArray[np.intp]) -> NDArray[Any]:
    """The values at `(m,)` places, in memory of their own."""
    if not on_disk(values):
        return np.asarray(values[places])
    found = np.empty(places.size, values.dtype)
    for start in range(0, places.size, _PICKED):
        here = slice(start, start + _PICKED)
        found[here] = values[places[here]]
        release(values)
    return found
