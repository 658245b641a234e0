"""Learning where accepted trials are: two populations find the region, then a proposal is fitted to it and improved.

Trials drawn from a proposal say how good it is, and all trials drawn so far, each weighted by how much likelier it is
as a trial than under all proposals together, make the next one (population Monte Carlo with mixture weights: Owen &
Zhou 2000; Cappé, Douc, Guillin, Marin & Robert 2008; Cornuet, Marin, Mira & Robert 2012).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.rare.proposal import Proposal, fit_proposal, height, refit
from xlmc.montecarlo.rare.splitting import EXPLORING, Descent, Distance, descend, explore
from xlmc.montecarlo.rare.unexplained import Evidence, find_unexplained, join_evidence, pool

__all__ = ["Learned", "Round", "Say", "count_on", "learn", "learn_again", "search_on"]

Floats = NDArray[np.float64]

_DESCENTS: Final = 2
"""Populations of each stratum."""

_POPULATION: Final = 4_096
"""Points of the populations, of all strata together, as long as each has some hundreds."""

_FIRST: Final = 65_536
"""Draws that they begin from, likewise."""

_TRIALS: Final = 32_768
_MOST_TRIALS: Final = 64 * _TRIALS
_ENOUGH: Final = 250
"""Trials of a round: `_TRIALS`, or more where fewer than `_ENOUGH` are accepted."""

_ROUNDS: Final = 5
_GOOD: Final = 0.1
"""Equal trials out of a proposal; with more, nothing is worth to be learnt."""

_GAIN: Final = 1.2
_FITTED: Final = 8_192
"""Points that a proposal is fitted to: more would take long, and not know it better."""

_TALLEST: Final = 30.0
"""Times the mean weight, at most, that a point has in a fit: one point must not be a component."""

_EXPLORED: Final = 3
"""Times that populations are made about accepted trials that the others did not come to."""

_FEWEST: Final = 100
"""Accepted points that a proposal can be fitted to."""

Say = Callable[[int], None]
"""Called with the number of evaluations so far."""


def count_on(before: int, say: Say) -> Say:
    """Make a `say` for evaluations that come after so many others."""
    return lambda count: say(before + count)


@dataclass(frozen=True, slots=True, eq=False)
class Round:
    """Trials drawn from a proposal.

    Attributes:
        proposal: drawn from.
        trials: how many.
        points: (m, d) the accepted ones.
        logs: (m,) logarithms of their weights.
    """

    proposal: Proposal
    trials: int
    points: Floats
    logs: Floats

    @property
    def rate(self) -> float:
        """Trials of equal weight that can be had out of one proposal."""
        return float(np.exp(self.logs - self.envelope).sum() / self.trials) if self.logs.size else 0.0

    @property
    def envelope(self) -> float:
        """The logarithm of the height of the envelope that its trials need."""
        return height(self.logs)


@dataclass(frozen=True, slots=True, eq=False)
class Learned:
    """What is known of the accepted region.

    Attributes:
        descents: the populations, two and two of the same stratum.
        rounds: in the order they were made; none where no population reached the region.
        known: trials that nothing was learned for, with those of them that were accepted.
        evaluations: trials that this took.
    """

    descents: tuple[Descent, ...]
    rounds: tuple[Round, ...]
    known: tuple[Evidence, ...]
    evaluations: int

    @property
    def best(self) -> Round | None:
        """The round whose proposal suits the populations best.

        Its own trials would not say: those that lack parts of the region look the more even for it.
        """
        usable = [each for each in self.rounds if each.logs.size >= _FEWEST]
        return min(usable, key=self.unevenness, default=None)

    def unevenness(self, drawn: Round) -> float:
        """Return the unevenness of the weights of a round's proposal, at the points of the populations: see
        `Proposal.unevenness`.
        """
        points, weights, _ = _of_descents(self.descents)
        return drawn.proposal.unevenness(points, weights)

    @property
    def probability(self) -> float:
        """The probability of acceptance that the populations give; its error is some tenths of it."""
        return self.searched + self.explored

    @property
    def searched(self) -> float:
        """The part of it that splitting came to."""
        return self._sum(explored=False)

    @property
    def explored(self) -> float:
        """The part of it that known accepted trials led to; a few of these may be all that it is known by."""
        return self._sum(explored=True)

    def _sum(self, *, explored: bool) -> float:
        taken = (each for each in self.descents if each.reached and each.explored is explored)
        return sum(math.exp(each.log_probability) for each in taken) / _DESCENTS

    def unexplained(self, proposal: Proposal, known: Sequence[Evidence]) -> Evidence:
        """Return the accepted trials of other origin that a proposal hardly ever draws; see `unexplained`."""
        points, weights, _ = _of_descents(self.descents)
        return find_unexplained(proposal, known, points, weights)


def learn(
    distance: Distance,
    dimensions: int,
    random: np.random.Generator,
    say: Say,
    most: float,
    known: Sequence[Evidence],
    strata: Sequence[Distance],
) -> Learned:
    """Find the region where the distance is 0, and describe it; in no more evaluations than `most`, about.

    Args:
        distance: 0 where a point of so many dimensions is accepted.
        dimensions: of the points.
        random: to learn with.
        say: called with the evaluations so far.
        most: evaluations.
        known: trials that were drawn before, at least once; those that were accepted are evidence.
        strata: distances of parts of all trials, whose populations go apart; all together where there are none.
    """
    descents: list[Descent] = []
    apart = strata or (distance,)
    population, first = (max(whole // len(apart), least) for whole, least in ((_POPULATION, 512), (_FIRST, 8_192)))
    for each in apart:
        for _ in range(_DESCENTS):
            descents.append(descend(each, dimensions, random, population=population, first=first))
            say(sum(done.evaluations for done in descents))
    learned = Learned(tuple(descents), (), tuple(known), sum(each.evaluations for each in descents))
    if not any(each.reached for each in descents):
        if not any(len(each.points) for each in known):
            return learned
        learned = _explored(distance, learned, join_evidence(known), random)
    learned, proposal = _with_unexplained(distance, learned, random, most - _TRIALS)
    return _refined(distance, learned, proposal, random, say, most)


def learn_again(
    distance: Distance, learned: Learned, more: Round, random: np.random.Generator, say: Say, most: float
) -> Learned:
    """Learn from trials that turned out to be heavier than any that were known."""
    known = replace(learned, rounds=(*learned.rounds, more))
    return _refined(distance, known, _improved(known, random), random, say, most)


def search_on(
    distance: Distance, learned: Learned, evidence: Evidence, random: np.random.Generator, say: Say, most: float
) -> Learned:
    """Search on from accepted trials that lie where nothing was learned."""
    learned = _explored(distance, learned, evidence, random)
    return _refined(distance, learned, _described(learned, random), random, say, most)


def _described(learned: Learned, random: np.random.Generator) -> Proposal:
    """Fit a first proposal, from the populations alone."""
    points, weights, halves = _of_descents(learned.descents)
    order = _dealt(halves, random)
    return fit_proposal(points[order], weights[order], random)


def _with_unexplained(
    distance: Distance, learned: Learned, random: np.random.Generator, most: float
) -> tuple[Learned, Proposal]:
    """Return what was learned, with populations around accepted trials that the others did not reach, and a first
    proposal.
    """
    proposal = _described(learned, random)
    for _ in range(_EXPLORED):
        evidence = learned.unexplained(proposal, learned.known)
        if learned.evaluations + _DESCENTS * EXPLORING > most or not evidence.tells(learned.probability):
            break
        learned = _explored(distance, learned, evidence, random)
        proposal = _described(learned, random)
    return learned, proposal


def _explored(distance: Distance, learned: Learned, evidence: Evidence, random: np.random.Generator) -> Learned:
    made = [explore(distance, evidence.points, evidence.shares, evidence.log_mass, random) for _ in range(_DESCENTS)]
    asked = sum(each.evaluations for each in made)
    return replace(learned, descents=(*learned.descents, *made), evaluations=learned.evaluations + asked)


def _refined(
    distance: Distance, learned: Learned, proposal: Proposal, random: np.random.Generator, say: Say, most: float
) -> Learned:
    """Draw from the proposal, fit a better one, and so on while that brings much."""
    best = 0.0
    for number in range(_ROUNDS):
        before = learned.evaluations
        drawn = _drawn(distance, proposal, random, count_on(before, say), most - before)
        learned = replace(learned, rounds=(*learned.rounds, drawn), evaluations=before + drawn.trials)
        if learned.evaluations >= most or drawn.rate >= _GOOD or (number > 1 and drawn.rate < best * _GAIN):
            break
        best = max(best, drawn.rate)
        proposal = _improved(learned, random)
    return learned


def _improved(learned: Learned, random: np.random.Generator) -> Proposal:
    """Fitted to the populations' points and to all that were drawn, half by half."""
    moved, shares, halves = _of_descents(learned.descents)
    points, logs = pool((*learned.rounds, *learned.known))
    if len(points) < _FEWEST:
        points, weights = moved, shares
    else:
        weights = np.exp(logs - logs.max())
        weights = np.minimum(weights, _TALLEST * weights.mean())
        halves = np.concatenate([halves, np.arange(len(points)) % 2])
        points, weights = np.concatenate([moved, points]), np.concatenate([shares, weights / weights.sum()])
    order = _dealt(halves, random)
    return refit(learned.rounds[-1].proposal, points[order], weights[order], random)


