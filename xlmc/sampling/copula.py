"""Rank correlation by a Gaussian copula: uniforms in, uniforms out, trial by trial."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from xlmc.sampling.nearest import nearest_correlation
from xlmc.sampling.ties import Ties, bounds, parameter, spearman

__all__ = ["GaussianCopula"]

Floats = NDArray[np.float64]

_HALF_STEP = 2.0**-54

_LEAST = 2.0**-80
"""The least probability that a draw is made from: less has a chance of 1e-24."""

_ROUNDING = 1e-9
"""An eigenvalue so little below 0 is one of 0: no correlation need change by more than this."""


class GaussianCopula:
    """Joins k uniforms so that the draws' Spearman correlations are those of `target`, or the nearest possible ones.

    The first keeps its own draws; each other mixes its own with those before it.

    Args:
        target: the matrix `(k, k)`, symmetric with a diagonal of 1.
        ties: the values that each of the k takes, None for a continuous one; by default all are continuous.

    Attributes:
        wanted: the target, each number brought to what ties let its pair have.
        spearman: the matrix that the draws have.
        repaired: whether that is another one than was wanted, because no joint distribution of this kind has it.

    Source: Pearson correlation of the normals ρ = 2 sin(π r_s / 6) (Kruskal 1958), which is exact; see `ties` for draws
    with few values. These are what must be positive semidefinite, so it is they that are repaired (Higham 2002), and
    the ranks follow from them.
    """

    def __init__(self, target: Floats, ties: Sequence[Ties | None] = ()) -> None:
        self._ties = ties
        pearson = 2 * np.sin(np.pi / 6 * target)
        np.fill_diagonal(pearson, 1.0)
        self.wanted = target.copy()
        for i, j in self._tied():
            least, most = bounds(ties[i], ties[j])
            self.wanted[i, j] = self.wanted[j, i] = min(max(float(target[i, j]), least), most)
            pearson[i, j] = pearson[j, i] = parameter(ties[i], ties[j], float(target[i, j])) if target[i, j] else 0.0
        self.repaired = bool(np.linalg.eigvalsh(pearson)[0] < -_ROUNDING)
        self._mix = _triangular_root(nearest_correlation(pearson) if self.repaired else pearson)
        normals = np.clip(self._mix @ self._mix.T, -1.0, 1.0)
        self.spearman = 6 / np.pi * np.arcsin(normals / 2)
        for i, j in self._tied():
            self.spearman[i, j] = self.spearman[j, i] = spearman(ties[i], ties[j], float(normals[i, j]))

    def _tied(self) -> Iterator[tuple[int, int]]:
        """The pairs of which one takes few values."""
        places = range(len(self._ties))
        return ((i, j) for i, j in combinations(places, 2) if self._ties[i] or self._ties[j])

    def join(self, u: Floats) -> None:
        """Replace the rows of `u` (k, n), independent uniforms in [0, 1), by joined ones."""
        from scipy.special import ndtr, ndtri

        z = ndtri(np.maximum(u, _HALF_STEP))
        for i in range(len(u) - 1, 0, -1):  # each row needs only itself and the rows above it
            joined = self._mix[i, 0] * z[0]
            for j in range(1, i + 1):
                joined += self._mix[i, j] * z[j]
            u[i] = np.clip(ndtr(joined), _LEAST, 1 - 2.0**-53)


def _triangular_root(matrix: Floats) -> Floats:
    """The lower triangle (k, k), rows of length 1, that times its transpose is the matrix, which may be singular.

    A square root by eigenvalues, turned until it is triangular: as accurate where correlations are ±1 as elsewhere. An
    eigenvalue that is nothing but rounding, 1e-16, would have a root of 1e-8, and ±1 would not be ±1.
    """
    values, vectors = np.linalg.eigh(matrix)
    values[values < 4.0 * len(matrix) * np.finfo(np.float64).eps] = 0.0
    turned: Floats = np.linalg.qr((vectors * np.sqrt(np.maximum(values, 0.0))).T, mode="r")  # type: ignore[assignment]
    triangle = turned.T * np.where(np.diagonal(turned) < 0.0, -1.0, 1.0)
    return np.asarray(triangle / np.linalg.norm(triangle, axis=1, keepdims=True))
