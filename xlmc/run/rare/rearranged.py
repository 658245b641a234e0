"""A uniform whose accepted values come first: a change of variables that leaves every probability as it is.

Where the accepted values of a uniform u are a few short intervals, the pieces of [0, 1) are put in another order: these
intervals first, one after the other, then all the rest. The place t in this order is a uniform again, whatever the
intervals are, and accepted where it is below their length together: a thin layer has become a tail. Nothing that is
said of t depends on how exactly the intervals are known; what they leave out is found behind them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.run.rare.spans import pieces

__all__ = ["Rearranged"]

Floats = NDArray[np.float64]

_LARGEST: Final = 1.0 - 2.0**-53
_MARGIN: Final = 1e-3
"""By which share of itself an interval is taken longer at either end: rounding must not cut off what is accepted."""

_BITS: Final = 8.0
"""By how many of the last bits of its ends, beside."""


@dataclass(frozen=True, slots=True, eq=False)
class Rearranged:
    """Of n trials.

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
        """For intervals (p, n) of the uniform; those that are empty have no length."""
        with np.errstate(invalid="ignore"):
            margin = _MARGIN * (high - low) + _BITS * np.spacing(np.where(low < high, high, 1.0))
        found = pieces([_within(low, high, margin)])
        with np.errstate(invalid="ignore"):
            length = np.where(found.low < found.high, found.high - found.low, 0.0)
        reached = np.cumsum(length, axis=0)
        return cls(found.low, length, reached - length, np.minimum(reached[-1], 1.0))

    def uniform(self, place: Floats) -> Floats:
        """(n,) the uniform in so many places, (n,)."""
        rest = place - self.total
        found = rest.copy()
        for start, length, before in zip(self.start, self.length, self.before, strict=True):
            found += np.where(rest >= start - before, length, 0.0)
        for start, length, before in zip(self.start, self.length, self.before, strict=True):
            inside = (place >= before) & (place < before + length)
            found = np.where(inside, start + (place - before), found)
        return np.asarray(np.clip(found, 0.0, _LARGEST))

    def place(self, uniform: Floats) -> Floats:
        """(n,) the places of uniforms, (n,)."""
        found = uniform + self.total
        for start, length in zip(self.start, self.length, strict=True):
            found -= np.where(uniform >= start + length, length, 0.0)
        for start, length, before in zip(self.start, self.length, self.before, strict=True):
            inside = (uniform >= start) & (uniform < start + length)
            found = np.where(inside, before + (uniform - start), found)
        return np.asarray(np.clip(found, 0.0, _LARGEST))

    def folded(self, place: Floats) -> Floats:
        """(n,) places that are all within the intervals: those beyond, by whole lengths nearer."""
        some = self.total > 0.0
        found = np.fmod(place, np.where(some, self.total, 1.0))
        return np.where(some, found, place)


def _within(low: Floats, high: Floats, margin: Floats) -> tuple[Floats, Floats]:
    """Longer by so much, within 0 and 1."""
    full, least, most = low < high, np.maximum(low - margin, 0.0), np.minimum(high + margin, 1.0)
    return np.where(full, least, np.inf), np.where(full, most, -np.inf)
