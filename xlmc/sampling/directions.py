"""Sobol's direction numbers, those of Joe and Kuo 2008 (`new-joe-kuo-6.21201`).

The table was copied from SciPy's; the folder `joe_kuo` holds it with the licences of both. To import `scipy.stats`,
which has a generator of its own, takes most of a second.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["DIMENSIONS", "PRECISION", "direction_numbers"]

DIMENSIONS: Final = 21_201
"""As many as the table has, and so the most assumptions that can be drawn."""

PRECISION: Final = 53
"""Binary digits of a point."""


@cache
def direction_numbers(dimension: int, bits: int) -> NDArray[np.uint64]:
    """The generating matrix of a dimension, `(bits,)` columns of 53 binary digits, the first digit the highest.

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
    """The polynomials (d,) and the first numbers (d, 18)."""
    with np.load(Path(__file__).parent / "joe_kuo" / "direction_numbers.npz") as table:
        return table["polynomials"], table["starts"]
