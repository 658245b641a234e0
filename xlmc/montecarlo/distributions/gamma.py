"""Gamma: sums of exponential waits; skewed, and nearly normal for a large shape."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends
from xlmc.montecarlo.distributions.parameters import LOCATION, SCALE, SHAPE, above_zero, at_most

__all__ = ["Gamma"]


class Gamma(Family):
    """Gamma with location, its lowest value, scale and shape; the mean is location + scale·shape.

    >>> gamma = Gamma()
    >>> print(gamma.ppf(np.array([0.0, 0.5, 0.9]), location=1, scale=2, shape=3).round(6))
    [ 1.        6.348121 11.644641]
    >>> gamma.check(scale=2, shape=-3)
    'Shape (-3) must be above 0'
    >>> print(gamma.ppf(0.5, scale=2.0, shape=np.array([3.0, -3.0])).round(6))
    [5.348121      nan]
    """

    name = "Gamma"
    parameters = (LOCATION, SCALE, SHAPE)
    roles = ("location", "scale", "shape")
    rules = (
        above_zero(parameters, "scale"),
        above_zero(parameters, "shape"),
        at_most(parameters, "shape", 1e6, "So narrow a Gamma is Normal: mean Scale·Shape, Std dev Scale·√Shape"),
    )
    formula = "density (x − Location)^(Shape − 1) · exp(−(x − Location)/Scale) / (Scale^Shape · Γ(Shape)), x ≥ Location"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 1, ch. 17"
    elsewhere = (
        "Crystal Ball Gamma (location, scale, shape)",
        "@RISK Gamma(shape, scale)",
        "@RISK Erlang(shape, scale)",
        "@RISK ChiSq(ν): Shape ν/2, Scale 2",
    )

    def _ppf(self, u: Array, location: Values, scale: Values, shape: Values) -> Array:
        from scipy.special import gammaincinv

        gammaincinv(shape, u, out=u)
        u *= scale
        u += location
        return u

    def _isf(self, q: Array, location: Values, scale: Values, shape: Values) -> Array:
        from scipy.special import gammainccinv

        return location + scale * gammainccinv(shape, q)  # type: ignore[no-any-return]  # SciPy has no types

    def _cdf(self, x: Values, location: Values, scale: Values, shape: Values) -> Values:
        from scipy.special import gammainc

        return np.minimum(gammainc(shape, _distance(x, location, scale)), 1.0)  # type: ignore[no-any-return]

    def _sf(self, x: Values, location: Values, scale: Values, shape: Values) -> Values:
        from scipy.special import gammaincc

        return gammaincc(shape, _distance(x, location, scale))  # type: ignore[no-any-return]

    def _mean(self, location: Values, scale: Values, shape: Values) -> Values:
        return location + scale * shape

    def _variance(self, location: Values, scale: Values, shape: Values) -> Values:
        return scale**2 * shape + 0 * location

    def _support(self, location: Values, scale: Values, shape: Values) -> tuple[Values, Values]:
        low, high = ends(0.0, np.inf, location, scale, shape)
        return low + location, high


def _distance(x: Values, location: Values, scale: Values) -> Values:
    with np.errstate(over="ignore"):
        return np.divide(np.maximum(x - location, 0.0), scale)
