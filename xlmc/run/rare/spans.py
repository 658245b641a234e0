"""Sets of numbers as a few intervals in each trial, for all trials of a block together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Spans", "chosen", "common", "joined", "pieces"]

Floats = NDArray[np.float64]


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
        return pieces([(low, high)])

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


def pieces(parts: list[tuple[Floats, Floats]]) -> Spans:
    """The union of intervals: pairs of ends, (n,) or (p, n)."""
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


def joined(parts: list[Spans]) -> Spans:
    """What any of them holds."""
    return pieces([(each.low, each.high) for each in parts])


def common(parts: list[Spans]) -> Spans:
    """What all of them hold."""
    found = parts[0]
    for each in parts[1:]:
        low = np.maximum(found.low[:, None], each.low[None])
        high = np.minimum(found.high[:, None], each.high[None])
        found = pieces([(low.reshape(-1, low.shape[-1]), high.reshape(-1, high.shape[-1]))])
    return found


def chosen(holds: NDArray[np.bool_], yes: Spans, no: Spans) -> Spans:
    """The one set where something holds, (n,), and the other elsewhere."""
    return pieces([_emptied(yes.low, yes.high, ~holds), _emptied(no.low, no.high, holds)])
