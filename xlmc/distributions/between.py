"""What Cumul and General have in common: fixed points from data, and two ends that are parameters."""

from __future__ import annotations

from abc import abstractmethod
from functools import cached_property
from typing import Any, Self

import numpy as np

from xlmc.distributions.base import HIGH, LARGEST, LOW, Array, DataError, Family, Rule, Values, share, show
from xlmc.distributions.piecewise import Piecewise

__all__ = ["BELOW", "Between", "data_column"]

BELOW = Rule("low", lambda low, high: low < high, "Low ({low}) must be below High ({high})", "Correct the wrong one")


class Between(Family):
    """A fixed piecewise distribution from the first point to the last, and a piece at each side out to low and high.

    Low and high are parameters and may vary by trial. Before it is built, the family has no points, and no functions.

    Attributes:
        bend: the distribution function of the outer pieces is this power of the distance from the end.
    """

    parameters = (LOW, HIGH)
    bend: float

    def __init__(self, values: Array | None = None, heights: Array | None = None) -> None:
        if values is None or heights is None:
            return
        self.values, self.heights = values, heights
        first, last = float(values[0]), float(values[-1])
        self.rules = (
            Rule(
                "low", lambda low, high: low < high, "Low ({low}) must be below High ({high})", "Correct the wrong one"
            ),
            Rule(
                "low",
                lambda low, _high: self._reaches(low, first, heights[0]),
                f"Low ({{low}}) leaves no room below the first value ({show(first)})",
                "Lower Low, or correct the data",
            ),
            Rule(
                "high",
                lambda _low, high: self._reaches(-high, -last, self._mirror.heights[0]),
                f"High ({{high}}) leaves no room above the last value ({show(last)})",
                "Raise High, or correct the data",
            ),
        )

    def __reduce__(self) -> tuple[Any, ...]:
        """Its rules are made again from the points."""
        return type(self), ((self.values, self.heights) if hasattr(self, "values") else ())

    def built(self, data: Array, **_options: Any) -> Self:
        """The family of these points: `(points, 2)`, values and probabilities or heights."""
        values, heights = data_column(data, 0, "value"), self._heights(data)
        for row in np.flatnonzero(np.diff(values) <= 0):
            message = f"The value {show(values[row + 1])} is not above the one before it, {show(values[row])}"
            raise DataError(message, "Sort the rows so that the values rise", int(row) + 1, 0)
        found = type(self)(values, heights)
        _ = found._middle  # refuses values that are too near to each other
        return found

    def bind(self, params: Any, named: Any) -> tuple[Any, ...]:
        if not hasattr(self, "values"):
            raise TypeError(f"{self.name} must be built from data first")
        return super().bind(params, named)

    @abstractmethod
    def _heights(self, data: Array) -> Array:
        """The second column of the data.

        Raises:
            DataError: it breaks a rule of its own.
        """

    @abstractmethod
    def _reaches(self, low: Values, first: float, height: float) -> Any:
        """Whether the end is far enough below the first point, which has this height."""

    @abstractmethod
    def _weights(self, low: Values, high: Values) -> tuple[Values, Values, Values]:
        """The probabilities below the first point, between, and above the last."""

    @cached_property
    @abstractmethod
    def _middle(self) -> Piecewise | None:
        """The distribution between the points; None where there is none."""

    @cached_property
    @abstractmethod
    def _mirror(self) -> Self:
        """The family of -X."""

    def _ppf(self, u: Array, low: Values, high: Values) -> Array:
        first, last = self.values[0], self.values[-1]
        below, between, above = self._weights(low, high)
        left = low + (first - low) * np.minimum(share(u, below), 1.0) ** (1 / self.bend)
        right = high - (high - last) * np.minimum(share(1 - u, above), 1.0) ** (1 / self.bend)
        inner = first if self._middle is None else self._middle.ppf(np.clip(share(u - below, between), 0.0, 1.0))
        return np.where(u < below, left, np.where(1 - u < above, right, inner))

    def _isf(self, q: Array, low: Values, high: Values) -> Array:
        return -self._mirror._ppf(q, -high, -low)

    def _cdf(self, x: Values, low: Values, high: Values) -> Values:
        first, last = self.values[0], self.values[-1]
        below, between, above = self._weights(low, high)
        left = share(np.clip(x, low, first) - low, first - low) ** self.bend
        inner = np.greater_equal(x, first) if self._middle is None else self._middle.cdf(x)
        right = 1 - share(high - np.clip(x, last, high), high - last) ** self.bend
        inside = below * left + between * inner + above * np.where(np.greater_equal(x, last), right, 0.0)
        return np.where(np.greater_equal(x, high), 1.0, np.minimum(inside, 1.0))

    def _sf(self, x: Values, low: Values, high: Values) -> Values:
        return self._mirror._cdf(np.negative(x), -high, -low)

    def _mean(self, low: Values, high: Values) -> Values:
        return low + self._moments(low, high)[0]

    def _variance(self, low: Values, high: Values) -> Values:
        first, second = self._moments(low, high)
        return second - first**2

    def _moments(self, low: Values, high: Values) -> tuple[Values, Values]:
        """Mean and mean square of the distance from low."""
        rise, fall = self.values[0] - low, high - self.values[-1]
        centre = self.bend / (self.bend + 1)
        spread = centre / ((self.bend + 1) * (self.bend + 2))
        middle, variance = (
            (self.values[0], 0.0) if self._middle is None else (self._middle.mean(), self._middle.variance())
        )
        means = centre * rise, middle - low, high - low - centre * fall
        variances = spread * rise**2, variance, spread * fall**2
        weights = self._weights(low, high)
        first = sum(weight * mean for weight, mean in zip(weights, means, strict=True))
        parts = zip(weights, means, variances, strict=True)
        return first, sum(weight * (mean**2 + variance) for weight, mean, variance in parts)

    def _support(self, low: Values, high: Values) -> tuple[Values, Values]:
        return low + 0 * high, high + 0 * low


def data_column(data: Array, column: int, what: str) -> Array:
    """A column of the data without blanks.

    Raises:
        DataError: a cell is blank or no number up to 1E150, or there is no row.
    """
    if not len(data):
        raise DataError("The data hold no numbers", "Fill in the range")
    values = data[:, column]
    for row in np.flatnonzero(~np.isfinite(values)):
        raise DataError(f"Row {row + 1} of the data has no {what}", "Type a number", int(row), column)
    for row in np.flatnonzero(np.abs(values) > LARGEST):
        message = f"The number ({show(values[row])}) must be between -1E150 and 1E150"
        raise DataError(message, "Correct the number", int(row), column)
    return values
