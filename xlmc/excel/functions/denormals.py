"""Numbers below 2^-1022 in size: Excel has none ("denormalized numbers", Microsoft, article 78113), and takes 0.

The fast path learns of them from NumPy's underflow flag, so that a block without them costs nothing. The flag is raised
by rounded results only: of a product, a quotient, a power or an exponential, not of a difference, which is exact.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["TINIEST", "Underflow", "flush", "tiny_to_zero"]

Floats = NDArray[np.float64]

TINIEST: Final = 2.0**-1022
"""The smallest positive number that Excel has."""


class Underflow:
    """Notes that NumPy raised its underflow flag; the `call` of an `errstate`.

    >>> with np.errstate(under="call", call=(underflow := Underflow())):
    ...     tiny = np.full(2, 1e-160) * 1e-150
    >>> underflow.raised
    True
    """

    __slots__ = ("raised",)

    def __init__(self) -> None:
        self.raised = False

    def __call__(self, kind: str, flags: int) -> None:
        self.raised = True


def tiny_to_zero(x: Any) -> Any:
    """Return the numbers, of any shape, with 0 for those that are too small; the same array where there are none.

    >>> tiny_to_zero(np.array([1.0, 5e-324, 0.0, -1e-310])).tolist()
    [1.0, 0.0, 0.0, 0.0]
    """
    sizes = np.abs(x)
    if sizes.min(initial=np.inf) >= TINIEST:
        return x
    tiny = (sizes < TINIEST) & (sizes > 0)
    return np.where(tiny, 0.0, x) if tiny.any() else x


def flush(x: NDArray[Any]) -> None:
    """Write 0 instead of numbers that are too small; truth values stay."""
    if x.dtype == np.float64:
        x[np.abs(x) < TINIEST] = 0.0
