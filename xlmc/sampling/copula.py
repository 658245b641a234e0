"""Rank correlation by a Gaussian copula: uniforms in, uniforms out, trial by trial."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["GaussianCopula"]

_HALF_STEP = 2.0**-54


class GaussianCopula:
    """Joins k uniforms so that their Spearman correlations are those of `spearman`.

    The first keeps its own draws; each other mixes its own with those before it.

    Args:
        spearman: the target matrix `(k, k)`, symmetric with a diagonal of 1.

    Raises:
        ValueError: no joint distribution has these correlations: the matrix is not positive definite.

    Source: Pearson correlation of the normals ρ = 2 sin(π r_s / 6) (Kruskal 1958), which is exact.
    """

    def __init__(self, spearman: NDArray[np.float64]) -> None:
        pearson = 2 * np.sin(np.pi / 6 * spearman)
        np.fill_diagonal(pearson, 1.0)
        try:
            self._mix = np.linalg.cholesky(pearson)
        except np.linalg.LinAlgError:
            raise ValueError("these correlations contradict each other") from None

    def join(self, u: NDArray[np.float64]) -> None:
        """Replace the rows of `u` (k, n), independent uniforms in [0, 1), by joined ones."""
        from scipy.special import ndtr, ndtri

        z = ndtri(np.maximum(u, _HALF_STEP))
        for i in range(len(u) - 1, 0, -1):  # each row needs only itself and the rows above it
            joined = self._mix[i, 0] * z[0]
            for j in range(1, i + 1):
                joined += self._mix[i, j] * z[j]
            u[i] = np.minimum(ndtr(joined), 1 - 2.0**-53)
