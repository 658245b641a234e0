"""Scrambled Sobol points: every replicate a digital net, scrambled anew.

Each digit of a point is replaced by itself plus a random sum of the digits before it (Matoušek 1998, a random linear
scramble), and a random digital shift is added, all modulo 2. Every point is then uniform, what makes a net is kept, and
replicates are independent of each other, so that their differences give the error (Owen 1997; L'Ecuyer 2018).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from xlmc.sampling.directions import PRECISION, direction_numbers
from xlmc.sampling.streams import Stream

__all__ = ["ScrambledSobol"]

Words = NDArray[np.uint64]

_PLACES = 64
"""Random numbers set apart for each replicate: one for every digit, and one for the shift."""

_TABLE_BITS = 12
"""Points of a table that others differ from by one number only: it fits into the cache."""

_ROWS = np.arange(PRECISION - 1, -1, -1, dtype=np.uint64)
_DIAGONAL = np.uint64(1) << _ROWS
_BEFORE = (~(_DIAGONAL | (_DIAGONAL - np.uint64(1)))) & np.uint64((1 << PRECISION) - 1)


class ScrambledSobol:
    """The uniforms of one assumption, in any order of blocks. For one thread.

    Args:
        seed: of the run.
        name: of the assumption.
        dimension: the assumption's place among all, counted from 0: no two have the same.
        size: trials in a replicate, a power of two.
    """

    def __init__(self, seed: int, name: str, dimension: int, size: int) -> None:
        self._random = Stream(seed, name, "Sobol")
        self._size = size
        self._net = direction_numbers(dimension, size.bit_length() - 1)
        self._replicate = -1
        self._columns = self._table = np.empty(0, np.uint64)

    def uniforms(self, start: int, out: NDArray[np.float64]) -> None:
        """Fill `out` (n,) with the uniforms of trials `start` to `start + n - 1`, in [0, 1) on the grid k·2⁻⁵³."""
        done = 0
        while done < out.size:
            replicate, first = divmod(start + done, self._size)
            self._scramble(replicate)
            number, low = divmod(first, self._table.size)
            points = self._table[low : low + out.size - done] ^ self._offset(number)
            np.multiply(points, 2.0**-PRECISION, out=out[done : done + points.size])
            done += points.size

    def _scramble(self, replicate: int) -> None:
        """Make the columns of a replicate and the table of its first points, unless they are there."""
        if replicate == self._replicate:
            return
        random = self._random.raw(replicate * _PLACES, PRECISION + 1)
        rows = random[:PRECISION] & _BEFORE | _DIAGONAL
        digits = np.bitwise_count(rows[:, None] & self._net).astype(np.uint64) & np.uint64(1)
        self._columns = np.bitwise_or.reduce(digits << _ROWS[:, None], axis=0)
        table = random[PRECISION:] >> np.uint64(64 - PRECISION)
        for column in self._columns[:_TABLE_BITS]:
            table = np.concatenate([table, table ^ column])
        self._table, self._replicate = table, replicate

    def _offset(self, number: int) -> np.uint64:
        """What the points of the table numbered `number` differ by from those of the first."""
        columns = self._columns[_TABLE_BITS:]
        chosen = [column for bit, column in enumerate(columns) if number >> bit & 1]
        return np.uint64(np.bitwise_xor.reduce(chosen)) if chosen else np.uint64(0)
