"""Pareto: incomes, sizes of losses; the share above x falls as a power of x."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends
from xlmc.montecarlo.distributions.parameters import SHAPE, ParameterSpec, above_zero

__all__ = ["Pareto"]


class Pareto(Family):
    """Pareto with location, its lowest value, and shape. The mean is infinite up to shape 1, the variance up to 2.

    >>> pareto = Pareto()
    >>> print(pareto.ppf(np.array([0.0, 0.5, 0.9]), location=10, shape=3).round(6))
    [10.       12.59921  21.544347]
    >>> pareto.check(location=0, shape=3)
    'Location (0) must be above 0'
    >>> print(pareto.ppf(0.5, 10.0, np.array([3.0, 0.0])).round(6))
    [12.59921      nan]
    """

    name = "Pareto"
    parameters = (ParameterSpec("location", ("Location", "Loc")), SHAPE)
    roles = ("scale", "shape")
    rules = (
        above_zero(parameters, "location", "Give the lowest possible value, a positive number"),
        above_zero(parameters, "shape"),
    )
    formula = "P(X > x) = (Location/x)^Shape, x ≥ Location"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 1, ch. 20"
    elsewhere = ("Crystal Ball Pareto (location, shape)", "@RISK Pareto(shape, min), whose min is Location")

    def _ppf(self, u: Array, location: Values, shape: Values) -> Array:
        np.negative(u, out=u)
        np.log1p(u, out=u)
        return _raised(u, location, shape)

    def _isf(self, q: Array, location: Values, shape: Values) -> Array:
        return _raised(np.log(q, out=q), location, shape)

    def _cdf(self, x: Values, location: Values, shape: Values) -> Values:
        return -np.expm1(-shape * _log_ratio(x, location))

    def _sf(self, x: Values, location: Values, shape: Values) -> Values:
        return np.exp(-shape * _log_ratio(x, location))

    def _mean(self, location: Values, shape: Values) -> Values:
        above = np.where(np.greater(shape, 1), shape, 2.0)
        return np.where(np.less_equal(shape, 1), np.inf, location * (shape / (above - 1)))

    def _variance(self, location: Values, shape: Values) -> Values:
        above = np.where(np.greater(shape, 2), shape, 3.0)
        finite = (location / (above - 1)) ** 2 * (above / (above - 2))
        return np.where(np.less_equal(shape, 2), np.inf, finite + 0 * shape)

    def _support(self, location: Values, shape: Values) -> tuple[Values, Values]:
        low, high = ends(0.0, np.inf, location, shape)
        return low + location, high


def _raised(log_above: Array, location: Values, shape: Values) -> Array:
    """Return the value above which a share lies, of which the logarithm is given."""
    with np.errstate(over="ignore"):
        log_above /= np.negative(shape)
        np.exp(log_above, out=log_above)
        log_above *= location
    return log_above


def _log_ratio(x: Values, location: Values) -> Values:
    with np.errstate(over="ignore"):
        return np.log1p(np.divide(np.maximum(x - location, 0.0), location))
