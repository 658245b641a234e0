"""Lognormal: products of many positive factors; given by its own mean and standard deviation, or its logarithm's."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends, point_where
from xlmc.montecarlo.distributions.parameters import LOCATION, MEAN, STD_DEV, Constraint, ParameterSpec, above_zero

__all__ = ["Lognorm2", "Lognormal"]


class Lognorm2(Family):
    """Lognormal with mean and standard deviation of ln(X − location).

    >>> lognorm2 = Lognorm2()
    >>> print(lognorm2.ppf(np.array([0.1, 0.5, 0.9]), mu=1, sigma=0.5).round(6))
    [1.432218 2.718282 5.15917 ]
    >>> lognorm2.check(mu=1, sigma=-1)
    'Sigma (-1) must be above 0'
    >>> print(lognorm2.ppf(0.5, mu=1, sigma=np.array([0.5, -1.0])).round(6))
    [2.718282      nan]
    """

    name = "Lognorm2"
    aliases = ("Lognormal2",)
    parameters = (
        LOCATION,
        ParameterSpec("mu", ("Mu", "Log mean", "Mean of ln")),
        ParameterSpec("sigma", ("Sigma", "Log std dev", "Std dev of ln")),
    )
    roles = ("location", "log scale", "shape")
    rules = (
        above_zero(parameters, "sigma"),
        Constraint(
            "mu",
            lambda _location, mu, sigma: mu + 9 * sigma <= 345,
            "Mu ({mu}) and Sigma ({sigma}) give values above 1E150",
            "They are mean and standard deviation of ln X; for those of X itself choose Lognormal",
        ),
    )
    open_below = True
    formula = "ln(X − Location) is normal with mean Mu and standard deviation Sigma"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 1, ch. 14"
    elsewhere = ("Crystal Ball Lognormal by log mean and log std dev", "@RISK Lognorm2(mu, sigma)", "XLRisk LogNorm")

    def point(self, *values: Values) -> Values | None:
        location, mu, sigma = values
        with np.errstate(over="ignore"):
            return point_where(np.equal(sigma, 0.0), location + np.exp(mu))

    def _ppf(self, u: Array, location: Values, mu: Values, sigma: Values) -> Array:
        from scipy.special import ndtri

        ndtri(u, out=u)
        u *= sigma
        u += mu
        np.exp(u, out=u)
        u += location
        return u

    def _isf(self, q: Array, location: Values, mu: Values, sigma: Values) -> Array:
        from scipy.special import ndtri

        return location + np.exp(mu - sigma * ndtri(q))  # type: ignore[no-any-return]  # SciPy has no types

    def _cdf(self, x: Values, location: Values, mu: Values, sigma: Values) -> Values:
        from scipy.special import ndtr

        return ndtr(_standard(x, location, mu, sigma))  # type: ignore[no-any-return]  # likewise

    def _sf(self, x: Values, location: Values, mu: Values, sigma: Values) -> Values:
        from scipy.special import ndtr

        return ndtr(np.negative(_standard(x, location, mu, sigma)))  # type: ignore[no-any-return]  # likewise

    def _mean(self, location: Values, mu: Values, sigma: Values) -> Values:
        with np.errstate(over="ignore"):
            return location + np.exp(mu + np.square(sigma) / 2)

    def _variance(self, location: Values, mu: Values, sigma: Values) -> Values:
        with np.errstate(over="ignore"):
            square = np.square(sigma)
            return np.exp(2 * mu + square) * np.expm1(square) + 0 * location

    def _support(self, location: Values, mu: Values, sigma: Values) -> tuple[Values, Values]:
        low, high = ends(0.0, np.inf, location, mu, sigma)
        return low + location, high


def _standard(x: Values, location: Values, mu: Values, sigma: Values) -> Values:
    """Return the normal score of x: minus infinity up to the location."""
    with np.errstate(divide="ignore", over="ignore"):
        return (np.log(np.maximum(x - location, 0.0)) - mu) / sigma


_BY_LOGARITHMS = Lognorm2()


class Lognormal(Family):
    """Lognormal with location, its lowest value, and mean and standard deviation of X itself.

    >>> lognormal = Lognormal()
    >>> print(lognormal.ppf(np.array([0.1, 0.5, 0.9]), mean=10, std_dev=3).round(6))
    [ 6.575059  9.578263 13.953202]
    >>> lognormal.check(mean=-1, std_dev=3)
    'Mean (-1) must be above Location (0)'
    >>> print(lognormal.ppf(0.5, mean=10.0, std_dev=np.array([3.0, -1.0])).round(6))
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

    def point(self, *values: Values) -> Values | None:
        location, mean, std_dev = values
        return point_where(np.equal(std_dev, 0.0) & np.greater_equal(mean, location), mean)

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
