"""Distributions of pieces: single values and ranges, each with a weight of its own.

Every form of Crystal Ball's custom data comes down to pieces that do not overlap, from left to right: a single value,
or a range with a density that is flat or slopes in a straight line. `custom_data` makes the pieces; this draws.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.distributions.base import Array, Family, Values

__all__ = ["Piece", "Pieces"]


Indices = NDArray[np.intp]
"""For each value, the piece that it belongs to."""


@dataclass(frozen=True, slots=True)
class Piece:
    """A single value (low = high) or a range; `weight` is the whole piece's, heights are those of its two ends."""

    low: float
    high: float
    weight: float = 1.0
    left: float = 1.0
    right: float = 1.0


class Pieces(Family):
    """A distribution of pieces. It has no parameters: an instance holds its data. Without data it can only be `built`.

    Args:
        pieces: from left to right, without overlaps; weights 0 or more, not all 0.

    >>> unit_cost = Pieces([Piece(5, 15, 0.75), Piece(16, 21, 0.25)])
    >>> print(unit_cost.ppf(np.array([0.0, 0.375, 0.75, 0.875])))
    [ 5.  10.  15.  18.5]
    >>> print(unit_cost.cdf(np.array([4.0, 10.0, 15.5, 21.0])))
    [0.    0.375 0.75  1.   ]
    >>> print(Pieces([Piece(1, 1), Piece(6, 6, 2)]).ppf(np.array([0.0, 1 / 3, 0.34])))
    [1. 1. 6.]
    >>> unit_cost.check() is None
    True
    """

    name = "Pieces"
    parameters = ()
    open_below = True  # u = 0 stands for its half step, so that it finds the first piece with a weight

    def __init__(self, pieces: Sequence[Piece] = ()) -> None:
        weighted = [piece for piece in pieces if piece.weight > 0]
        if weighted:
            self._set_arrays(weighted)

    def _set_arrays(self, weighted: Sequence[Piece]) -> None:
        self.low, self.high, weights, left, right = (
            np.array([getattr(piece, field) for piece in weighted], dtype=float)
            for field in ("low", "high", "weight", "left", "right")
        )
        whole = weights.sum()
        self.share = weights / whole
        self.below = np.concatenate([[0.0], np.cumsum(weights) / whole])
        self.below[-1] = 1.0
        self.above = np.concatenate([np.cumsum(weights[::-1])[::-1] / whole, [0.0]])
        self.above[0] = 1.0
        self.single = self.low == self.high
        # A range's density along it, t from 0 to 1, is start + 2·(1 - start)·t: it covers an area of 1.
        self.start = 2 * left / (left + right)

    def cutoffs(self, lower: Values, upper: Values) -> tuple[tuple[Values, Values], tuple[Values, Values]]:
        """Single values at a cutoff are kept; the pieces of a truncated distribution must all be single values."""
        values = np.concatenate([[-np.inf], self.low, [np.inf]])
        first = np.searchsorted(self.low, lower, side="left")
        last = np.searchsorted(self.low, upper, side="right")
        return (values[first + 1], values[first]), (values[last], values[last + 1])

    def _ppf(self, u: Array) -> Array:
        piece = np.minimum(np.searchsorted(self.below[1:], u), self.low.size - 1)
        if self.single.all():
            return self.low[piece]
        along = np.clip((u - self.below[piece]) / self.share[piece], 0.0, 1.0)
        return self._position(piece, _distance(along, self.start[piece]))

    def _isf(self, q: Array, *_: Values) -> Array:
        # The last piece above which no more than q lies, counted from the right.
        count = self.low.size
        piece = np.clip(count - np.searchsorted(self.above[::-1], q, side="right"), 0, count - 1)
        if self.single.all():
            return self.low[piece]
        along = np.clip((q - self.above[piece + 1]) / self.share[piece], 0.0, 1.0)
        return self._position(piece, 1 - _distance(along, 2 - self.start[piece]))

    def _position(self, piece: Indices, t: Array) -> Array:
        low, high = self.low[piece], self.high[piece]
        return np.asarray(np.clip(low + (high - low) * t, low, high))

    def _cdf(self, x: Values) -> Values:
        piece = np.searchsorted(self.low, x, side="right") - 1  # the piece that x lies in or after
        inside = np.maximum(piece, 0)
        value = self.below[inside] + self.share[inside] * self._covered(inside, x)
        whole = (piece >= 0) & (x >= self.high[inside])
        return np.where(whole, self.below[inside + 1], np.where(piece < 0, 0.0, value))

    def _sf(self, x: Values, *_: Values) -> Values:
        piece = np.searchsorted(self.high, x, side="left")  # the piece that x lies in or before
        inside = np.minimum(piece, self.high.size - 1)
        value = self.above[inside + 1] + self.share[inside] * self._uncovered(inside, x)
        whole = (piece <= inside) & (x <= self.low[inside])
        return np.where(whole, self.above[inside], np.where(piece > inside, 0.0, value))

    def _along(self, piece: Indices, x: Values) -> Array:
        width = np.where(self.single[piece], 1.0, self.high[piece] - self.low[piece])
        return np.asarray((np.clip(x, self.low[piece], self.high[piece]) - self.low[piece]) / width)

    def _covered(self, piece: Indices, x: Values) -> Array:
        t, start = self._along(piece, x), self.start[piece]
        return np.asarray(t * (start + (1 - start) * t))

    def _uncovered(self, piece: Indices, x: Values) -> Array:
        width = np.where(self.single[piece], 1.0, self.high[piece] - self.low[piece])
        t = (self.high[piece] - np.clip(x, self.low[piece], self.high[piece])) / width
        end = 2 - self.start[piece]
        return np.asarray(t * (end + (1 - end) * t))

    def _mean(self) -> Values:
        return float(self.low[0] + np.sum(self.share * (self.low - self.low[0] + self._centre())))

    def _variance(self) -> Values:
        width = self.high - self.low
        inner = width**2 * (1 / 12 - ((1 - self.start) / 6) ** 2)
        centre = self.low + self._centre()
        return float(np.sum(self.share * (inner + (centre - self._mean()) ** 2)))

    def _centre(self) -> Array:
        """How far right of its low end a piece's mean lies."""
        return np.asarray((self.high - self.low) * (0.5 + (1 - self.start) / 6))

    def _support(self) -> tuple[Values, Values]:
        return float(self.low[0]), float(self.high[-1])

    def _mirrored(self) -> tuple[Values, ...]:
        raise TypeError(f"{self.name} has no mirror image in its family")  # _sf and _isf do without


def _distance(area: Array, start: Array) -> Array:
    """Return the t at which start·t + (1 - start)·t² is the area, from 0 to 1: the root without cancellation."""
    bottom = start + np.sqrt(np.maximum(start * start + 4 * (1 - start) * area, 0.0))
    return np.minimum(2 * area / np.where(bottom > 0, bottom, 1.0), 1.0)
