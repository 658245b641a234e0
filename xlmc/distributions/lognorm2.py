"""Lognorm2: the lognormal told by the logarithms; Location + e^Y, where Y is normal with mean Mu and std dev Sigma."""

from __future__ import annotations

import numpy as np

from xlmc.distributions.base import Array, Family, Values, ends
from xlmc.distributions.parameters import LOCATION, Constraint, ParameterSpec, above_zero

__all__ = ["Lognorm2"]


class Lognorm2(Family):
    """Lognormal with mean and standard deviation of ln(X − location).

    >>> lognorm2 = Lognorm2()
    >>> print(lognorm2.ppf(np.array([0.1, 0.5, 0.9]), mu=1, sigma=0.5).round(6))
    [1.432218 2.718282 5.15917 ]
    >>> lognorm2.check(mu=1, sigma=0)
    'Sigma (0) must be above 0'
    >>> print(lognorm2.ppf(0.5, mu=1, sigma=np.array([0.5, 0.0])).round(6))
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

        return ndtr(_standard(x, location, mu, sigma))  # type: ignore[no-any-return]

    def _sf(self, x: Values, location: Values, mu: Values, sigma: Values) -> Values:
        from scipy.special import ndtr

        return ndtr(np.negative(_standard(x, location, mu, sigma)))  # type: ignore[no-any-return]

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
    """The normal score of x: minus infinity up to the location."""
    with np.errstate(divide="ignore", over="ignore"):
        return (np.log(np.maximum(x - location, 0.0)) - mu) / sigma
