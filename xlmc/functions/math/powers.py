"""Powers that come out the same whether one trial is computed or many."""

from __future__ import annotations

from typing import Any

import numpy as np

from xlmc.functions.values import Floats

__all__ = ["powered"]


def powered(base: Any, exponent: Any) -> Floats:
    """`base` to the power of `exponent`, both of at least one axis; NaN for a negative base and a fraction.

    Where the exponent is one number for all trials, NumPy squares, inverts and takes square roots by other means than
    `pow`, which may differ in the last bit. So each trial gets an exponent of its own.
    """
    base, exponents = np.broadcast_arrays(np.atleast_1d(np.asarray(base, np.float64)), np.asarray(exponent, np.float64))
    powers: Floats = np.where(exponents == 2, base * base, np.power(base, exponents.copy()))
    return powers
