"""Distributions drawn from points: a density that runs in straight lines, or a distribution function that does.

`Piecewise` is fixed. `Between` is what Cumul and General have in common: fixed points, and two ends that are
parameters.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from xlmc.montecarlo.distributions.base import LARGEST, Array, Family, Values, share
from xlmc.montecarlo.distributions.parameters import HIGH, LOW, Constraint, DataError, show

__all__ = ["BELOW", "Between", "Piecewise", "data_column"]

BELOW = Constraint(
    "low", lambda low, high: low < high, "Low ({low}) must be below High ({high})", "Correct the wrong one"
)


class Piecewise(Family):
    """A density of straight lines over neighbouring intervals. It has no parameters: an instance holds its points.

    Args:
        edges: the k + 1 ends of the k intervals, rising.
        left: the density at the left end of each interval, up to a common factor, `(k,)`, 0 or more.
        right: that at its right end.

    >>> hill = Piecewise.of_density([0, 1, 3], [0, 2, 0])
    >>> print(hill.ppf(np.array([0.0, 1 / 3, 0.5, 1 - 1 / 6])).round(6))
    [0.       1.       1.267949 2.      ]
    >>> print(Piecewise.of_distribution([0, 1, 3], [0, 0.5, 1]).ppf(np.array([0.25, 0.5, 0.75])))
    [0.5 1.  2. ]
    >>> print(Piecewise.of_weights(0, 3, [1, 2, 1]).cdf(np.array([1.0, 1.5, 2.0])))
    [0.25 0.5  0.75]
    """

    name = "Piecewise"
    parameters = ()
    formula = "density in straight lines between points"

    def __init__(self, edges: ArrayLike, left: ArrayLike, right: ArrayLike) -> None:
        self.edges, self.left, self.right = (np.asarray(each, dtype=float) for each in (edges, left, right))
        self.widths = np.diff(self.edges)
        with np.errstate(all="ignore"):  # what is too large is refused
            areas = self.widths * (self.left + self.right) / 2
            area = areas.sum()
        sound = np.all(self.widths > 0) and np.isfinite(area) and min(self.left.min(), self.right.min()) >= 0
        if not (sound and area > 0):
            raise DataError("The points are not a density", "Values must rise, heights must be 0 or more, one above 0")
        self.left, self.right, self.areas = self.left / area, self.right / area, areas / area
        self.below = np.concatenate(([0.0], np.cumsum(self.areas)))

    @classmethod
    def of_density(cls, values: ArrayLike, heights: ArrayLike) -> Piecewise:
        """Make the density through these points, up to a common factor."""
        heights = np.asarray(heights, dtype=float)
        return cls(values, heights[:-1], heights[1:])

    @classmethod
    def of_distribution(cls, values: ArrayLike, probabilities: ArrayLike) -> Piecewise:
        """Make the distribution function through these points; the first probability is taken for 0, the last for 1."""
        with np.errstate(all="ignore"):  # what is too large is refused
            heights = np.diff(np.asarray(probabilities, dtype=float)) / np.diff(np.asarray(values, dtype=float))
        return cls(values, heights, heights)

    @classmethod
    def of_weights(cls, low: float, high: float, weights: Sequence[float] | Array) -> Piecewise:
        """Make a histogram: intervals of one width, each with its weight."""
        return cls(np.linspace(low, high, len(weights) + 1), weights, weights)

    @cached_property
    def _mirror(self) -> Piecewise:
        return Piecewise(-self.edges[::-1], self.right[::-1], self.left[::-1])

    def _ppf(self, u: Array) -> Array:
        # Counted from the nearer end, so that the upper tail keeps its digits.
        upper = u > 0.5
        u[~upper] = self._from_below(u[~upper])
        u[upper] = -self._mirror._from_below(1 - u[upper])
        return u

    def _isf(self, q: Array) -> Array:
        return -self._mirror._ppf(q)

    def _from_below(self, u: Array) -> Array:
        """Find the quantile of u, up to 0.5: from the start of its interval so far that the area between is what is
        left.
        """
        k = np.clip(np.searchsorted(self.below, u, side="left") - 1, 0, self.areas.size - 1)
        start, slope = self.left[k], (self.right[k] - self.left[k]) / self.widths[k]
        area = np.maximum(u - self.below[k], 0.0)
        root = start + np.sqrt(np.maximum(start**2 + 2 * slope * area, 0.0))
        step = 2 * area / np.where(root > 0, root, 1.0)
        return self.edges[k] + np.clip(step, 0.0, self.widths[k])

    def _cdf(self, x: Values) -> Values:
        inside = np.clip(x, self.edges[0], self.edges[-1])
        k = np.clip(np.searchsorted(self.edges, inside, side="right") - 1, 0, self.areas.size - 1)
        step = inside - self.edges[k]
        slope = (self.right[k] - self.left[k]) / self.widths[k]
        area = self.below[k] + step * (self.left[k] + slope * step / 2)
        return np.where(np.greater_equal(x, self.edges[-1]), 1.0, np.minimum(area, 1.0))

    def _sf(self, x: Values) -> Values:
        return self._mirror._cdf(np.negative(x))

    def _mean(self) -> Values:
        return float(self.edges[0]) + self._moment(1)

    def _variance(self) -> Values:
        return self._moment(2) - self._moment(1) ** 2

    def _moment(self, order: int) -> float:
        """Return the first or second moment about the lowest edge."""
        start, width = self.edges[:-1] - self.edges[0], self.widths
        # The area over an interval is two triangles: one falling from its left height, one rising to its right height.
        falling, rising = self.left * width / 2, self.right * width / 2
        near, far = start + width / 3, start + 2 * width / 3
        if order == 1:
            return float(np.sum(falling * near + rising * far))
        spread = width**2 / 18
        return float(np.sum(falling * (near**2 + spread) + rising * (far**2 + spread)))

    def _support(self) -> tuple[Values, Values]:
        return self.edges[0], self.edges[-1]


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
            Constraint(
                "low", lambda low, high: low < high, "Low ({low}) must be below High ({high})", "Correct the wrong one"
            ),
            Constraint(
                "low",
                lambda low, _high: self._reaches(low, first, heights[0]),
                f"Low ({{low}}) leaves no room below the first value ({show(first)})",
                "Lower Low, or correct the data",
            ),
            Constraint(
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
        """Make the family of these points: `(points, 2)`, values and probabilities or heights."""
        values, heights = data_column(data, 0, "value"), self._heights(data)
        for row in np.flatnonzero(np.diff(values) <= 0):
            message = f"The value {show(values[row + 1])} is not above the one before it, {show(values[row])}"
            raise DataError(message, "Sort the rows so that the values rise", int(row) + 1, 0)
        result = type(self)(values, heights)
        _ = result._middle  # refuses values that are too near to each other
        return result

    def bind(self, params: Any, named: Any) -> tuple[Any, ...]:
        if not hasattr(self, "values"):
            raise TypeError(f"{self.name} must be built from data first")
        return super().bind(params, named)

    @abstractmethod
    def _heights(self, data: Array) -> Array:
        """Return the second column of the data.

        Raises:
            DataError: it breaks a rule of its own.
        """

    @abstractmethod
    def _reaches(self, low: Values, first: float, height: float) -> Any:
        """Whether the end is far enough below the first point, which has this height."""

    @abstractmethod
    def _weights(self, low: Values, high: Values) -> tuple[Values, Values, Values]:
        """Return the probabilities below the first point, between, and above the last."""

    @cached_property
    @abstractmethod
    def _middle(self) -> Piecewise | None:
        """The distribution between the points; otherwise None."""

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
    """Return a column of the data without blanks.

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
