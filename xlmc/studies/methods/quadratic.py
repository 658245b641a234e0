"""Quadratic polynomials of several variables, fitted by least squares. Letters: n points, k variables, q columns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["Quadratic", "fitted"]

_MOST_WITH_PRODUCTS: Final = 60
"""Variables; with more, only their squares are taken, and no products of two."""

_AT_ONCE: Final = 1_024
"""Points whose terms stay in the cache."""

_RIDGE: Final = 1e-10
"""Of a term's mean square: what settles terms that say the same, as the square of a variable that has two values."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Quadratic:
    """Polynomials in z = (x − centre) / scale: weights · (1, z, products of two).

    Attributes:
        centre, scale: `(k,)`.
        weights: `(q, coefficients)`.
    """

    centre: Floats
    scale: Floats
    weights: Floats

    @staticmethod
    def coefficients(k: int) -> int:
        """How many each polynomial of `k` variables has."""
        return 1 + 2 * k + (k * (k - 1) // 2 if k <= _MOST_WITH_PRODUCTS else 0)

    def __call__(self, points: Floats) -> Floats:
        """The values at `(n, k)` points, `(n, q)`."""
        parts = [points[start : start + _AT_ONCE] for start in range(0, len(points), _AT_ONCE)]
        # Not a matrix product: these are small, and its threads would wait for each other.
        found = [np.einsum("qt,tn->qn", self.weights, _terms((part - self.centre) / self.scale)) for part in parts]
        return np.concatenate(found, axis=1).T


def fitted(points: Floats, values: Floats) -> Quadratic:
    """The polynomials of least squares through `(n, k)` points and their values `(n, q)`."""
    centre, spread = points.mean(axis=0), points.std(axis=0)
    scale = np.where(spread > 0.0, spread, 1.0)
    terms = _terms((points - centre) / scale)
    normal = terms @ terms.T
    normal[np.diag_indices(len(normal))] += _RIDGE * len(points)
    return Quadratic(centre, scale, np.asarray(np.linalg.solve(normal, terms @ values).T, np.float64))


def _terms(z: Floats) -> Floats:
    """(coefficients, n): 1, the variables, their squares and, of few variables, their products."""
    n, k = z.shape
    columns = np.ascontiguousarray(z.T)
    found = np.empty((Quadratic.coefficients(k), n))
    found[0], found[1 : 1 + k] = 1.0, columns
    np.multiply(columns, columns, out=found[1 + k : 1 + 2 * k])
    place = 1 + 2 * k
    for i in range(k - 1 if k <= _MOST_WITH_PRODUCTS else 0):
        np.multiply(columns[i], columns[i + 1 :], out=found[place : place + k - 1 - i])
        place += k - 1 - i
    return found
