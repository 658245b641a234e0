"""Trials of equal weight out of a proposal: each is kept with a probability in proportion to its weight.

The kept ones are then independent, and spread as the trials that plain rejection accepts: this is rejection, out of a
better envelope. How high the envelope must be, the largest weights among the trials say (as in empirical supremum
rejection sampling: Caffo, Booth & Davis 2002): where it grows, those kept before are thinned, each by the number in
[0, 1) that it was kept by. A few trials above the envelope stand more than once: see `proposal`.

When there are enough depends on the weights met so far: where heavy ones have not come yet, there are enough too soon,
and the trials lack what weighs much. So more are drawn after that, how many being fixed before: the trials are the
last ones, and the probability of acceptance comes from these draws alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.rare.learning import Round, Say
from xlmc.montecarlo.rare.proposal import Proposal, copies, height
from xlmc.montecarlo.statistics import Estimate
from xlmc.montecarlo.statistics.estimate import with_relative_error

__all__ = ["BATCH", "Accepts", "Resampled", "resample"]

Floats = NDArray[np.float64]

Accepts = Callable[[Floats], NDArray[np.bool_]]
"""Takes (n, d) points, says which are accepted."""

BATCH: Final = 32_768

_FRESH: Final = 32 * BATCH
"""Proposals at most that the probability of acceptance comes from."""

_FEWEST: Final = 100
"""Accepted ones among them, at least, as far as that many proposals have so many."""

_PATIENCE: Final = 1 << 23
"""Proposals after which it counts whether there will ever be enough."""

_SURPRISE: Final = math.log(30.0)
"""How much the envelope may grow, as a logarithm, before the proposal must be learned again."""


@dataclass(frozen=True, slots=True, eq=False)
class Resampled:
    """Trials of equal weight.

    Attributes:
        points: (m, d); those that stand more than once follow each other.
        size: (Σc)²/Σc², c the copies of each: their effective sample size.
        proposals: trials drawn.
        accepted: of them, by the filters.
        fresh: of them, those drawn after there were enough; `acceptance` comes from these, if any are accepted.
        acceptance: the probability that a trial is accepted.
        effective: (Σw)²/Σw² of the accepted ones among these, or less where the populations know of heavier ones.
        surprise: where a trial was much heavier than any known before, the batch that it was in, to learn from.
    """

    points: Floats
    size: float
    proposals: int
    accepted: int
    fresh: int
    acceptance: Estimate
    effective: float
    surprise: Round | None = None


def resample(
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
) -> Resampled:
    """Draw from the proposal until `wanted` trials are kept, and then as many again, or until `most` are drawn.

    Args:
        accepts: which points are accepted.
        proposal: to draw from.
        lowest: logarithm of the envelope's height, as far as it is known.
        unevenness: logarithm of the mean weight of accepted trials, as the populations know it; -inf if they do not.
        wanted: trials.
        most: proposals, rounded up to whole batches.
        random: where the trials come from; it must not have served to learn the proposal.
        say: called with the proposals so far.
        surprises: whether to stop where the envelope must be much higher than `lowest`.
    """
    drawing = _Drawing(accepts, proposal, random, wanted, lowest, lowest + _SURPRISE if surprises else math.inf)
    until_enough, fresh = _Sums(lowest, unevenness), _Sums(lowest, unevenness)

    def more(sums: _Sums) -> bool:
        """Whether another batch was drawn and is no surprise."""
        if drawing.surprise is not None or until_enough.proposals + fresh.proposals >= most:
            return False
        sums.add(drawing.batch())
        say(until_enough.proposals + fresh.proposals)
        return True

    while not drawing.enough and not drawing.hopeless(until_enough.proposals, most) and more(until_enough):
        pass
    if not drawing.enough and drawing.surprise is None:
        most = until_enough.proposals  # there will not be enough, and more would not change that
    planned = min(until_enough.for_accepted(_FEWEST), _FRESH)
    if planned > most - until_enough.proposals:
        planned = 0
    while fresh.proposals < planned and more(fresh):
        pass
    while not drawing.enough and more(until_enough):  # a heavy one among the last has thinned them
        pass
    of = fresh if fresh.accepted else until_enough
    points = drawing.trials()
    return Resampled(
        points=points,
        size=float(len(points) ** 2 / np.sum(np.square(_runs(points)))) if len(points) else 0.0,
        proposals=until_enough.proposals + fresh.proposals,
        accepted=until_enough.accepted + fresh.accepted,
        fresh=fresh.proposals,
        acceptance=of.acceptance,
        effective=of.effective,
        surprise=drawing.surprise,
    )


def _runs(points: Floats) -> NDArray[np.int64]:
    """How often each of the points stands; they follow each other."""
    new = np.append(True, np.any(points[1:] != points[:-1], axis=1))
    return np.diff(np.append(np.flatnonzero(new), len(points)))


class _Drawing:
    """Batches of proposals, and the trials that are kept of them so far.

    Attributes:
        surprise: the batch that a trial above `bar` was in.
    """

    def __init__(
        self,
        accepts: Accepts,
        proposal: Proposal,
        random: np.random.Generator,
        wanted: int,
        lowest: float,
        bar: float,
    ) -> None:
        self._accepts, self._proposal, self._random = accepts, proposal, random
        self._wanted, self._envelope, self._bar = wanted, lowest, bar
        self._accepted = _Accepted(np.empty((0, len(proposal.basis))), np.empty(0), np.empty(0))
        self.surprise: Round | None = None

    @property
    def enough(self) -> bool:
        """Whether as many are kept as are wanted."""
        return bool(self._accepted.copies(self._envelope).sum() >= self._wanted)

    def hopeless(self, proposals: int, most: int) -> bool:
        """Whether so many proposals say that not half of what is wanted will be kept of the most there may be."""
        expected = float(self._accepted.copies(self._envelope).sum())
        return proposals >= _PATIENCE and 2.0 * expected * most < self._wanted * proposals

    def batch(self) -> Floats:
        """(m,) logarithms of the weights of the accepted ones among another batch."""
        points, luck = self._proposal.draw(BATCH, self._random), self._random.random(BATCH)
        indices = np.flatnonzero(self._accepts(points))
        logs = self._proposal.log_weights(points[indices])
        self._accepted = self._accepted.joined(points[indices], logs, luck[indices])
        self._envelope = height(self._accepted.logs, self._wanted, self._envelope)
        if self._envelope > self._bar:
            self.surprise = Round(self._proposal, BATCH, points[indices], logs)
        self._accepted = self._accepted.under(self._envelope)
        return logs

    def trials(self) -> Floats:
        """Return the last `wanted` points of equal weight, or what there is of them."""
        repeated = np.repeat(np.arange(len(self._accepted.points)), self._accepted.copies(self._envelope))
        return self._accepted.points[repeated[-self._wanted :]]


@dataclass(frozen=True, slots=True, eq=False)
class _Accepted:
    """Points (m, d) with the logarithms of their weights, (m,), and the luck, (m,), that they are kept by."""

    points: Floats
    logs: Floats
    luck: Floats

    def joined(self, points: Floats, logs: Floats, luck: Floats) -> _Accepted:
        parts = ((self.points, points), (self.logs, logs), (self.luck, luck))
        return _Accepted(*(np.concatenate(part) for part in parts))

    def copies(self, envelope: float) -> NDArray[np.int64]:
        return copies(self.logs, self.luck, envelope)

    def under(self, envelope: float) -> _Accepted:
        """Return the trials that are left under an envelope, and under any higher one among them."""
        inside = self.luck < np.exp(self.logs - envelope)
        return _Accepted(self.points[inside], self.logs[inside], self.luck[inside])


class _Sums:
    """Sums of weights over proposals.

    Args:
        unit: the logarithm of a weight near the largest, which they are counted in.
        unevenness: see `resampled`.
    """

    def __init__(self, unit: float, unevenness: float) -> None:
        self._unit, self._uneven = unit, math.exp(unevenness - unit)
        self.proposals = self.accepted = 0
        self._first = self._second = 0.0

    def add(self, logs: Floats) -> None:
        """Return the accepted ones of another batch."""
        weights = np.exp(logs - self._unit)
        self.proposals += BATCH
        self.accepted += weights.size
        self._first += float(weights.sum())
        self._second += float(np.square(weights).sum())

    def for_accepted(self, fewest: int) -> int:
        """Return the number of further proposals: as many again, or so many that `fewest` can be expected to be
        accepted.
        """
        return max(self.proposals, -(-self.proposals * fewest // max(self.accepted, 1)))

    @property
    def _square(self) -> float:
        """The sum of squares. That of few weights lacks the largest, rarest ones; the populations have met these."""
        return max(self._second, self._first * self._uneven)

    @property
    def effective(self) -> float:
        """(Σw)²/Σw²."""
        return self._first**2 / self._square if self._first else 0.0

    @property
    def acceptance(self) -> Estimate:
        """The mean weight of all proposals, those rejected having none; its interval is one of the logarithm."""
        if not self.accepted:
            return Estimate(0.0, n=self.proposals)
        mean = self._first / self.proposals
        variance = (self._square / self.proposals - mean**2) / (self.proposals - 1)
        unit = math.exp(self._unit)
        error = unit * math.sqrt(max(variance, 0.0))
        return with_relative_error(unit * mean, error, self.effective - 1.0, 0.95, self.proposals)
