"""Trials of equal weight out of a proposal: each is kept with the probability that its weight has of the largest.

The kept ones are then independent, and spread as the trials that plain rejection accepts: this is rejection, out of a
better envelope. How high the envelope must be, the largest weight among all trials says (empirical supremum rejection
sampling: Caffo, Booth & Davis 2002): where it grows, those kept before are thinned, each by the number in [0, 1) that
it was kept by.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.rare.learning import Round, Say
from xlmc.rare.proposal import Proposal
from xlmc.rare.splitting import Distance
from xlmc.statistics import Estimate
from xlmc.statistics.estimate import with_relative_error

__all__ = ["Equalised", "equalised"]

Floats = NDArray[np.float64]

BATCH: Final = 32_768

_SURPRISE: Final = math.log(50.0)
"""By how much the envelope may grow, as a logarithm, before the proposal is to be learnt anew."""


@dataclass(frozen=True, slots=True, eq=False)
class Equalised:
    """Trials of equal weight.

    Attributes:
        points: (m, d).
        places: (m,) of them among the proposals, counted from 0.
        proposals: trials drawn.
        accepted: of them, by the filters.
        acceptance: the probability that a trial is accepted.
        effective: (Σw)²/Σw² of the accepted proposals: how many equal trials know a mean as well.
        surprise: where a trial was much heavier than any known before, the batch that it was in, to learn from.
    """

    points: Floats
    places: NDArray[np.int64]
    proposals: int
    accepted: int
    acceptance: Estimate
    effective: float
    surprise: Round | None = None


def equalised(
    distance: Distance,
    proposal: Proposal,
    highest: float,
    wanted: int,
    most: int,
    random: np.random.Generator,
    say: Say = lambda _: None,
    *,
    surprises: bool = True,
) -> Equalised:
    """Draw from the proposal until `wanted` trials are kept, or `most` are drawn.

    Args:
        distance: 0 where a point is accepted.
        proposal: to draw from.
        highest: logarithm of the largest weight known.
        wanted: trials.
        most: proposals, rounded up to whole batches.
        random: where the trials come from; it must not have served to learn the proposal.
        say: told of the proposals so far.
        surprises: whether to stop at a trial that is much heavier than `highest`.
    """
    sums, bar = _Sums(highest), highest + (_SURPRISE if surprises else math.inf)
    kept = _Kept(np.empty((0, len(proposal.basis))), np.empty(0), np.empty(0, np.int64))
    while len(kept.points) < wanted and sums.proposals < most:
        points, luck = proposal.draw(BATCH, random), random.random(BATCH)
        places = np.flatnonzero(distance(points) == 0.0)
        logs = proposal.log_weights(points[places])
        highest = max(highest, float(logs.max(initial=-math.inf)))
        if highest > bar:
            return sums.equalised(kept, wanted, Round(proposal, BATCH, points[places], logs))
        scores = logs - np.log1p(-luck[places])  # kept where luck < weight / largest weight
        kept = kept.joined(points[places], scores, places + sums.proposals).above(highest)
        sums.add(logs)
        say(sums.proposals)
    return sums.equalised(kept, wanted, None)


@dataclass(frozen=True, slots=True, eq=False)
class _Kept:
    """Points (m, d), the logarithms of the envelopes they are kept under, (m,), and their places among proposals."""

    points: Floats
    scores: Floats
    places: NDArray[np.int64]

    def joined(self, points: Floats, scores: Floats, places: NDArray[np.int64]) -> _Kept:
        return _Kept(
            np.concatenate([self.points, points]),
            np.concatenate([self.scores, scores]),
            np.concatenate([self.places, places]),
        )

    def above(self, highest: float) -> _Kept:
        inside = self.scores >= highest
        return _Kept(self.points[inside], self.scores[inside], self.places[inside])


class _Sums:
    """Sums of weights over proposals.

    Args:
        unit: the logarithm of a weight near the largest, which they are counted in.
    """

    def __init__(self, unit: float) -> None:
        self._unit = unit
        self.proposals = self.accepted = 0
        self._first = self._second = 0.0

    def add(self, logs: Floats) -> None:
        """The accepted ones of another batch."""
        weights = np.exp(logs - self._unit)
        self.proposals += BATCH
        self.accepted += weights.size
        self._first += float(weights.sum())
        self._second += float(np.square(weights).sum())

    def equalised(self, kept: _Kept, wanted: int, surprise: Round | None) -> Equalised:
        effective = self._first**2 / self._second if self._second else 0.0
        return Equalised(
            kept.points[:wanted],
            kept.places[:wanted],
            self.proposals,
            self.accepted,
            self._acceptance(effective),
            effective,
            surprise,
        )

    def _acceptance(self, effective: float) -> Estimate:
        """The mean weight of all proposals, those rejected having none; its interval is one of the logarithm."""
        if not self.accepted:
            return Estimate(0.0, n=self.proposals)
        mean = self._first / self.proposals
        variance = (self._second / self.proposals - mean**2) / (self.proposals - 1)
        unit = math.exp(self._unit)
        return with_relative_error(
            unit * mean, unit * math.sqrt(max(variance, 0.0)), effective - 1.0, 0.95, self.proposals
        )
