"""Where trials are proposed: a mixture of normals in the directions that matter, the assumptions as they are in others.

Trials that are accepted differ from all trials in some directions only. Those in which neither mean nor spread differ
are left alone, so that there may be many assumptions (Uribe, Papaioannou, Marzouk & Straub 2021).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.rare.expectation import fitted_mixture
from xlmc.rare.mixture import Mixture, standard_log_density

__all__ = ["Proposal", "proposed"]

Floats = NDArray[np.float64]

_FEW: Final = 12
"""Directions that are all taken: to choose among so few spares nothing."""

_DIFFERS: Final = 0.1
"""What a spread must differ by, of itself, to matter: less costs some 0.3 % of the trials a direction."""

_SHARES: Final = ((0.6, 1.0), (0.22, 1.7))
"""Of the proposals, from each fitted component with its covariance times so much."""

_WIDE, _PRIOR = 0.16, 0.02
"""Of the proposals, from components as wide as the assumptions themselves, and from the assumptions themselves. No
weight is above 1 over the last, and few above the typical one over the first (Hesterberg 1995; Owen & Zhou 2000)."""


@dataclass(frozen=True, slots=True, eq=False)
class Proposal:
    """Where trials are proposed, in d independent standard normals.

    Attributes:
        basis: (d, r) orthonormal directions that matter.
        mixture: the fitted one along them.
        defended: the one that is proposed from: the fitted one and what bounds the weights.
    """

    basis: Floats
    mixture: Mixture
    defended: Mixture

    def draw(self, count: int, random: np.random.Generator) -> Floats:
        """(count, d) independent proposals."""
        along = self.defended.draw(count, random)
        free = random.standard_normal((count, len(self.basis)))
        return np.asarray(free + np.einsum("nr,dr->nd", along - self._along(free), self.basis))

    def log_weights(self, points: Floats) -> Floats:
        """(n,) the logarithm of how much likelier each of (n, d) points is as a trial than as a proposal."""
        along = self._along(points)
        return standard_log_density(along) - self.defended.log_density(along)

    def _along(self, points: Floats) -> Floats:
        return np.asarray(np.einsum("nd,dr->nr", points, self.basis))


def proposed(points: Floats, weights: Floats, random: np.random.Generator) -> Proposal:
    """Fit to (n, d) accepted points with (n,) weights, in no order."""
    basis = _directions(points, weights)
    mixture = fitted_mixture(np.einsum("nd,dr->nr", points, basis), weights, random)
    return Proposal(basis, mixture, _defended(mixture))


def _directions(points: Floats, weights: Floats) -> Floats:
    """(d, r): the principal directions in which the spread about 0 is not 1."""
    dimensions = points.shape[1]
    if dimensions <= _FEW:
        return np.eye(dimensions)
    shares = weights / weights.sum()
    spreads, directions = np.linalg.eigh(np.einsum("nd,ne->de", points * shares[:, None], points))
    ratio = dimensions * float(np.sum(shares * shares)) * 4.0  # moved points count as a quarter of independent ones
    chance = 2.0 * ratio**0.5 + ratio  # the edge of Marchenko and Pastur
    wanted = np.abs(spreads - 1.0) > max(_DIFFERS, chance)
    wanted[np.argmax(np.abs(spreads - 1.0))] = True
    return np.asarray(np.linalg.qr(np.round(directions[:, wanted], 9))[0])


def _defended(mixture: Mixture) -> Mixture:
    dimensions = mixture.means.shape[1]
    shares = [share * mixture.shares for share, _ in _SHARES]
    roots = [factor**0.5 * mixture.roots for _, factor in _SHARES]
    wide = np.array([_widened(root) for root in mixture.roots])
    return Mixture(
        np.concatenate([*shares, _WIDE * mixture.shares, [_PRIOR]]),
        np.concatenate([*[mixture.means] * (len(_SHARES) + 1), np.zeros((1, dimensions))]),
        np.concatenate([*roots, wide, np.eye(dimensions)[None]]),
    )


def _widened(root: Floats) -> Floats:
    """The root of a covariance in whose principal directions no spread is below 1."""
    spreads, directions = np.linalg.eigh(root @ root.T)
    return np.asarray(np.linalg.cholesky((directions * np.maximum(spreads, 1.0)) @ directions.T))
