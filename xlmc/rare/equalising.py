"""Trials of equal weight out of a proposal: each is kept with a probability in proportion to its weight.

The kept ones are then independent, and spread as the trials that plain rejection accepts: this is rejection, out of a
better envelope. How high the envelope must be, the largest weights among the trials say (as in empirical supremum
rejection sampling: Caffo, Booth & Davis 2002): where it grows, those kept before are thinned, each by the number in
[0, 1) that it was kept by. A few trials above the envelope stand more than once: see `envelope`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.rare.envelope import copies, height
from xlmc.rare.learning import Round, Say
from xlmc.rare.proposal import Proposal
from xlmc.statistics import Estimate
from xlmc.statistics.estimate import with_relative_error

__all__ = ["BATCH", "Accepts", "Equalised", "equalised"]

Floats = NDArray[np.float64]

Accepts = Callable[[Floats], NDArray[np.bool_]]
"""Takes (n, d) points, says which are accepted."""

BATCH: Final = 32_768

_SURPRISE: Final = math.log(30.0)
"""By how much the envelope may grow, as a logarithm, before the proposal is to be learnt anew."""


@dataclass(frozen=True, slots=True, eq=False)
class Equalised:
    """Trials of equal weight.

    Attributes:
        points: (m, d); those that stand more than once follow each other.
        size: (Σc)²/Σc², c the copies of each: their effective sample size.
        proposals: trials drawn.
        accepted: of them, by the filters.
        acceptance: the probability that a trial is accepted.
        effective: (Σw)²/Σw² of the accepted proposals, from which `acceptance` comes, or less where the populations
            know of heavier ones.
        surprise: where a trial was much heavier than any known before, the batch that it was in, to learn from.
    """

    points: Floats
    size: float
    proposals: int
    accepted: int
    acceptance: Estimate
    effective: float
    surprise: Round | None = None


def equalised(
    accepts: Accepts,
    proposal: Proposal,
    lowest: float,
    unevenness: float,
    wanted: int,
    most: int,
    random: np.random.Generator,
    say: Say = lambda _: None,
    *,
    surprises: bool = True,
) -> Equalised:
    """Draw from the proposal until `wanted` trials are kept, or `most` are drawn.

    Args:
        accepts: which points are accepted.
        proposal: to draw from.
        lowest: logarithm of the envelope's height, as far as it is known.
        unevenness: logarithm of the mean weight of accepted trials, as the populations know it; -inf if they do not.
        wanted: trials.
        most: proposals, rounded up to whole batches.
        random: where the trials come from; it must not have served to learn the proposal.
        say: told of the proposals so far.
        surprises: whether to stop where the envelope must be much higher than `lowest`.
    """
    sums, envelope = _Sums(lowest, unevenness), lowest
    bar = lowest + _SURPRISE if surprises else math.inf
    kept = _Kept(np.empty((0, len(proposal.basis))), np.empty(0), np.empty(0))
    while kept.copies(envelope).sum() < wanted and sums.proposals < most:
        points, luck = proposal.draw(BATCH, random), random.random(BATCH)
        places = np.flatnonzero(accepts(points))
        logs = proposal.log_weights(points[places])
        kept = kept.joined(points[places], logs, luck[places])
        envelope = height(kept.logs, wanted, envelope)
        if envelope > bar:
            return sums.equalised(kept, envelope, wanted, Round(proposal, BATCH, points[places], logs))
        kept = kept.under(envelope)
        sums.add(logs)
        say(sums.proposals)
    return sums.equalised(kept, envelope, wanted, None)


@dataclass(frozen=True, slots=True, eq=False)
class _Kept:
    """Points (m, d) with the logarithms of their weights, (m,), and the luck, (m,), that they are kept by."""

    points: Floats
    logs: Floats
    luck: Floats

    def joined(self, points: Floats, logs: Floats, luck: Floats) -> _Kept:
        parts = ((self.points, points), (self.logs, logs), (self.luck, luck))
        return _Kept(*(np.concatenate(part) for part in parts))

    def copies(self, envelope: float) -> NDArray[np.int64]:
        return copies(self.logs, self.luck, envelope)

    def under(self, envelope: float) -> _Kept:
        """Those that are left under an envelope, and under any higher one among them."""
        inside = self.luck < np.exp(self.logs - envelope)
        return _Kept(self.points[inside], self.logs[inside], self.luck[inside])


class _Sums:
    """Sums of weights over proposals.

    Args:
        unit: the logarithm of a weight near the largest, which they are counted in.
        unevenness: see `equalised`.
    """

    def __init__(self, unit: float, unevenness: float) -> None:
        self._unit, self._uneven = unit, math.exp(unevenness - unit)
        self.proposals = self.accepted = 0
        self._first = self._second = 0.0

    def add(self, logs: Floats) -> None:
        """The accepted ones of another batch."""
        weights = np.exp(logs - self._unit)
        self.proposals += BATCH
        self.accepted += weights.size
        self._first += float(weights.sum())
        self._second += float(np.square(weights).sum())

    def equalised(self, kept: _Kept, envelope: float, wanted: int, surprise: Round | None) -> Equalised:
        # The mean square of few weights lacks the largest, which are rarest; the populations have met these too.
        square = max(self._second, self._first * self._uneven)
        effective = self._first**2 / square if square else 0.0
        places = np.repeat(np.arange(len(kept.points)), kept.copies(envelope))[:wanted]
        counts = np.bincount(places).astype(np.float64)
        return Equalised(
            kept.points[places],
            float(places.size**2 / np.sum(counts * counts)) if places.size else 0.0,
            self.proposals,
            self.accepted,
            self._acceptance(square, effective),
            effective,
            surprise,
        )

    def _acceptance(self, square: float, effective: float) -> Estimate:
        """The mean weight of all proposals, those rejected having none; its interval is one of the logarithm."""
        if not self.accepted:
            return Estimate(0.0, n=self.proposals)
        mean = self._first / self.proposals
        variance = (square / self.proposals - mean**2) / (self.proposals - 1)
        unit = math.exp(self._unit)
        return with_relative_error(
            unit * mean, unit * math.sqrt(max(variance, 0.0)), effective - 1.0, 0.95, self.proposals
        )
