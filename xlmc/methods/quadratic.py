"""Quadratic polynomials of several variables, fitted by least squares. Letters: n points, k variables, q columns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["Quadratic", "fitted"]

_MOST_WITH_PRODUCTS: Final = 60
"""Variables; with more, only their squares are taken, and no products of two."""

_RIDGE: Final = 1e-10
"""Of a term's mean square: what settles terms that say the same, as the square of a variable that has two values."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Quadratic:
    """Polynomials in z = (x − centre) / scale: constant + slope·z + z·bend·z.

    Attributes:
        centre, scale: `(k,)`.
        constant: `(q,)`.
        slope: `(k, q)`.
        bend: `(q, k, k)`, upper triangles.
    """

    centre: Floats
    scale: Floats
    constant: Floats
    slope: Floats
    bend: Floats

    @staticmethod
    def coefficients(k: int) -> int:
        """How many each polynomial of `k` variables has."""
        return 1 + 2 * k + (k * (k - 1) // 2 if k <= _MOST_WITH_PRODUCTS else 0)

    def __call__(self, points: Floats) -> Floats:
        """The values at `(n, k)` points, `(n, q)`."""
        z = (points - self.centre) / self.scale
        bent = [np.einsum("nk,nk->n", z @ bend, z) for bend in self.bend]
        return np.asarray(self.constant + z @ self.slope + np.column_stack(bent))


def fitted(points: Floats, values: Floats) -> Quadratic:
    """The polynomials of least squares through `(n, k)` points and their values `(n, q)`, of which there is one or more."""
    centre, spread = points.mean(axis=0), points.std(axis=0)
    scale = np.where(spread > 0.0, spread, 1.0)
    z = (points - centre) / scale
    k = z.shape[1]
    first, second = np.triu_indices(k, 0) if k <= _MOST_WITH_PRODUCTS else (np.arange(k), np.arange(k))
    terms = np.concatenate([np.ones((len(z), 1)), z, z[:, first] * z[:, second]], axis=1)
    normal = terms.T @ terms
    normal[np.diag_indices(len(normal))] += _RIDGE * len(z)
    weights = np.linalg.solve(normal, terms.T @ values)
    bend = np.zeros((values.shape[1], k, k))
    bend[:, first, second] = weights[1 + k :].T
    return Quadratic(centre, scale, weights[0], weights[1 : 1 + k], bend)