def _of_descents(descents: Sequence[Descent]) -> tuple[Floats, Floats, NDArray[np.int64]]:
    """Return the points of those populations that reached the region, their weights, which sum to 1, and which
    population.
    """
    reached = [each for each in descents if each.reached]
    heaviest = max(each.log_probability for each in reached)
    shares = [math.exp(each.log_probability - heaviest) / len(each.points) for each in reached]
    weights = np.repeat(shares, [len(each.points) for each in reached])
    halves = np.concatenate([np.full(len(each.points), p % 2) for p, each in enumerate(descents) if each.reached])
    if np.ptp(halves) == 0:
        halves = np.arange(len(halves)) % 2
    return np.concatenate([each.points for each in reached]), weights / weights.sum(), halves


def _dealt(halves: NDArray[np.int64], random: np.random.Generator) -> NDArray[np.intp]:
    """Take some of the points, from both halves in turn: points of one population are alike, and what is fitted to one
    must prove itself on the other.
    """
    first, second = (random.permutation(np.flatnonzero(halves == half)) for half in (0, 1))
    count = min(first.size, second.size, _FITTED // 2)
    return np.stack([first[:count], second[:count]], axis=1).ravel()


def _drawn(distance: Distance, proposal: Proposal, random: np.random.Generator, say: Say, most: float) -> Round:
    """Run a round; where few are accepted, a longer one."""
    result, trials = list[Floats](), 0
    while trials < _TRIALS or (sum(map(len, result)) < _ENOUGH and trials < min(_MOST_TRIALS, most)):
        points = proposal.draw(_TRIALS, random)
        result.append(points[distance(points) == 0.0])
        trials += _TRIALS
        say(trials)
    points = np.concatenate(result)
    return Round(proposal, trials, points, proposal.log_weights(points))
