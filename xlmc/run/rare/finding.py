"""The whole way: learn where trials are accepted, draw so many of equal weight, and look for what was missed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.run.rare.equalising import Accepts, Equalised, equalise
from xlmc.run.rare.learning import Learned, Round, Say, count_on, learn, learn_again, search_on
from xlmc.run.rare.splitting import Distance
from xlmc.run.rare.strays import Evidence, Tempered, wide_assumptions

__all__ = ["Found", "find"]

Floats = NDArray[np.float64]

_AGAIN: Final = 3
"""Times that a proposal is learnt anew because a trial was much heavier than any known."""

_SURVEY: Final = 65_536
"""Trials from the widened assumptions, before and after."""

_BATCH: Final = 8_192
"""Of them, at a time."""

_PART: Final = 32
"""Of the limit, a survey takes this part at most."""


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """What came of it.

    Attributes:
        learned: what the search found.
        used: the round whose proposal the trials come from; None where there is none to draw from.
        equalised: the trials; None likewise.
        checked: trials that were drawn from the widened assumptions afterwards.
        strays: accepted trials of other origin that the proposal hardly ever comes to.
        evaluations: trials that all this took.
    """

    learned: Learned
    used: Round | None
    equalised: Equalised | None
    evaluations: int
    checked: int = 0
    strays: Evidence | None = None


def find(
    distance: Distance,
    accepts: Accepts,
    dimensions: int,
    wanted: int,
    most: int,
    learning: np.random.Generator,
    drawing: np.random.Generator,
    say: Say = lambda _: None,
    plain: Sequence[Evidence] = (),
    ways: Sequence[Distance] = (),
) -> Found:
    """Draw `wanted` accepted trials of equal weight.

    Args:
        distance: 0 where a point of `dimensions` standard normals is accepted.
        accepts: where that is so; it may be faster.
        dimensions: of the points.
        wanted: trials.
        most: evaluations, of which learning takes what it needs.
        learning: random numbers to learn with.
        drawing: others, to draw the trials with: what they come from must not have served to learn.
        say: called with the evaluations so far.
        plain: trials from before the search.
        ways: see `learn`.
    """
    spread, checked, trials = wide_assumptions(dimensions), 0, min(_SURVEY, most // _PART)
    first = _survey(accepts, spread, trials, learning)
    before = first.trials
    learned = learn(distance, dimensions, learning, count_on(before, say), most - before, (*plain, first), ways)
    for tries_left in range(_AGAIN, -1, -1):
        used, done = learned.best, learned.evaluations + before
        if used is None or wanted > used.rate * (most - done):
            return Found(learned, None, None, done, checked)
        drawn = equalise(
            accepts,
            used.proposal,
            used.envelope,
            learned.unevenness(used),
            wanted,
            most - done,
            drawing,
            count_on(done, say),
            surprises=tries_left > 0,
        )
        if drawn.surprise is not None:
            before += drawn.proposals
            learned = learn_again(distance, learned, drawn.surprise, learning, count_on(before, say), most - before)
            continue
        check = _survey(accepts, spread, trials, drawing)
        checked += check.trials
        missed = learned.strays(used.proposal, (*plain, check))
        if not tries_left or not missed.tells(drawn.acceptance.value):
            break
        before += drawn.proposals + check.trials
        learned = search_on(distance, learned, missed, learning, count_on(before, say), most - before)
    return Found(learned, used, drawn, done + drawn.proposals + check.trials, checked, missed)


def _survey(accepts: Accepts, spread: Tempered, trials: int, random: np.random.Generator) -> Evidence:
    """Trials from the widened assumptions."""
    found = list[Floats]()
    for start in range(0, trials, _BATCH):
        points = spread.draw(min(_BATCH, trials - start), random)
        found.append(points[accepts(points)])
    return Evidence.of(spread, trials, np.concatenate(found))
