"""Lognormal: products of many positive factors; told by its own mean and standard deviation."""

from __future__ import annotations

import numpy as np

from xlmc.distributions.base import Array, Family, Values, ends
from xlmc.distributions.lognorm2 import Lognorm2
from xlmc.distributions.parameters import LOCATION, MEAN, STD_DEV, Constraint, above_zero

__all__ = ["Lognormal"]

_BY_LOGARITHMS = Lognorm2()


class Lognormal(Family):
    """Lognormal with location, its lowest value, and mean and standard deviation of X itself.

    >>> lognormal = Lognormal()
    >>> print(lognormal.ppf(np.array([0.1, 0.5, 0.9]), mean=10, std_dev=3).round(6))
    [ 6.575059  9.578263 13.953202]
    >>> lognormal.check(mean=-1, std_dev=3)
    'Mean (-1) must be above Location (0)'
    >>> print(lognormal.ppf(0.5, mean=10.0, std_dev=np.array([3.0, 0.0])).round(6))
    [9.578263      nan]
    """

    name = "Lognormal"
    aliases = ("Lognorm",)
    parameters = (LOCATION, MEAN, STD_DEV)
    roles = ("ordered", "ordered", "scale")
    rules = (
        Constraint(
            "mean",
            lambda location, mean, _std_dev: mean > location,
            "Mean ({mean}) must be above Location ({location})",
            "Location is the lowest possible value, 0 if left blank",
        ),
        above_zero(parameters, "std_dev"),
    )
    open_below = True
    formula = (
        "ln(X − Location) is normal with variance σ² = ln(1 + (Std dev/(Mean − Location))²)"
        " and mean ln(Mean − Location) − σ²/2"
    )
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 1, ch. 14"
    elsewhere = ("Crystal Ball Lognormal (location, mean, std dev)", "@RISK Lognorm(mean, std dev)")

    def _ppf(self, u: Array, location: Values, mean: Values, std_dev: Values) -> Array:
        return _BY_LOGARITHMS._ppf(u, location, *_of_logarithm(mean - location, std_dev))

    def _isf(self, q: Array, location: Values, mean: Values, std_dev: Values) -> Array:
        return _BY_LOGARITHMS._isf(q, location, *_of_logarithm(mean - location, std_dev))

    def _cdf(self, x: Values, location: Values, mean: Values, std_dev: Values) -> Values:
        return _BY_LOGARITHMS._cdf(x, location, *_of_logarithm(mean - location, std_dev))

    def _sf(self, x: Values, location: Values, mean: Values, std_dev: Values) -> Values:
        return _BY_LOGARITHMS._sf(x, location, *_of_logarithm(mean - location, std_dev))

    def _mean(self, location: Values, mean: Values, std_dev: Values) -> Values:
        return mean + 0 * (location + std_dev)

    def _variance(self, location: Values, mean: Values, std_dev: Values) -> Values:
        return std_dev**2 + 0 * (location + mean)

    def _support(self, location: Values, mean: Values, std_dev: Values) -> tuple[Values, Values]:
        low, high = ends(0.0, np.inf, location, mean, std_dev)
        return low + location, high


def _of_logarithm(mean: Values, std_dev: Values) -> tuple[Values, Values]:
    """Mean and standard deviation of ln X from those of X."""
    ratio = np.divide(std_dev, mean)
    # The square of a large ratio may overflow.
    variance = np.where(ratio < 1, np.log1p(np.minimum(ratio, 1.0) ** 2), 2 * np.log(np.hypot(1.0, ratio)))
    return np.log(mean) - variance / 2, np.sqrt(variance)
