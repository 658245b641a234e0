"""Mixtures of normal distributions: their density and draws from them.

Sums over many points are `einsum`s: a matrix product may have other last bits with another number of threads.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Mixture", "standard_log_density"]

Floats = NDArray[np.float64]

_LOG_2_PI = math.log(2.0 * math.pi)


@dataclass(frozen=True, slots=True, eq=False)
class Mixture:
    """K normal components in r dimensions.

    Attributes:
        shares: (K,) probabilities that sum to 1.
        means: (K, r).
        roots: (K, r, r) lower triangles; component k has the covariance roots[k] @ roots[k].T.
    """

    shares: Floats
    means: Floats
    roots: Floats

    def log_parts(self, points: Floats) -> Floats:
        """(K, n) of every component at (n, r) points: the logarithm of its share times its density."""
        found = np.empty((self.shares.size, len(points)))
        for k, (share, mean, root) in enumerate(zip(self.shares, self.means, self.roots, strict=True)):
            apart = np.einsum("rq,nq->rn", np.linalg.inv(root), points - mean)
            scale = math.log(share) - float(np.log(np.diagonal(root)).sum()) - 0.5 * _LOG_2_PI * mean.size
            found[k] = scale - 0.5 * np.einsum("rn,rn->n", apart, apart)
        return found

    def log_density(self, points: Floats) -> Floats:
        """(n,) at (n, r) points."""
        return log_sum(self.log_parts(points))

    def draw(self, count: int, random: np.random.Generator) -> Floats:
        """(count, r) independent points."""
        component = np.searchsorted(np.cumsum(self.shares)[:-1], random.random(count), side="right")
        normal = random.standard_normal((count, self.means.shape[1]))
        found = np.empty_like(normal)
        for k, (mean, root) in enumerate(zip(self.means, self.roots, strict=True)):
            here = component == k
            found[here] = mean + np.einsum("nr,qr->nq", normal[here], root)
        return found


def log_sum(logs: Floats) -> Floats:
    """(n,) the logarithm of the sum of the exponentials of (K, n)."""
    largest = logs.max(axis=0)
    return np.asarray(largest + np.log(np.exp(logs - largest).sum(axis=0)))


def standard_log_density(points: Floats) -> Floats:
    """(n,) of independent standard normals at (n, r) points."""
    return np.asarray(-0.5 * (np.einsum("nr,nr->n", points, points) + points.shape[1] * _LOG_2_PI))
