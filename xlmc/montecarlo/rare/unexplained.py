"""Judge the accepted trials of another origin than the search: does it leave some of them unexplained?

Plain trials, and those from widened assumptions, come to every part of the accepted region with a chance that is known:
each has a weight, how much likelier it is as a plain trial than as one of these, and the weighted share of accepted
ones estimates their probability whatever was found before (a defensive mixture: Hesterberg 1995; Owen & Zhou 2000).

One that a learned proposal hardly ever draws is *unexplained*: its weight is far above those of the points that the
search knows. Unexplained trials that stand for more than a small share of the probability of acceptance say that a part
is missing, and where.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.rare.mixture import log_sum

__all__ = [
    "Evidence",
    "Source",
    "Tempered",
    "find_unexplained",
    "join_evidence",
    "plain_assumptions",
    "pool",
    "wide_assumptions",
]

Floats = NDArray[np.float64]

_FAR: Final = math.log(30.0)
"""How much heavier than the heaviest usual points an unexplained trial is, as a logarithm."""

_USUAL: Final = 0.999
"""The share of what the search found whose weights are usual."""

_SMALL: Final = 0.01
"""The share of the probability of acceptance that unexplained trials may stand for: tails are no missing parts."""

_ALL: Final = (1.5, 2.0, 3.0, 4.0)
"""Spreads of all assumptions together, as far as the largest weights stay moderate."""

_ONE: Final = 4.0
"""The spread of one assumption alone, the others being as they are."""

_LARGEST: Final = 64.0
"""The largest ratio of densities at the median that the spread of all assumptions together may have."""


class Source(Protocol):
    """What trials are drawn from."""

    def log_weights(self, points: Floats) -> Floats:
        """(n,) the logarithm of how much likelier (n, d) points are as plain trials."""


class Drawn(Protocol):
    """Trials from a source, with the points of those that were accepted."""

    @property
    def proposal(self) -> Source: ...

    @property
    def trials(self) -> int: ...

    @property
    def points(self) -> Floats: ...


@dataclass(frozen=True, slots=True, eq=False)
class Evidence:
    """Trials whose origin has nothing to do with what was learned.

    Attributes:
        proposal: what they were drawn from.
        trials: how many.
        points: (k, d) the accepted ones, or some of them.
        logs: (k,) logarithms of their weights.
    """

    proposal: Source
    trials: int
    points: Floats
    logs: Floats

    @classmethod
    def of(cls, proposal: Source, trials: int, points: Floats) -> Evidence:
        """Weigh the trials by the proposal."""
        return cls(proposal, trials, points, proposal.log_weights(points))

    @property
    def mass(self) -> float:
        """The probability that the points stand for."""
        return float(np.exp(self.logs).sum()) / self.trials

    def tells(self, probability: float) -> bool:
        """Whether they stand for more than a small share of a probability."""
        return self.mass > _SMALL * probability

    @property
    def log_mass(self) -> float:
        """The logarithm of the probability that the points stand for."""
        return float(log_sum(self.logs[:, None])[0]) - math.log(self.trials)

    @property
    def shares(self) -> Floats:
        """(k,) of that probability, which sum to 1."""
        weights = np.exp(self.logs - self.logs.max())
        return np.asarray(weights / weights.sum())


def pool(drawn: Sequence[Drawn]) -> tuple[Floats, Floats]:
    """All accepted points, and the logarithms of their weights under all sources together."""
    points = np.concatenate([each.points for each in drawn])
    total = sum(each.trials for each in drawn)
    heights = [math.log(each.trials / total) - each.proposal.log_weights(points) for each in drawn]
    return points, -log_sum(np.stack(heights)) if len(points) else np.empty(0)


def join_evidence(known: Sequence[Evidence]) -> Evidence:
    """All of it as if drawn from one source."""
    points, logs = pool(known)
    return Evidence(known[0].proposal, sum(each.trials for each in known), points, logs)


def find_unexplained(proposal: Source, known: Sequence[Evidence], points: Floats, weights: Floats) -> Evidence:
    """Find the known accepted trials that a proposal hardly ever draws; there may be none.

    Args:
        proposal: that was learned.
        known: what is known beside.
        points: (n, d) that the search found, spread as accepted trials are.
        weights: (n,) of these.
    """
    every = join_evidence(known)
    if not len(every.points):
        return every
    far = proposal.log_weights(every.points) > _quantile(proposal.log_weights(points), weights, _USUAL) + _FAR
    return Evidence(every.proposal, every.trials, every.points[far], every.logs[far])


def _quantile(values: Floats, weights: Floats, share: float) -> float:
    order = np.argsort(values)
    reached = np.cumsum(weights[order])
    return float(values[order[min(int(np.searchsorted(reached, share * reached[-1])), values.size - 1)]])


@dataclass(frozen=True, slots=True, eq=False)
class Tempered:
    """A mixture of independent normals about 0, in d dimensions.

    Attributes:
        shares: (K,) of the components; they sum to 1.
        spreads: (K, d) their standard deviations.
    """

    shares: Floats
    spreads: Floats

    def draw(self, count: int, random: np.random.Generator) -> Floats:
        """(count, d) independent points."""
        component = np.searchsorted(np.cumsum(self.shares)[:-1], random.random(count), side="right")
        return np.asarray(self.spreads[component] * random.standard_normal((count, self.spreads.shape[1])))

    def log_weights(self, points: Floats) -> Floats:
        """(n,) the logarithm of how much likelier each of (n, d) points is as a plain trial than as one of these."""
        narrower = 0.5 * (1.0 - self.spreads**-2.0)
        logs = np.log(self.shares) - np.log(self.spreads).sum(axis=1)
        return -log_sum(logs[:, None] + np.einsum("kd,nd->kn", narrower, np.square(points)))


def plain_assumptions(dimensions: int) -> Tempered:
    """Plain trials."""
    return Tempered(np.ones(1), np.ones((1, dimensions)))


def wide_assumptions(dimensions: int) -> Tempered:
    """Spread assumptions wider: one in a third of the trials, all in a half; the rest stays as it is."""
    together = [spread for spread in _ALL if spread**dimensions <= _LARGEST] or [_LARGEST ** (1.0 / dimensions)]
    alone = np.where(np.eye(dimensions, dtype=bool), _ONE, 1.0)
    spreads = [np.ones((1, dimensions)), np.outer(together, np.ones(dimensions)), alone]
    shares = [[0.15], [0.5 / len(together)] * len(together), [0.35 / dimensions] * dimensions]
    return Tempered(np.concatenate(shares), np.concatenate(spreads))
