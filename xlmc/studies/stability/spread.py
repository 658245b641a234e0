"""Whether the spread of a cell over the trials is its own, or that of its roundings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.address import Cell
from xlmc.run.digits import MOST_OF_SPREAD
from xlmc.studies.stability.case import Case

__all__ = ["Spread", "spread"]

_TRIALS: Final = 24


@dataclass(frozen=True, slots=True)
class Spread:
    """Of some trials computed again with 50 digits.

    Attributes:
        error: how far off the cell is by rounding, in the median of them.
        width: of the central half of the exact values.
    """

    error: float
    width: float

    @property
    def is_rounding(self) -> bool:
        """Whether what is printed of the spread is rounding, where there is a spread."""
        return self.width > 0 and self.error > MOST_OF_SPREAD * self.width

    def __str__(self) -> str:
        return f"in the median trial by {self.error:.1g}, where its true central range is {self.width:.1g} wide"


def spread(case: Case, cell: Cell) -> Spread:
    """Of a cell, in accepted trials, or drawn ones where there are none."""
    first = case.first_accepted if case.n - case.first_accepted >= _TRIALS else case.special
    trials = sorted({int(trial) for trial in np.linspace(first, case.n - 1, _TRIALS)} if case.n > first else set())
    node = case.node[cell]
    shown = case.number(node)[trials]
    exact = np.array([case.exact_number(node, trial) for trial in trials])
    known = np.isfinite(shown) & np.isfinite(exact)
    if known.sum() < 2:
        return Spread(0.0, 0.0)
    low, high = np.quantile(exact[known], [0.245, 0.755])
    return Spread(float(np.median(np.abs(shown - exact)[known])), float(high - low))
