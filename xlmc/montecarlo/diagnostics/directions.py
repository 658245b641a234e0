"""Directions whose numbers jump: 180° and -180° are one direction, and the mean of numbers on both sides is neither.

A forecast in degrees or radians may be a direction, such as the principal direction of force of an impact from behind,
where `180-MOD(180-…,360)` goes from 180 to -180. Each of its numbers is moved by the full turns that bring it within
half a turn of the mean direction, which is the angle of the sum of (cos x, sin x). Where some numbers move, and all of
them then lie closer together, the jump lies among the trials.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.errors import Notice
from xlmc.montecarlo.loop.forecast_result import ForecastResult
from xlmc.montecarlo.number_text import number_text, styled_text
from xlmc.montecarlo.statistics import Sample

__all__ = ["TornDirection", "direction_notices", "torn_direction"]

_TURNS: Final = {
    **dict.fromkeys(("°", "deg", "degree", "degrees"), (360.0, "360", 10.0)),
    **dict.fromkeys(("rad", "radian", "radians"), (2.0 * math.pi, "(2*PI())", 0.1)),
}
"""Units -> a full turn, as a number and in a formula, and the step to which the middle of a formula is rounded."""

_TOGETHER: Final = 1 / 6
"""A share of a turn: directions with a larger standard deviation have no middle that they lie around."""

_CLOSER: Final = 0.95
"""A share of the standard deviation of the numbers: that of the directions is not larger if the jump matters."""

_ENOUGH: Final = 100_000
"""Trials that are looked at, evenly spread over the sorted ones."""


@dataclass(frozen=True, slots=True)
class TornDirection:
    """A direction on both sides of the jump of its numbers.

    Attributes:
        mean: of the numbers moved together, in the forecast's units, from -90° to 270°.
        deviation: their standard deviation.
        share: of the accepted trials, that on the side of the jump where there are fewer.
    """

    mean: float
    deviation: float
    share: float


def torn_direction(sample: Sample, turn: float) -> TornDirection | None:
    """Return what the directions are, moved together; None if no jump lies among their numbers.

    Args:
        sample: the accepted trials, `(n,)` in ascending order.
        turn: a full turn in their units.

    >>> torn_direction(Sample.of([-179.0, -177.0, 177.0, 179.0]), 360.0)
    TornDirection(mean=180.0, deviation=2.23606797749979, share=0.5)
    >>> torn_direction(Sample.of([-2.0, -1.0, 1.0, 2.0]), 360.0) is None
    True
    """
    if sample.n < 2 or not turn / 2 < float(sample.x[-1]) - float(sample.x[0]) <= turn * (1 + 1e-12):
        return None
    seen = sample.part(np.arange(0, sample.n, -(-sample.n // _ENOUGH)))
    angle = seen.x * (2.0 * math.pi / turn)
    sine, cosine = (float(np.average(each, weights=seen.w)) for each in (np.sin(angle), np.cos(angle)))
    middle = math.atan2(sine, cosine) * turn / (2.0 * math.pi)
    turns = np.rint((seen.x - middle) / turn)
    together = seen.x - turn * turns
    if turns[0] == turns[-1]:
        return None
    mean, deviation = _spread(together, seen)
    mean = (mean + turn / 4) % turn - turn / 4
    if deviation > _TOGETHER * turn or deviation > _CLOSER * _spread(seen.x, seen)[1]:
        return None
    moved = float(np.average(turns != turns[0], weights=seen.w))
    return TornDirection(mean, deviation, min(moved, 1.0 - moved))


def _spread(x: np.ndarray[tuple[int], np.dtype[np.float64]], seen: Sample) -> tuple[float, float]:
    mean = float(np.average(x, weights=seen.w))
    return mean, math.sqrt(float(np.average(np.square(x - mean), weights=seen.w)))


def direction_notices(results: Iterable[ForecastResult]) -> list[Notice]:
    """Return a caution about forecasts that are directions with a jump among their trials."""
    return [
        Notice(_sentence(result, torn, written, step))
        for result in results
        for turn, written, step in [_TURNS.get(result.definition.units.strip().casefold(), (0.0, "", 0.0))]
        if turn and (torn := torn_direction(result.sample, turn)) is not None
    ]


def _sentence(result: ForecastResult, torn: TornDirection, written: str, step: float) -> str:
    units = result.definition.units
    middle = round(torn.mean / step) * step
    inner = f"(x{-middle:+g})" if middle else "x"
    return (
        f"{result.definition.name!r} is a direction, and its numbers jump by a full turn: "
        f"{styled_text(torn.share, '.2%')} of the "
        f"accepted trials lie beyond the jump. Its mean, standard deviation and ranges are those of the numbers, not "
        f"of the direction, which is {number_text(torn.mean, 4)} {units} on average, with a standard deviation of "
        f"{number_text(torn.deviation, 3)} {units}. In its cell, write "
        f"=x-{written}*ROUND({inner}/{written},0), with the "
        f"present formula in the place of x"
    )
