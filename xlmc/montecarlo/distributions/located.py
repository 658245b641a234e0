"""Families that are moved and stretched: quantile = location + scale · q(u; shapes).

A family writes the four functions of its standard form, at location 0 and scale 1, and its two moments there; the rest
follows. Shapes as in `base`.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import Any

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends
from xlmc.montecarlo.distributions.parameters import LOCATION, SCALE, Constraint, ParameterSpec, Role, above_zero

__all__ = ["SHAPE_1", "SHAPE_2", "Located", "when_above"]

SHAPE_1 = ParameterSpec("shape_1", ("Shape 1", "Alpha1", "First shape"))
SHAPE_2 = ParameterSpec("shape_2", ("Shape 2", "Alpha2", "Second shape"))


class Located(Family):
    """A family with location, scale and any shapes, in that order.

    Attributes:
        lowest: the lowest possible value of the standard form.
    """

    parameters: tuple[ParameterSpec, ...] = (LOCATION, SCALE)
    roles: tuple[Role, ...] = ("location", "scale")
    rules: tuple[Constraint, ...] = (above_zero(parameters, "scale"),)
    lowest = 0.0

    @abstractmethod
    def _quantile(self, u: Array, *shapes: Any) -> Array:
        """Return the value that is not exceeded with probability u."""

    @abstractmethod
    def _quantile_above(self, q: Array, *shapes: Any) -> Array:
        """Return the value that is exceeded with probability q."""

    @abstractmethod
    def _below(self, z: Array, *shapes: Any) -> Values:
        """P(Z <= z), for z from `lowest` up."""

    @abstractmethod
    def _above(self, z: Array, *shapes: Any) -> Values:
        """P(Z > z), for z from `lowest` up."""

    @abstractmethod
    def _moments(self, *shapes: Any) -> tuple[Values, Values]:
        """Mean and variance; infinite or NaN where there is none."""

    def _ppf(self, u: Array, location: Values, scale: Values, *shapes: Values) -> Array:
        return np.asarray(location + scale * self._quantile(u, *shapes))

    def _isf(self, q: Array, location: Values, scale: Values, *shapes: Values) -> Array:
        return np.asarray(location + scale * self._quantile_above(q, *shapes))

    def _cdf(self, x: Values, location: Values, scale: Values, *shapes: Values) -> Values:
        return self._below(self._standard(x, location, scale), *shapes)

    def _sf(self, x: Values, location: Values, scale: Values, *shapes: Values) -> Values:
        return self._above(self._standard(x, location, scale), *shapes)

    def _standard(self, x: Values, location: Values, scale: Values) -> Array:
        return np.asarray(np.maximum(np.divide(x - location, scale), self.lowest))

    def _mean(self, location: Values, scale: Values, *shapes: Values) -> Values:
        return location + scale * self._moments(*shapes)[0]

    def _variance(self, location: Values, scale: Values, *shapes: Values) -> Values:
        return np.square(scale) * self._moments(*shapes)[1] + 0 * location

    def _support(self, location: Values, scale: Values, *shapes: Values) -> tuple[Values, Values]:
        low, high = ends(self.lowest, np.inf, location, scale, *shapes)
        return low + location, high


def when_above(value: Values, limit: float, moment: Any, otherwise: float = np.inf) -> Values:
    """Return a moment where `value` is above the limit below which there is none.

    Args:
        value: of a shape.
        limit: of it.
        moment: takes shapes above the limit, and gives the moment.
        otherwise: what stands where there is none.
    """
    exists = np.greater(value, limit)
    return np.where(exists, moment(np.where(exists, value, limit + 1.0)), otherwise)
