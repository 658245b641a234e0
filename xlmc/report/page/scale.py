"""A straight axis: from numbers to places on a drawing, with round ticks."""

from __future__ import annotations

import math
from dataclasses import dataclass

__all__ = ["Scale", "scale_of"]

_ROUND = (1.0, 2.0, 5.0, 10.0)
_ROOM = 0.03


@dataclass(frozen=True, slots=True)
class Scale:
    """From `low` at `start` to `high` at `stop`; `step` is between ticks."""

    low: float
    high: float
    start: float
    stop: float
    step: float

    def __call__(self, value: float) -> float:
        """Where a number stands."""
        return self.start + (self.stop - self.start) * (value - self.low) / (self.high - self.low)

    @property
    def ticks(self) -> list[float]:
        """The multiples of the step within the scale."""
        first, last = math.ceil(self.low / self.step - 1e-9), math.floor(self.high / self.step + 1e-9)
        return [float(f"{place * self.step:.12g}") for place in range(first, last + 1)]

    def text(self, tick: float) -> str:
        """A tick in the digits that the step needs."""
        return f"{tick:g}".replace("-", "−")


def scale_of(values: list[float], start: float, stop: float, *, most: int = 6) -> Scale:
    """A scale that reaches over all finite values, with a little room, and has `most` ticks at most.

    >>> scale_of([0.0, 0.93], 0.0, 100.0).ticks
    [0.0, 0.2, 0.4, 0.6, 0.8]
    """
    known = [value for value in values if math.isfinite(value)] or [0.0]
    low, high = min(known), max(known)
    if high - low <= 1e-12 * max(abs(low), abs(high), 1e-300):
        margin = 0.5 * abs(low) or 0.5
        low, high = low - margin, high + margin
    else:
        low, high = low - _ROOM * (high - low), high + _ROOM * (high - low)
    step = _round_above((high - low) / most)
    return Scale(low, high, start, stop, step)


def _round_above(width: float) -> float:
    power = 10.0 ** math.floor(math.log10(width))
    return power * next(factor for factor in _ROUND if factor * power >= width * (1.0 - 1e-9))
