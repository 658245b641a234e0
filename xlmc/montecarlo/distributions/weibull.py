"""Weibull: times to failure, wind speeds, strengths; from the exponential (shape 1) to nearly normal (shape 3.6)."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends
from xlmc.montecarlo.distributions.parameters import LOCATION, SCALE, SHAPE, above_zero

__all__ = ["Weibull"]

_BLUNT = 500.0  # shapes above it: their gamma functions are so close to 1 that a series gives a better variance
_ZETA = (1.6449340668482264, 1.2020569031595942, 1.0823232337111382, 1.0369277551433699, 1.0173430619844491)


class Weibull(Family):
    """Weibull with location, its lowest value, scale and shape.

    >>> weibull = Weibull()
    >>> print(weibull.ppf(np.array([0.0, 0.5, 0.9]), location=1, scale=2, shape=2).round(6))
    [1.       2.665109 4.034854]
    >>> weibull.check(scale=2, shape=0)
    'Shape (0) must be above 0'
    >>> print(weibull.ppf(0.5, scale=2.0, shape=np.array([2.0, 0.0])).round(6))
    [1.665109      nan]
    """

    name = "Weibull"
    parameters = (LOCATION, SCALE, SHAPE)
    roles = ("location", "scale", "shape")
    rules = (above_zero(parameters, "scale"), above_zero(parameters, "shape"))
    formula = "P(X ≤ x) = 1 − exp(−((x − Location)/Scale)^Shape), x ≥ Location"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 1, ch. 21"
    elsewhere = (
        "Crystal Ball Weibull (location, scale, shape)",
        "@RISK Weibull(shape, scale)",
        "@RISK Rayleigh(b): Shape 2, Scale √2·b",
    )

    def _ppf(self, u: Array, location: Values, scale: Values, shape: Values) -> Array:
        np.negative(u, out=u)
        np.log1p(u, out=u)
        np.negative(u, out=u)
        return _stretched(u, location, scale, shape)

    def _isf(self, q: Array, location: Values, scale: Values, shape: Values) -> Array:
        np.log(q, out=q)
        return _stretched(np.negative(q, out=q), location, scale, shape)

    def _cdf(self, x: Values, location: Values, scale: Values, shape: Values) -> Values:
        return -np.expm1(-_power(x, location, scale, shape))

    def _sf(self, x: Values, location: Values, scale: Values, shape: Values) -> Values:
        return np.exp(-_power(x, location, scale, shape))

    def _mean(self, location: Values, scale: Values, shape: Values) -> Values:
        from scipy.special import gamma

        with np.errstate(over="ignore"):
            return location + scale * gamma(1 + 1 / shape)  # type: ignore[no-any-return]  # SciPy has no types

    def _variance(self, location: Values, scale: Values, shape: Values) -> Values:
        from scipy.special import gammaln

        with np.errstate(over="ignore", invalid="ignore"):
            e = np.divide(1.0, shape)
            series = _gamma_ratio(np.minimum(e, 1 / _BLUNT))
            ratio = np.where(e < 1 / _BLUNT, series, gammaln(1 + 2 * e) - 2 * gammaln(1 + e))
            return (scale * np.exp(gammaln(1 + e))) ** 2 * np.expm1(ratio) + 0 * location  # type: ignore[no-any-return]

    def _support(self, location: Values, scale: Values, shape: Values) -> tuple[Values, Values]:
        low, high = ends(0.0, np.inf, location, scale, shape)
        return low + location, high


def _stretched(exponential: Array, location: Values, scale: Values, shape: Values) -> Array:
    """Turn a standard exponential quantile into one of Weibull."""
    with np.errstate(over="ignore"):
        exponential **= np.divide(1.0, shape)
        exponential *= scale
        exponential += location
    return exponential


def _power(x: Values, location: Values, scale: Values, shape: Values) -> Array:
    with np.errstate(over="ignore"):
        return np.asarray(np.divide(np.maximum(x - location, 0.0), scale) ** shape)


def _gamma_ratio(e: Values) -> Values:
    """Ln Γ(1 + 2e) − 2 ln Γ(1 + e) for small e: Σ ζ(k)·(−e)^k·(2^k − 2)/k from k = 2 (Abramowitz and Stegun 6.1.33)."""
    terms = [zeta * (-e) ** k * (2**k - 2) / k for k, zeta in enumerate(_ZETA, start=2)]
    return np.sum(terms, axis=0)  # type: ignore[no-any-return]  # a number or an array
