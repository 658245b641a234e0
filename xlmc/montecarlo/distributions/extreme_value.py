"""Maximum and Minimum Extreme: the largest and the smallest of many independent values (Gumbel, type I)."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends
from xlmc.montecarlo.distributions.parameters import LIKELIEST, SCALE, Constraint, ParameterSpec, Role, above_zero

__all__ = ["MaximumExtreme", "MinimumExtreme"]


class _Extreme:
    """What both have in common, as mirror images of each other."""

    parameters: tuple[ParameterSpec, ...] = (LIKELIEST, SCALE)
    roles: tuple[Role, ...] = ("location", "scale")
    rules: tuple[Constraint, ...] = (above_zero(parameters, "scale"),)
    open_below = True
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 2, ch. 22"

    def _variance(self, likeliest: Values, scale: Values) -> Values:
        return scale**2 * (np.pi**2 / 6) + 0 * likeliest

    def _support(self, likeliest: Values, scale: Values) -> tuple[Values, Values]:
        return ends(-np.inf, np.inf, likeliest, scale)


class MaximumExtreme(_Extreme, Family):
    """Maximum Extreme with its likeliest value and scale; it has a long tail above.

    >>> largest = MaximumExtreme()
    >>> print(largest.ppf(np.array([0.1, 0.5, 0.9]), likeliest=10, scale=2).round(6))
    [ 8.331935 10.733026 14.500735]
    >>> largest.check(likeliest=10, scale=-1)
    'Scale (-1) must be above 0'
    >>> print(largest.ppf(0.5, 10.0, np.array([2.0, -1.0])).round(6))
    [10.733026       nan]
    """

    name = "Maximum Extreme"
    aliases = ("Max Extreme", "Extvalue", "Gumbel", "Extreme value")
    formula = "P(X ≤ x) = exp(−exp(−(x − Likeliest)/Scale)); mean Likeliest + 0.5772·Scale"
    elsewhere = ("Crystal Ball Maximum Extreme (likeliest, scale)", "@RISK Extvalue(mode, scale)")

    def _ppf(self, u: Array, likeliest: Values, scale: Values) -> Array:
        np.log(u, out=u)
        np.negative(u, out=u)
        np.log(u, out=u)
        u *= -scale
        u += likeliest
        return u

    def _isf(self, q: Array, likeliest: Values, scale: Values) -> Array:
        return likeliest - scale * np.log(-np.log1p(-q))

    def _cdf(self, x: Values, likeliest: Values, scale: Values) -> Values:
        with np.errstate(over="ignore"):
            return np.exp(-np.exp(-np.divide(x - likeliest, scale)))

    def _sf(self, x: Values, likeliest: Values, scale: Values) -> Values:
        with np.errstate(over="ignore"):
            return -np.expm1(-np.exp(-np.divide(x - likeliest, scale)))

    def _mean(self, likeliest: Values, scale: Values) -> Values:
        return likeliest + np.euler_gamma * scale


class MinimumExtreme(_Extreme, Family):
    """Minimum Extreme with its likeliest value and scale; it has a long tail below.

    >>> smallest = MinimumExtreme()
    >>> print(smallest.ppf(np.array([0.1, 0.5, 0.9]), likeliest=10, scale=2).round(6))
    [ 5.499265  9.266974 11.668065]
    >>> smallest.check(likeliest=10, scale=-1)
    'Scale (-1) must be above 0'
    >>> print(smallest.ppf(0.5, 10.0, np.array([2.0, -1.0])).round(6))
    [9.266974      nan]
    """

    name = "Minimum Extreme"
    aliases = ("Min Extreme", "ExtvalueMin")
    formula = "P(X > x) = exp(−exp((x − Likeliest)/Scale)); mean Likeliest − 0.5772·Scale"
    elsewhere = ("Crystal Ball Minimum Extreme (likeliest, scale)", "@RISK ExtvalueMin(mode, scale)")

    def _ppf(self, u: Array, likeliest: Values, scale: Values) -> Array:
        np.negative(u, out=u)
        np.log1p(u, out=u)
        np.negative(u, out=u)
        np.log(u, out=u)
        u *= scale
        u += likeliest
        return u

    def _isf(self, q: Array, likeliest: Values, scale: Values) -> Array:
        return likeliest + scale * np.log(-np.log(q))

    def _cdf(self, x: Values, likeliest: Values, scale: Values) -> Values:
        with np.errstate(over="ignore"):
            return -np.expm1(-np.exp(np.divide(x - likeliest, scale)))

    def _sf(self, x: Values, likeliest: Values, scale: Values) -> Values:
        with np.errstate(over="ignore"):
            return np.exp(-np.exp(np.divide(x - likeliest, scale)))

    def _mean(self, likeliest: Values, scale: Values) -> Values:
        return likeliest - np.euler_gamma * scale
