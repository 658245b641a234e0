"""Cumul: a distribution function through points, such as percentiles that somebody has published."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.parameters import DataError, DataSpec, show
from xlmc.montecarlo.distributions.piecewise import Between, Piecewise, data_column

__all__ = ["Cumul", "CumulD"]


class Cumul(Between):
    """Values, each with the probability that it is not exceeded; in straight lines from low (0) to high (1).

    >>> reaction = Cumul().built(np.array([[1.0, 0.25], [1.5, 0.75]]))
    >>> print(reaction.ppf(np.array([0.0, 0.25, 0.5, 0.875]), low=0.5, high=2.5))
    [0.5  1.   1.25 2.  ]
    >>> reaction.check(low=3, high=2.5)
    'Low (3) must be below High (2.5)'
    >>> print(reaction.ppf(0.875, 0.5, np.array([2.5, 1.0])))
    [ 2. nan]
    """

    name = "Cumul"
    aliases = ("Cumulative",)
    data = DataSpec((2,), "values, cumulative probabilities")
    bend = 1.0
    formula = "P(X ≤ x) in straight lines from (Low, 0) through the points of Data to (High, 1)"
    source = "@RISK's manual, Cumul"
    elsewhere: tuple[str, ...] = ("@RISK Cumul(min, max, {x}, {p})", "Crystal Ball Custom by cumulative weights")

    def _heights(self, data: Array) -> Array:
        probabilities = data_column(data, 1, "cumulative probability")
        for row in np.flatnonzero((probabilities < 0) | (probabilities > 1)):
            message = f"The cumulative probability {show(probabilities[row])} is not from 0 to 1"
            raise DataError(message, "Type a share of 1, such as 0.25", int(row), 1)
        for row in np.flatnonzero(np.diff(probabilities) < 0):
            message = f"The cumulative probability {show(probabilities[row + 1])} is below the one before it"
            raise DataError(message, "Cumulative probabilities never fall", int(row) + 1, 1)
        return probabilities

    def _reaches(self, low: Values, first: float, height: float) -> Any:
        return np.less_equal(low, first) if height == 0 else np.less(low, first)

    def _weights(self, low: Values, high: Values) -> tuple[Values, Values, Values]:
        none = 0 * (low + high)
        first, last = self.heights[0], self.heights[-1]
        return first + none, (last - first) + none, (1 - last) + none

    @cached_property
    def _middle(self) -> Piecewise | None:
        flat = self.heights[0] == self.heights[-1]
        return None if flat else Piecewise.of_distribution(self.values, self.heights)

    @cached_property
    def _mirror(self) -> Cumul:
        return Cumul(-self.values[::-1], 1 - self.heights[::-1])


class CumulD(Cumul):
    """Values, each with the probability that it is exceeded; in straight lines from low (1) to high (0).

    >>> reserve = CumulD().built(np.array([[1.0, 0.75], [1.5, 0.25]]))
    >>> print(reserve.ppf(np.array([0.0, 0.25, 0.5, 0.875]), low=0.5, high=2.5))
    [0.5  1.   1.25 2.  ]
    """

    name = "CumulD"
    aliases = ("Cumulative descending",)
    data = DataSpec((2,), "values, probabilities to exceed them")
    formula = "P(X > x) in straight lines from (Low, 1) through the points of Data to (High, 0)"
    source = "@RISK's manual, CumulD"
    elsewhere = ("@RISK CumulD(min, max, {x}, {p})",)

    def _heights(self, data: Array) -> Array:
        probabilities = data_column(data, 1, "probability")
        for row in np.flatnonzero((probabilities < 0) | (probabilities > 1)):
            message = f"The probability {show(probabilities[row])} is not from 0 to 1"
            raise DataError(message, "Type a share of 1, such as 0.25", int(row), 1)
        for row in np.flatnonzero(np.diff(probabilities) > 0):
            message = f"The probability {show(probabilities[row + 1])} is above the one before it"
            raise DataError(message, "Probabilities to exceed a value never rise with it", int(row) + 1, 1)
        return 1 - probabilities
