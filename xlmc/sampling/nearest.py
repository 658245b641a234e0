"""The nearest correlation matrix: what to draw with when the correlations asked for contradict each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["nearest_correlation"]

Floats = NDArray[np.float64]

_ROUNDS = 10_000
_CLOSE = 1e-12
"""The change of a round, beside the size of the matrix, at which the projections have met."""


def nearest_correlation(matrix: Floats) -> Floats:
    """The correlation matrix (k, k) nearest to a symmetric one in the Frobenius norm.

    Projections by turns on the positive semidefinite matrices and on those with a diagonal of 1; Dykstra's correction
    of the first makes them meet at the nearest point rather than at any (Higham 2002, algorithm 3.3).

    >>> nearest_correlation(np.array([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]]))[0].round(4).tolist()
    [1.0, 0.7607, 0.1573]
    """
    found, correction = matrix.copy(), np.zeros_like(matrix)
    for _ in range(_ROUNDS):
        before = found
        corrected = before - correction
        inside = _semidefinite(corrected)
        correction = inside - corrected
        found = inside.copy()
        np.fill_diagonal(found, 1.0)
        if np.linalg.norm(found - before) <= _CLOSE * np.linalg.norm(found):
            break
    return found


def _semidefinite(matrix: Floats) -> Floats:
    """Without its negative eigenvalues."""
    values, vectors = np.linalg.eigh(matrix)
    return np.asarray((vectors * np.maximum(values, 0.0)) @ vectors.T)
