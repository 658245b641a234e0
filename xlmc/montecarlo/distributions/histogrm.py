"""Histogrm: intervals of one width from low to high, each with its weight, such as the bars of a published chart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values
from xlmc.montecarlo.distributions.parameters import HIGH, LOW, DataError, DataSpec, show
from xlmc.montecarlo.distributions.piecewise import BELOW, Piecewise, data_column

__all__ = ["Histogrm"]


class Histogrm(Family):
    """Intervals of equal width, one for each weight; all values in an interval are equally likely.

    >>> speeds = Histogrm().built(np.array([[1.0], [2.0], [1.0]]))
    >>> print(speeds.ppf(np.array([0.0, 0.25, 0.5, 0.875]), low=20, high=50))
    [20. 30. 35. 45.]
    >>> speeds.check(low=50, high=20)
    'Low (50) must be below High (20)'
    >>> print(speeds.ppf(0.5, 20.0, np.array([50.0, 10.0])))
    [35. nan]
    """

    name = "Histogrm"
    aliases = ("Histogram",)
    parameters = (LOW, HIGH)
    rules = (BELOW,)
    data = DataSpec((1,), "weights")
    formula = "density ∝ the weights of Data over equal intervals from Low to High"
    source = "@RISK's manual, Histogrm"
    elsewhere = ("@RISK Histogrm(min, max, {p})",)

    def __init__(self, bars: Piecewise | None = None) -> None:
        self.bars = bars

    def built(self, data: Array, **_: Any) -> Histogrm:
        """Make the family of these weights, `(intervals, 1)`."""
        weights = data_column(data, 0, "weight")
        for row in np.flatnonzero(weights < 0):
            raise DataError(f"The weight {show(weights[row])} is below 0", "Type 0 or more", int(row), 0)
        if not weights.any():
            raise DataError("All weights are 0", "At least one must be above 0", 0, 0)
        return Histogrm(Piecewise.of_weights(0.0, 1.0, weights))

    def bind(self, params: Sequence[Any], named: Mapping[str, Any]) -> tuple[Any, ...]:
        if self.bars is None:
            raise TypeError(f"{self.name} must be built from data first")
        return super().bind(params, named)

    @property
    def _unit(self) -> Piecewise:
        """The distribution from 0 to 1."""
        assert self.bars is not None
        return self.bars

    def _ppf(self, u: Array, low: Values, high: Values) -> Array:
        return np.clip(low + (high - low) * self._unit.ppf(u), low, high)

    def _isf(self, q: Array, low: Values, high: Values) -> Array:
        return np.clip(low + (high - low) * self._unit.isf(q), low, high)

    def _cdf(self, x: Values, low: Values, high: Values) -> Values:
        return self._unit.cdf((x - low) / (high - low))

    def _sf(self, x: Values, low: Values, high: Values) -> Values:
        return self._unit.sf((x - low) / (high - low))

    def _mean(self, low: Values, high: Values) -> Values:
        return low + (high - low) * self._unit.mean()

    def _variance(self, low: Values, high: Values) -> Values:
        return (high - low) ** 2 * self._unit.variance()

    def _support(self, low: Values, high: Values) -> tuple[Values, Values]:
        return low + 0 * high, high + 0 * low
