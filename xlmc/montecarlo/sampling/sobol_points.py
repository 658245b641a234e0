"""Scrambled Sobol points: every replicate a digital net, scrambled anew.

Each digit of a point is replaced by itself plus a random sum of the digits before it (Matoušek 1998, a random linear
scramble), and a random digital shift is added, all modulo 2. Then every point is uniform, the points are still a net,
and replicates are independent of each other, so that their differences give the error (Owen 1997; L'Ecuyer 2018).

The direction numbers are those of Joe and Kuo 2008 (`new-joe-kuo-6.21201`). The table was copied from SciPy's; the
folder `joe_kuo` holds it with the licences of both. `scipy.stats` has a generator of its own, but importing it takes
most of a second.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.sampling.streams import Stream

__all__ = ["DIMENSIONS", "PRECISION", "ScrambledSobol", "direction_numbers"]

Words = NDArray[np.uint64]

_RESERVED = 64
"""Random numbers reserved for each replicate, which uses one for every digit, and one for the shift."""

_TABLE_BITS = 12
"""A table of 2^12 points fits into the cache; the next points differ from it by a single number."""

DIMENSIONS: Final = 21_201
"""The dimensions of the table, and so the most assumptions that can be drawn."""

PRECISION: Final = 53
"""Binary digits of a point."""


_ROWS = np.arange(PRECISION - 1, -1, -1, dtype=np.uint64)
_DIAGONAL = np.uint64(1) << _ROWS
_BEFORE = (~(_DIAGONAL | (_DIAGONAL - np.uint64(1)))) & np.uint64((1 << PRECISION) - 1)


class ScrambledSobol:
    """The uniforms of one assumption, in any order of blocks. For one thread.

    Args:
        seed: of the run.
        name: of the assumption.
        dimension: the assumption's number among all, counted from 0: no two have the same.
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
        """Make the columns of a replicate and the table of its first points, unless that is done."""
        if replicate == self._replicate:
            return
        random = self._random.raw(replicate * _RESERVED, PRECISION + 1)
        rows = random[:PRECISION] & _BEFORE | _DIAGONAL
        digits = np.bitwise_count(rows[:, None] & self._net).astype(np.uint64) & np.uint64(1)
        self._columns = np.bitwise_or.reduce(digits << _ROWS[:, None], axis=0)
        table = random[PRECISION:] >> np.uint64(64 - PRECISION)
        for column in self._columns[:_TABLE_BITS]:
            table = np.concatenate([table, table ^ column])
        self._table, self._replicate = table, replicate

    def _offset(self, number: int) -> np.uint64:
        """Return the number by which the points of table `number` differ from those of the first."""
        columns = self._columns[_TABLE_BITS:]
        chosen = [column for bit, column in enumerate(columns) if number >> bit & 1]
        return np.uint64(np.bitwise_xor.reduce(chosen)) if chosen else np.uint64(0)


@cache
def direction_numbers(dimension: int, bits: int) -> NDArray[np.uint64]:
    """Return the generating matrix of a dimension, `(bits,)` columns of 53 binary digits, the first digit the highest.

    Point i is the exclusive or of the columns whose bits are set in i. Column j < s stands in the table, s the degree
    of the dimension's primitive polynomial x^s + a₁x^(s−1) + … + 1; the others follow by
    m_j = 2a₁m_(j−1) ⊕ 2²a₂m_(j−2) ⊕ … ⊕ 2^s m_(j−s) ⊕ m_(j−s), with v_j = m_j / 2^(j+1).

    >>> [f"{column >> 49:04b}" for column in direction_numbers(1, 3).tolist()]
    ['1000', '1100', '1010']
    """
    polynomials, starts = _table()
    polynomial = int(polynomials[dimension])
    degree = polynomial.bit_length() - 1
    numbers = [1] * bits if dimension == 0 else [int(each) for each in starts[dimension, :degree]][:bits]
    while len(numbers) < bits:
        newest = numbers[-degree]
        for back in range(1, degree + 1):
            if polynomial >> (degree - back) & 1:
                newest ^= numbers[-back] << back
        numbers.append(newest)
    return np.array([number << (PRECISION - 1 - j) for j, number in enumerate(numbers)], dtype=np.uint64)


@cache
def _table() -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
    """Read the polynomials (d,) and the first numbers (d, 18)."""
    with np.load(Path(__file__).parent / "joe_kuo" / "direction_numbers.npz") as table:
        return table["polynomials"], table["starts"]
