"""The regularised incomplete beta function and its inverse, to all digits at both ends.

The function of x loses digits where x is near 1. So whoever calls also says what y = 1 - x is, as it knows it best, and
the smaller of the two is worked with.
"""

from __future__ import annotations

import numpy as np

from xlmc.functions.values import Floats

__all__ = ["incomplete_beta", "inverse_beta"]


def incomplete_beta(a: Floats, b: Floats, x: Floats, y: Floats) -> Floats:
    """Probability that a beta number is at most x = 1 - y; arrays that broadcast."""
    from scipy.special import betainc, betaincc

    low = np.asarray(x) <= y
    out = np.empty(np.broadcast_shapes(np.shape(a), np.shape(b), np.shape(low)))
    betainc(a, b, x, out=out, where=low)
    betaincc(b, a, y, out=out, where=~low)
    return out


def inverse_beta(a: Floats, b: Floats, p: Floats) -> tuple[Floats, Floats]:
    """The beta number x of a probability, and 1 - x; arrays that broadcast."""
    from scipy.special import betainccinv, betaincinv

    return np.asarray(betaincinv(a, b, p)), np.asarray(betainccinv(b, a, p))
