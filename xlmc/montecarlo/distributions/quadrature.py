"""Gauss and Legendre's rule for integrals, made once for each number of nodes."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

__all__ = ["gauss_legendre"]


@cache
def gauss_legendre(count: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the nodes between -1 and 1 and their weights, both `(count,)` and not to be written to.

    NumPy finds them as eigenvalues, which takes a tenth of a second for 500 nodes: as long as the rest of the reading
    of a small workbook, for each assumption that needs the rule.
    """
    nodes, weights = np.polynomial.legendre.leggauss(count)
    nodes.flags.writeable = weights.flags.writeable = False
    return nodes, weights
