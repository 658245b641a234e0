"""A forecast's trials, few enough for a page, from which a browser counts those between any two ends.

Of a forecast with no more than `most` trials every one is there, and every count is exact. Of one with more, the trials
of `most` ranks at equal distances are, each with how many trials lie between it and the next: a count is then exact
where an end is one of the values given, and elsewhere its error is less than the trials of one such gap, an end.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xlmc.columns import picked, release

__all__ = ["ALL_VALUES", "MOST_VALUES", "RankTable", "most_values", "rank_table"]

Floats = NDArray[np.float64]
Counts = NDArray[np.int64]

ALL_VALUES = 50_000
"""On a page, of all its forecasts: some 1.2 MB."""

MOST_VALUES, _FEWEST = 20_000, 200
"""Of a forecast."""


@dataclass(frozen=True, slots=True)
class RankTable:
    """Trials by value.

    Attributes:
        values: `(k,)` ascending, all different.
        counts: `(k,)` trials at each.
        gaps: `(k - 1,)` trials between each and the next.
    """

    values: Floats
    counts: Counts
    gaps: Counts

    @property
    def exact(self) -> bool:
        """Whether every trial is at one of the values."""
        return not self.gaps.any()


def most_values(forecasts: int) -> int:
    """How many values of each forecast a page of so many has room for."""
    return min(max(ALL_VALUES // max(forecasts, 1), _FEWEST), MOST_VALUES)


def rank_table(x: Floats, most: int, marks: Iterable[float] = ()) -> RankTable:
    """The table of ascending `(n,)` trials.

    Args:
        x: in memory or on disk; none of them NaN.
        most: values to give, 2 or more.
        marks: further values at which counts must be exact; those that are not finite are left out.
    """
    ranks = np.arange(x.size) if x.size <= most else np.rint(np.linspace(0, x.size - 1, most)).astype(np.intp)
    finite: list[float] = [mark for mark in marks if np.isfinite(mark)]
    values = np.unique(np.concatenate([picked(x, ranks), finite]))
    while True:
        below, upto = np.searchsorted(x, values, side="left"), np.searchsorted(x, values, side="right")
        gaps = below[1:] - upto[:-1]
        wide = np.flatnonzero(gaps)[: max(most - values.size, 0)]
        if not wide.size:
            break
        # Ranks of whole numbers fall on the same values: there is room for those between.
        values = np.union1d(values, picked(x, upto[wide] + gaps[wide] // 2))
    release(x)
    return RankTable(values, upto - below, gaps)
