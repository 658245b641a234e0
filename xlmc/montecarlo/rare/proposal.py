"""The proposal, from which trials are drawn: a mixture of normals in the directions that matter, the assumptions as
they are in others.

Trials that are accepted differ from all trials in some directions only. Those in which neither mean nor spread differ
are left alone, so that there may be many assumptions (Uribe, Papaioannou, Marzouk & Straub 2021).

**Shear.** Filters that ask for narrow ranges leave a layer that is thin in some directions and bent along the others;
normal distributions are not bent. So a thin coordinate is taken less what a quadratic function of the others says of
it: the mixture describes how far trials are from a curved sheet. A shear leaves volumes as they are.

**Envelope.** A trial of weight w under an envelope of height h is kept with probability w/h: the kept ones are as good
as of equal weight. One above the envelope would have to be kept more than once: w/h times, on average. That is allowed
as far as copies cost 1 % of the effective sample size (Kish 1965): an envelope above all weights is several times to a
hundred times higher, and keeps so many trials less.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.rare.mixture import Mixture, fit_mixture, log_sum, standard_log_density

__all__ = ["COPIED", "Proposal", "Shear", "copies", "fit_proposal", "fit_shear", "height", "refit"]

Floats = NDArray[np.float64]

_FEW: Final = 12
"""Directions that are all taken: to choose among so few spares nothing."""

_DIFFERS: Final = 0.1
"""What a spread must differ by, of itself, to matter: less costs some 0.3 % of the trials a direction."""

_THIN: Final = 0.25
"""A variance below which a direction counts as thin: that of the assumptions is 1."""

_SHARES: Final = (
    ((0.61, 1.0, 1.0), (0.23, 1.7, 1.7)),
    ((0.44, 1.0, 1.0), (0.2, 1.7, 1.7), (0.2, 3.5, 3.5)),
    ((0.3, 1.0, 1.0), (0.18, 1.7, 1.7), (0.18, 3.5, 3.5), (0.18, 8.0, 8.0)),
    ((0.4, 1.0, 1.0), (0.24, 2.5, 1.2), (0.14, 6.0, 1.4), (0.06, 15.0, 1.7)),
    ((0.3, 1.0, 1.0), (0.22, 2.5, 1.3), (0.2, 6.0, 1.7), (0.12, 15.0, 2.5)),
)
"""Parts of the mixture from each fitted component with its covariance times so much, first in thin directions, then in
the others: the one of these is taken under which the accepted points weigh least, and so the weights of proposals vary
least. What a layer's bend leaves has longer tails than a normal distribution, and tails in all directions are dear."""

_WIDE: Final = 0.16
"""The part of the mixture from components as wide as the assumptions themselves, so that few weights are far above the
usual (Hesterberg 1995)."""

_PRIOR: Final = 0.02
"""The part of the proposals from the assumptions themselves: no weight is above the inverse of it (Owen & Zhou 2000).
"""

_POINTS_A_TERM: Final = 30

_DECIMALS: Final = 9

COPIED: Final = 0.01
"""The share by which Σc² may exceed Σc; c are the copies of each trial."""

_STEPS: Final = 50


@dataclass(frozen=True, slots=True, eq=False)
class Proposal:
    """The distribution from which trials are drawn, in d independent standard normals.

    Attributes:
        basis: (d, d) orthonormal directions: those that are thin, the others that matter, those that do not.
        shear: of the thin ones by all others.
        mixture: the fitted one, of what the shear leaves of the thin ones and of the others that matter, r in all.
        defended: the one that is proposed from: the fitted one and what bounds the weights.
    """

    basis: Floats
    shear: Shear
    mixture: Mixture
    defended: Mixture

    @property
    def directions(self) -> int:
        """r, how many matter."""
        return int(self.mixture.means.shape[1])

    def draw(self, count: int, random: np.random.Generator) -> Floats:
        """(count, d) independent proposals."""
        free = random.standard_normal((count, len(self.basis)))
        fitted = random.random(count) >= _PRIOR
        drawn = self.defended.draw(count, random)
        thin = self.shear.thin
        moved = free.copy()
        moved[:, thin : self.directions] = drawn[:, thin:]
        moved[:, :thin] = drawn[:, :thin] + self.shear.shift(moved[:, thin:])
        return np.asarray(np.einsum("nr,dr->nd", np.where(fitted[:, None], moved, free), self.basis))

    def log_weights(self, points: Floats) -> Floats:
        """(n,) the logarithm of how much likelier each of (n, d) points is as a trial than as a proposal."""
        along = np.einsum("nd,dr->nr", points, self.basis)
        thin, matter = self.shear.thin, self.directions
        prior = standard_log_density(along[:, :matter])
        along[:, :thin] -= self.shear.shift(along[:, thin:])
        mixture = self.defended.log_density(along[:, :matter])
        return np.asarray(-np.logaddexp(math.log1p(-_PRIOR) + mixture - prior, math.log(_PRIOR)))

    def unevenness(self, points: Floats, weights: Floats) -> float:
        """Return the logarithm of the mean weight that (n, d) accepted points with (n,) weights have as proposals.

        Over accepted trials, this mean is to the probability of acceptance as the mean square of proposals' weights is
        to the square of their mean: the least is the best, and points that proposals seldom reach count in full.
        """
        logs = self.log_weights(points) + np.log(weights / weights.sum())
        return float(log_sum(logs[:, None])[0])


