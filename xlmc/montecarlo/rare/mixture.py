"""Mixtures of normal distributions: their density, draws from them, and how one is fitted to weighted points.

Sums over many points are `einsum`s: a matrix product may have other last bits with another number of threads.

**Fit.** Expectation and maximisation (Dempster, Laird & Rubin 1977). How many components there are, points that were
left out of the fit decide: those of the mixture that gives them the highest likelihood.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["Mixture", "fit_mixture", "standard_log_density"]

Floats = NDArray[np.float64]

_LOG_2_PI = math.log(2.0 * math.pi)

_COMPONENTS: Final = (1, 2, 4, 8, 16)

_ROUNDS: Final = 12

_COMPARED: Final = 4_096
"""Points that numbers of components are compared on."""

_GAIN: Final = 0.01
"""What one more step of components must add to the mean log-likelihood: a hundredth of the trials."""

_DECIMALS: Final = 9
"""Digits that are kept of what was fitted: matrix products may give other last bits with more threads."""


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
        values = np.empty((self.shares.size, len(points)))
        for k, (share, mean, root) in enumerate(zip(self.shares, self.means, self.roots, strict=True)):
            apart = np.einsum("rq,nq->rn", np.linalg.inv(root), points - mean)
            scale = math.log(share) - float(np.log(np.diagonal(root)).sum()) - 0.5 * _LOG_2_PI * mean.size
            values[k] = scale - 0.5 * np.einsum("rn,rn->n", apart, apart)
        return values

    def log_density(self, points: Floats) -> Floats:
        """(n,) at (n, r) points."""
        return log_sum(self.log_parts(points))

    def draw(self, count: int, random: np.random.Generator) -> Floats:
        """(count, r) independent points."""
        component = np.searchsorted(np.cumsum(self.shares)[:-1], random.random(count), side="right")
        normal = random.standard_normal((count, self.means.shape[1]))
        values = np.empty_like(normal)
        for k, (mean, root) in enumerate(zip(self.means, self.roots, strict=True)):
            here = component == k
            values[here] = mean + np.einsum("nr,qr->nq", normal[here], root)
        return values


def log_sum(logs: Floats) -> Floats:
    """(n,) the logarithm of the sum of the exponentials of (K, n)."""
    largest = logs.max(axis=0)
    return np.asarray(largest + np.log(np.exp(logs - largest).sum(axis=0)))


def standard_log_density(points: Floats) -> Floats:
    """(n,) of independent standard normals at (n, r) points."""
    return np.asarray(-0.5 * (np.einsum("nr,nr->n", points, points) + points.shape[1] * _LOG_2_PI))


def fit_mixture(points: Floats, weights: Floats, random: np.random.Generator) -> Mixture:
    """Fit the mixture that describes (n, r) points with (n,) weights best, of 1 to 16 components.

    Every second point is left out of the choice of the number of components, and judges it. They are
    fitted in coordinates in which their mean is 0 and their covariance 1, so that a thin layer is not thin there.
    """
    shares = weights / weights.sum()
    centre = np.einsum("n,nr->r", shares, points)
    apart = points - centre
    root = np.linalg.cholesky(np.einsum("n,nr,nq->rq", shares, apart, apart))
    scaled = np.einsum("rq,nq->nr", np.linalg.inv(root), apart)
    mixture = _rounded(_fit(scaled, weights, _components(scaled, weights, random), random))
    return Mixture(mixture.shares, centre + mixture.means @ root.T, root @ mixture.roots)


def _components(points: Floats, weights: Floats, random: np.random.Generator) -> int:
    best, number = -np.inf, 1
    points, weights = points[:_COMPARED], weights[:_COMPARED]
    for components in _COMPONENTS:
        if components > 1 and components * (points.shape[1] + 2) * 10 > len(points):
            break
        tried = _fit(points[::2], weights[::2], components, random)
        value = float(np.sum(weights[1::2] * tried.log_density(points[1::2])) / weights[1::2].sum())
        if value > best + _GAIN:
            best, number = value, components
        elif components > 2 * number:
            break
    return number


def _fit(points: Floats, weights: Floats, components: int, random: np.random.Generator) -> Mixture:
    shares = weights / weights.sum()
    size = float(1.0 / np.sum(shares * shares))
    mixture = _maximised(points, shares * _nearest(points, _seeds(points, shares, components, random)), size)
    if components == 1:
        return mixture
    for _ in range(_ROUNDS):
        logs = mixture.log_parts(points)
        mixture = _maximised(points, shares * np.exp(logs - log_sum(logs)), size)
    return mixture


def _seeds(points: Floats, shares: Floats, components: int, random: np.random.Generator) -> Floats:
    """Points far from each other (Arthur & Vassilvitskii 2007, k-means++)."""
    seeds = [points[_chosen(shares, random)]]
    distance = np.full(len(points), np.inf)
    while len(seeds) < components:
        distance = np.minimum(distance, np.square(points - seeds[-1]).sum(axis=1))
        seeds.append(points[_chosen(shares * distance, random)])
    return np.array(seeds)


def _chosen(amounts: Floats, random: np.random.Generator) -> int:
    reached = np.cumsum(amounts)
    return min(int(np.searchsorted(reached, random.random() * reached[-1], side="right")), amounts.size - 1)


def _nearest(points: Floats, seeds: Floats) -> Floats:
    """(K, n) 1 for the nearest seed of each point, else 0."""
    apart = np.stack([np.square(points - seed).sum(axis=1) for seed in seeds])
    return np.asarray(np.arange(len(seeds))[:, None] == apart.argmin(axis=0), dtype=np.float64)


def _maximised(points: Floats, parts: Floats, size: float) -> Mixture:
    """Return the components that have these parts (K, n) of the points.

    Each is given r + 2 points more, with the spread of all narrowed as far as K components fill the space: a component
    of few points does not shrink to them.
    """
    dimensions = points.shape[1]
    totals = np.maximum(parts.sum(axis=1), 1e-12)
    means = np.einsum("kn,nr->kr", parts, points) / totals[:, None]
    pulled = (dimensions + 2.0) / size
    own = pulled * len(parts) ** (-2.0 / dimensions) * np.eye(dimensions)
    roots = np.empty((len(parts), dimensions, dimensions))
    for k, part in enumerate(parts):
        apart = points - means[k]
        spread = np.einsum("nr,nq->rq", apart * part[:, None], apart)
        roots[k] = np.linalg.cholesky((spread + own) / (totals[k] + pulled))
    return Mixture(totals / totals.sum(), means, roots)


def _rounded(mixture: Mixture) -> Mixture:
    shares = np.maximum(np.round(mixture.shares, _DECIMALS), 10.0**-_DECIMALS)
    return Mixture(shares / shares.sum(), np.round(mixture.means, _DECIMALS), np.round(mixture.roots, _DECIMALS))
