"""The cumulative curve of a forecast: exact shares of its trials at closely spaced values, for an area chart.

The grid divides the bins of the histogram, so that both charts have the same axis; at each of its points the share of
trials at most there is counted, not summed from bins. Trials that the histogram does not draw count below and above.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xlmc.columns import release
from xlmc.report.histogram import Histogram, multiples
from xlmc.statistics.sample import Sample

__all__ = ["Cumulative", "cumulative"]

Floats = NDArray[np.float64]

_POINTS = 120
"""Points at least: the steps between them are then too short to see."""


@dataclass(frozen=True, slots=True)
class Cumulative:
    """A curve of `g` points.

    Attributes:
        at: `(g,)` values.
        at_most, above: `(g,)` shares of the trials; together 1.
        central: `(g,)` whether the point lies in the central range.
        labels: a text for some points, nothing for the others.
        step: points from one label to the next; the first has one.
    """

    at: Floats
    at_most: Floats
    above: Floats
    central: NDArray[np.bool_]
    labels: list[str]
    step: int


def cumulative(sample: Sample, bins: Histogram, low: float, high: float) -> Cumulative:
    """The curve over the range that the bins cover, the central range being [low, high]."""
    pieces = math.ceil(_POINTS / bins.edges.size)
    first = round(float(bins.edges[0] / bins.width)) * pieces
    at = multiples(bins.width / pieces, first, bins.edges.size * pieces + 1)
    at[::pieces] = [*bins.edges, bins.upper_edges[-1]]
    reached = np.searchsorted(sample.x, at, side="right")
    release(sample.x)
    labels = [""] * at.size
    labels[::pieces] = [*bins.labels, bins.last_label]
    return Cumulative(
        at=at,
        at_most=reached / sample.n,
        above=(sample.n - reached) / sample.n,
        central=(at >= low) & (at <= high),
        labels=labels,
        step=bins.step * pieces,
    )
