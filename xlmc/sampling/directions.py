"""Sobol's direction numbers, those of Joe and Kuo 2008 (`new-joe-kuo-6.21201`), from the table that SciPy comes with.

The table is read as data: to import `scipy.stats`, which has a generator of its own, takes most of a second.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
import scipy
from numpy.typing import NDArray

from xlmc.errors import SimulationError

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
def _table() -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The polynomials (d,) and the first numbers (d, 18).

    Raises:
        SimulationError: the file is not there.
    """
    path = Path(scipy.__file__).parent / "stats" / "_sobol_direction_numbers.npz"
    try:
        with np.load(path) as table:
            return table["poly"], table["vinit"]
    except OSError as error:
        hint = "Install a SciPy that has it, or use --sampling lhs"
        raise SimulationError("the table of Sobol's direction numbers cannot be read", where=path, hint=hint) from error