def fit_proposal(points: Floats, weights: Floats, random: np.random.Generator) -> Proposal:
    """Fit to (n, d) accepted points with (n,) weights, in no order."""
    basis, thin, matter = _directions(points, weights)
    along = np.einsum("nd,dr->nr", points, basis)
    shear = fit_shear(along[:, :thin], along[:, thin:], weights)
    along[:, :thin] -= shear.shift(along[:, thin:])
    return _defended(Proposal(basis, shear, *[fit_mixture(along[:, :matter], weights, random)] * 2), points, weights)


def refit(proposal: Proposal, points: Floats, weights: Floats, random: np.random.Generator) -> Proposal:
    """Return the same coordinates with a mixture fitted to other points."""
    along = np.einsum("nd,dr->nr", points, proposal.basis)
    thin, matter = proposal.shear.thin, proposal.directions
    along[:, :thin] -= proposal.shear.shift(along[:, thin:])
    mixture = fit_mixture(along[:, :matter], weights, random)
    return _defended(Proposal(proposal.basis, proposal.shear, mixture, mixture), points, weights)


def _directions(points: Floats, weights: Floats) -> tuple[Floats, int, int]:
    """(d, d) directions; how many of the first are thin, and how many matter.

    Those that matter are the principal ones in which the spread about 0 is not 1; among them, the order is that of the
    spread about the mean.
    """
    shares = weights / weights.sum()
    matter, rest = _separate(points, shares)
    along = np.einsum("nd,dr->nr", points, matter)
    apart = along - np.einsum("n,nr->r", shares, along)
    spreads, turned = np.linalg.eigh(np.einsum("nr,nq->rq", apart * shares[:, None], apart))
    basis = np.concatenate([np.einsum("dr,rq->dq", matter, turned), rest], axis=1)
    thin = int(np.count_nonzero(spreads < _THIN))
    return np.linalg.qr(np.round(basis, 9))[0], min(thin, points.shape[1] - 1), matter.shape[1]


def _separate(points: Floats, shares: Floats) -> tuple[Floats, Floats]:
    """(d, r) directions that matter, and (d, d − r) that do not."""
    dimensions = points.shape[1]
    if dimensions <= _FEW:
        return np.eye(dimensions), np.empty((dimensions, 0))
    spreads, directions = np.linalg.eigh(np.einsum("nd,ne->de", points * shares[:, None], points))
    ratio = dimensions * float(np.sum(shares * shares)) * 4.0  # moved points count as a quarter of independent ones
    chance = 2.0 * ratio**0.5 + ratio  # the edge of Marchenko and Pastur
    matter = np.abs(spreads - 1.0) > max(_DIFFERS, chance)
    matter[np.argmax(np.abs(spreads - 1.0))] = True
    return directions[:, matter], directions[:, ~matter]


def _defended(proposal: Proposal, points: Floats, weights: Floats) -> Proposal:
    thin = proposal.shear.thin
    made = [replace(proposal, defended=_inflated(proposal.mixture, shares, thin)) for shares in _SHARES]
    return min(made, key=lambda each: each.unevenness(points, weights))


