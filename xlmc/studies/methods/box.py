"""The box that the assumptions lie in: the lowest and highest value of each, whatever the others are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.run.model import Model
from xlmc.sampling.draws import Draw

__all__ = ["CUT", "DRAWN", "Box", "box_of"]

CUT: Final = 0.001
"""What an unbounded end is cut at: the quantile of this probability, and that of all but it."""

DRAWN: Final = 32_768
"""Draws whose extremes stand for the ends of an assumption whose parameters vary."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Box:
    """The ends of `k` assumptions, in the order of the model's.

    Attributes:
        low, high: `(k,)`.
        remarks: where an end is not that of the distribution, in words.
    """

    low: Floats
    high: Floats
    remarks: tuple[str, ...]

    @property
    def width(self) -> Floats:
        return self.high - self.low


def box_of(model: Model, seed: int) -> Box:
    """The box of a model; the seed is that of the draws which are looked at where parameters vary."""
    cut, varying = [], []
    ends = np.empty((len(model.live), 2))
    for place, assumption in enumerate(model.live):
        draw = model.draws[assumption.name]
        found = draw.support()
        if found is not None:
            ends[place] = found
        elif _fixed(draw):
            ends[place] = _cut(draw)
            cut.append(assumption.name)
        else:
            varying.append(place)
    if varying:
        drawn = model.sampler(seed, DRAWN).draw(0)
        for place in varying:
            column = drawn[model.draws[model.live[place].name].name]
            ends[place] = np.nanmin(column), np.nanmax(column)
    return Box(ends[:, 0], ends[:, 1], tuple(_remarks(model, cut, varying)))


def _fixed(draw: Draw) -> bool:
    return all(isinstance(each, float) for each in (*draw.parameters, *(draw.cutoffs or ())))


def _cut(draw: Draw) -> tuple[float, float]:
    """The ends, infinite ones replaced by quantiles."""
    at = np.array([0.0, CUT, 1.0 - CUT, 1.0])
    with np.errstate(all="ignore"):
        draw.fill(at, {})
    lowest, low, high, highest = at.tolist()
    # A family that is open below reads 0 as the least probability there is, and its quantile is finite.
    closed_below = np.isfinite(lowest) and not draw.family.open_below
    return (lowest if closed_below else low), (highest if np.isfinite(highest) else high)


def _remarks(model: Model, cut: list[str], varying: list[int]) -> list[str]:
    found = []
    if cut:
        names = ", ".join(cut)
        found.append(f"unbounded ends are cut at the {100 * CUT:g} and {100 - 100 * CUT:g} % quantiles: {names}")
    if varying:
        names = ", ".join(model.live[place].name for place in varying)
        found.append(f"parameters vary, so the extremes of {DRAWN:,} draws stand for the ends: {names}")
    if model.groups:
        found.append("correlations are not seen: any corner counts as possible")
    return found
