"""The whole way: learn where trials are accepted, then draw so many of equal weight."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.rare.equalising import Accepts, Equalised, equalised
from xlmc.rare.learning import Learned, Round, Say, after, again, learn
from xlmc.rare.splitting import Distance

__all__ = ["Found", "find"]

_AGAIN: Final = 3
"""Times that a proposal is learnt anew because a trial was much heavier than any known."""


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """What came of it.

    Attributes:
        learned: what the search found.
        used: the round whose proposal the trials come from; None where there is none to draw from.
        equalised: the trials; None likewise.
        evaluations: trials that all this took.
    """

    learned: Learned
    used: Round | None
    equalised: Equalised | None
    evaluations: int


def find(
    distance: Distance,
    accepts: Accepts,
    dimensions: int,
    wanted: int,
    most: int,
    learning: np.random.Generator,
    drawing: np.random.Generator,
    say: Say = lambda _: None,
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
        say: told of the evaluations so far.
    """
    learned, before = learn(distance, dimensions, learning, say, most), 0
    for tries_left in range(_AGAIN, -1, -1):
        used, done = learned.best, learned.evaluations + before
        if used is None or wanted > used.rate * (most - done):
            return Found(learned, None, None, done)
        drawn = equalised(
            accepts,
            used.proposal,
            used.envelope,
            learned.unevenness(used),
            wanted,
            most - done,
            drawing,
            after(done, say),
            surprises=tries_left > 0,
        )
        if drawn.surprise is None:
            break
        before += drawn.proposals
        learned = again(distance, learned, drawn.surprise, learning, after(before, say), most - before)
    return Found(learned, used, drawn, done + drawn.proposals)
