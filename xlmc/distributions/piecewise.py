"""Distributions drawn from points: a density that runs in straight lines, or a distribution function that does."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from xlmc.distributions.base import Array, DataError, Family, Values

__all__ = ["Piecewise"]


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
            raise DataError("The points are no density", "Values must rise, heights must be 0 or more, one above 0")
        self.left, self.right, self.areas = self.left / area, self.right / area, areas / area
        self.below = np.concatenate(([0.0], np.cumsum(self.areas)))

    @classmethod
    def of_density(cls, values: ArrayLike, heights: ArrayLike) -> Piecewise:
        """The density through these points, up to a common factor."""
        heights = np.asarray(heights, dtype=float)
        return cls(values, heights[:-1], heights[1:])

    @classmethod
    def of_distribution(cls, values: ArrayLike, probabilities: ArrayLike) -> Piecewise:
        """The distribution function through these points; the first probability is taken for 0, the last for 1."""
        with np.errstate(all="ignore"):  # what is too large is refused
            heights = np.diff(np.asarray(probabilities, dtype=float)) / np.diff(np.asarray(values, dtype=float))
        return cls(values, heights, heights)

    @classmethod
    def of_weights(cls, low: float, high: float, weights: Sequence[float] | Array) -> Piecewise:
        """A histogram: intervals of one width, each with its weight."""
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
        """The quantile of u, up to 0.5: from the start of its interval so far that the area between is what is left."""
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
        """The first or second moment about the lowest edge."""
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
