"""General: a density through points, drawn freehand; only the ratios of the heights matter."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.parameters import DataError, DataSpec, show
from xlmc.montecarlo.distributions.piecewise import Between, Piecewise, data_column

__all__ = ["General"]


class General(Between):
    """Values, each with the height of the density there; in straight lines from 0 at low to 0 at high.

    >>> friction = General().built(np.array([[0.70, 1.0], [0.85, 1.0]]))
    >>> print(friction.ppf(np.array([0.0, 0.25, 0.5, 0.75]), low=0.55, high=1.0))
    [0.55  0.7   0.775 0.85 ]
    >>> friction.check(low=0.55, high=0.8)
    'High (0.8) leaves no room above the last value (0.85)'
    >>> print(friction.ppf(0.5, 0.55, np.array([1.0, 0.8])))
    [0.775   nan]
    """

    name = "General"
    data = DataSpec((2,), "values, heights of the density")
    bend = 2.0
    formula = "density ∝ straight lines from (Low, 0) through the points of Data to (High, 0)"
    source = "@RISK's manual, General"
    elsewhere = ("@RISK General(min, max, {x}, {p})", "Crystal Ball Custom with sloping pieces")

    def _heights(self, data: Array) -> Array:
        heights = data_column(data, 1, "height")
        for row in np.flatnonzero(heights < 0):
            raise DataError(f"The height {show(heights[row])} is below 0", "Type 0 or more", int(row), 1)
        if not heights.any():
            raise DataError("All heights are 0", "At least one must be above 0", 0, 1)
        return np.asarray(heights / heights.max())

    def _reaches(self, low: Values, first: float, height: float) -> Any:
        return np.less_equal(low, first)

    def _weights(self, low: Values, high: Values) -> tuple[Values, Values, Values]:
        rise = (self.values[0] - low) * self.heights[0] / 2
        fall = (high - self.values[-1]) * self.heights[-1] / 2
        whole = rise + self._area + fall
        return rise / whole, self._area / whole, fall / whole

    @cached_property
    def _area(self) -> float:
        return float(np.sum(np.diff(self.values) * (self.heights[:-1] + self.heights[1:]) / 2))

    @cached_property
    def _middle(self) -> Piecewise | None:
        return Piecewise.of_density(self.values, self.heights) if self._area > 0 else None

    @cached_property
    def _mirror(self) -> General:
        return General(-self.values[::-1], self.heights[::-1])
