"""Sets of numbers as a few intervals in each trial, for all trials of a block together.

**Rearranged.** Where the accepted values of a uniform u are a few short intervals, the pieces of [0, 1) are put in
another order: these intervals first, one after the other, then all the rest. The position t in this order is a uniform
again, whatever the intervals are, and accepted where it is below their length together: a thin layer has become a tail,
and every probability is as it was. Nothing that is said of t depends on how exactly the intervals are known; what they
leave out is found behind them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["Rearranged", "Spans", "choose", "intersection", "union", "union_of_pairs"]

Floats = NDArray[np.float64]

_LARGEST: Final = 1.0 - 2.0**-53

_MARGIN: Final = 1e-3
"""The share of itself by which an interval is made longer at either end: rounding must not cut off what is accepted."""

_BITS: Final = 8.0
"""The number of last bits by which it is made longer in addition."""


@dataclass(frozen=True, slots=True, eq=False)
class Spans:
    """Up to p intervals in each of n trials: in order, apart from each other, the empty ones last.

    Attributes:
        low: (p, n) lower ends, ∞ where empty.
        high: (p, n) upper ends, −∞ where empty.
    """

    low: Floats
    high: Floats

    @classmethod
    def between(cls, low: Floats, high: Floats) -> Spans:
        """One interval a trial, (n,) ends each; empty where the ends are the wrong way round, or no numbers."""
        return union_of_pairs([(low, high)])

    @classmethod
    def whole(cls, n: int) -> Spans:
        """All numbers."""
        return cls(np.full((1, n), -np.inf), np.full((1, n), np.inf))

    @classmethod
    def where(cls, holds: NDArray[np.bool_]) -> Spans:
        """All numbers where something holds, (n,), and none elsewhere."""
        return cls(np.where(holds, -np.inf, np.inf)[None], np.where(holds, np.inf, -np.inf)[None])

    def contain(self, values: Floats) -> NDArray[np.bool_]:
        """(n,) whether each trial's value is in its set."""
        return np.asarray(((self.low <= values) & (values <= self.high)).any(axis=0))


def union_of_pairs(parts: list[tuple[Floats, Floats]]) -> Spans:
    """Unite intervals: pairs of ends, (n,) or (p, n)."""
    low = np.concatenate([np.atleast_2d(low) for low, _ in parts])
    high = np.concatenate([np.atleast_2d(high) for _, high in parts])
    full = low <= high
    low, high = np.where(full, low, np.inf), np.where(full, high, -np.inf)
    if len(low) == 1:
        return Spans(low, high)
    order = np.argsort(low, axis=0, kind="stable")
    low, high = np.take_along_axis(low, order, axis=0), np.take_along_axis(high, order, axis=0)
    for later in range(1, len(low)):
        touching = low[later] <= high[later - 1]
        low[later] = np.where(touching, low[later - 1], low[later])
        high[later] = np.where(touching, np.maximum(high[later], high[later - 1]), high[later])
        low[later - 1], high[later - 1] = _emptied(low[later - 1], high[later - 1], touching)
    order = np.argsort(low, axis=0, kind="stable")
    used = max(1, int((low < np.inf).sum(axis=0).max(initial=0)))
    low, high = np.take_along_axis(low, order, axis=0), np.take_along_axis(high, order, axis=0)
    return Spans(low[:used], high[:used])


def _emptied(low: Floats, high: Floats, here: NDArray[np.bool_]) -> tuple[Floats, Floats]:
    return np.where(here, np.inf, low), np.where(here, -np.inf, high)


def union(parts: list[Spans]) -> Spans:
    """Unite sets: return what any of them holds."""
    return union_of_pairs([(each.low, each.high) for each in parts])


def intersection(parts: list[Spans]) -> Spans:
    """Intersect sets: return what all of them hold."""
    spans = parts[0]
    for each in parts[1:]:
        low = np.maximum(spans.low[:, None], each.low[None])
        high = np.minimum(spans.high[:, None], each.high[None])
        spans = union_of_pairs([(low.reshape(-1, low.shape[-1]), high.reshape(-1, high.shape[-1]))])
    return spans


def choose(holds: NDArray[np.bool_], yes: Spans, no: Spans) -> Spans:
    """Choose the one set where something holds, (n,), and the other elsewhere."""
    return union_of_pairs([_emptied(yes.low, yes.high, ~holds), _emptied(no.low, no.high, holds)])


@dataclass(frozen=True, slots=True, eq=False)
class Rearranged:
    """The intervals of n trials, moved to the front.

    Attributes:
        start: (p, n) of the intervals, in order; ∞ for those that are not there.
        length: (p, n), 0 for those.
        before: (p, n) the length of all earlier ones.
        total: (n,) the length of all.
    """

    start: Floats
    length: Floats
    before: Floats
    total: Floats

    @classmethod
    def of(cls, low: Floats, high: Floats) -> Rearranged:
        """Rearrange by intervals (p, n) of the uniform; empty ones have no length."""
        with np.errstate(invalid="ignore"):
            margin = _MARGIN * (high - low) + _BITS * np.spacing(np.where(low < high, high, 1.0))
        spans = union_of_pairs([_within(low, high, margin)])
        with np.errstate(invalid="ignore"):
            length = np.where(spans.low < spans.high, spans.high - spans.low, 0.0)
        reached = np.cumsum(length, axis=0)
        return cls(spans.low, length, reached - length, np.minimum(reached[-1], 1.0))

    def uniform_at(self, position: Floats) -> Floats:
        """(n,) the uniform at these positions, (n,)."""
        rest = position - self.total
        values = rest.copy()
        for start, length, before in zip(self.start, self.length, self.before, strict=True):
            values += np.where(rest >= start - before, length, 0.0)
        for start, length, before in zip(self.start, self.length, self.before, strict=True):
            inside = (position >= before) & (position < before + length)
            values = np.where(inside, start + (position - before), values)
        return np.asarray(np.clip(values, 0.0, _LARGEST))

    def position_of(self, uniform: Floats) -> Floats:
        """(n,) the positions of uniforms, (n,)."""
        values = uniform + self.total
        for start, length in zip(self.start, self.length, strict=True):
            values -= np.where(uniform >= start + length, length, 0.0)
        for start, length, before in zip(self.start, self.length, self.before, strict=True):
            inside = (uniform >= start) & (uniform < start + length)
            values = np.where(inside, before + (uniform - start), values)
        return np.asarray(np.clip(values, 0.0, _LARGEST))

    def fold(self, position: Floats) -> Floats:
        """(n,) positions that are all within the intervals: those beyond, by whole lengths nearer."""
        some = self.total > 0.0
        values = np.fmod(position, np.where(some, self.total, 1.0))
        return np.where(some, values, position)


def _within(low: Floats, high: Floats, margin: Floats) -> tuple[Floats, Floats]:
    """Longer by so much, within 0 and 1."""
    full, least, most = low < high, np.maximum(low - margin, 0.0), np.minimum(high + margin, 1.0)
    return np.where(full, least, np.inf), np.where(full, most, -np.inf)
