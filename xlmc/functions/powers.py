"""Powers that come out the same whether one trial is computed or many."""

from __future__ import annotations

from typing import Any

import numpy as np

from xlmc.functions.values import Floats

__all__ = ["powered"]


def powered(base: Any, exponent: Any) -> Floats:
    """`base` to the power of `exponent`; NaN for a negative base and a fraction.

    NumPy squares by a multiplication where the exponent is one number for all, and by `pow` elsewhere, which may differ
    in the last bit. Here every square is a multiplication.
    """
    base = np.asarray(base, np.float64)
    return np.where(np.asarray(exponent) == 2, base * base, np.power(base, exponent))