def _inflated(mixture: Mixture, wanted: Sequence[tuple[float, float, float]], thin: int) -> Mixture:
    shares = [share * mixture.shares for share, _, _ in wanted]
    count = mixture.means.shape[1]
    scales = [np.repeat([of_thin**0.5, of_others**0.5], [thin, count - thin]) for _, of_thin, of_others in wanted]
    wide = np.array([_widened(root) for root in mixture.roots])
    return Mixture(
        np.concatenate([*shares, _WIDE * mixture.shares]),
        np.concatenate([mixture.means] * (len(wanted) + 1)),
        np.concatenate([*(scale[:, None] * mixture.roots for scale in scales), wide]),
    )


def _widened(root: Floats) -> Floats:
    """Return the root of a covariance in whose principal directions no spread is below 1."""
    spreads, directions = np.linalg.eigh(root @ root.T)
    return np.asarray(np.linalg.cholesky((directions * np.maximum(spreads, 1.0)) @ directions.T))


@dataclass(frozen=True, slots=True, eq=False)
class Shear:
    """What a + b·x + x·C·x gives for each of (n, d) points, whose first t coordinates are the thin ones.

    Attributes:
        constant: (t,) a.
        linear: (t, d − t) b.
        quadratic: (t, d − t, d − t) C.
    """

    constant: Floats
    linear: Floats
    quadratic: Floats

    @property
    def thin(self) -> int:
        """How many are thin."""
        return self.constant.size

    def shift(self, others: Floats) -> Floats:
        """(n, t) what (n, d − t) other coordinates say of the thin ones."""
        values: Floats = self.constant + np.einsum("nk,tk->nt", others, self.linear)
        for index, square in enumerate(self.quadratic):
            values[:, index] += np.einsum("nk,nk->n", np.einsum("nj,jk->nk", others, square), others)
        return values


def fit_shear(thin: Floats, others: Floats, weights: Floats) -> Shear:
    """Fit the shear that leaves least of (n, t) thin coordinates, by least squares with (n,) weights.

    With few points for so many products of coordinates, squares alone are taken; with fewer still, nothing is moved.
    """
    count, width = others.shape[1], thin.shape[1]
    first, second = np.triu_indices(count)
    affordable = len(others) // _POINTS_A_TERM
    if 1 + count + first.size > affordable:
        first = second = np.arange(count)
    if not width or 1 + count + first.size > affordable:
        return Shear(np.zeros(width), np.zeros((width, count)), np.zeros((width, count, count)))
    terms = np.concatenate([np.ones((len(others), 1)), others, others[:, first] * others[:, second]], axis=1)
    roots = np.sqrt(weights / weights.mean())[:, None]
    solved = np.round(np.linalg.lstsq(terms * roots, thin * roots, rcond=1e-9)[0].T, _DECIMALS)
    quadratic = np.zeros((width, count, count))
    quadratic[:, first, second] = solved[:, 1 + count :]
    return Shear(solved[:, 0], solved[:, 1 : 1 + count], quadratic)


def height(logs: Floats, count: float | None = None, least: float = -math.inf) -> float:
    """Return the logarithm of the lowest envelope, from `least` on, that costs no more than that.

    Args:
        logs: (m,) logarithms of the weights; those below `least` may be missing.
        count: trials that will be kept in all; by default as many as the envelope keeps of these.
        least: from where on.
    """
    highest = float(logs.max(initial=-math.inf))
    if highest <= least or highest == -math.inf:
        return max(least, highest)
    low, high = max(least, highest - 50.0), highest
    if least > -math.inf and _fits(logs, low, count):
        return low
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if _fits(logs, middle, count) else (middle, high)
    return high


def _fits(logs: Floats, height_: float, count: float | None) -> bool:
    ratios = np.exp(logs - height_)
    above = ratios[ratios > 1.0]
    return float(np.sum(above * above - above)) <= COPIED * (float(ratios.sum()) if count is None else count)


def copies(logs: Floats, luck: Floats, height_: float) -> NDArray[np.int64]:
    """(m,) how often each trial is kept.

    That is its weight over the envelope, rounded down, or up where its luck, (m,) in [0, 1), is less than the rest.
    """
    ratios = np.exp(logs - height_)
    whole = np.floor(ratios)
    return np.asarray(whole + (luck < ratios - whole), dtype=np.int64)
