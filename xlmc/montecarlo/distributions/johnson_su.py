"""Johnson SU: a normal through a hyperbolic sine; any skewness, with heavier tails than the normal's."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends
from xlmc.montecarlo.distributions.located import SHAPE_1, SHAPE_2
from xlmc.montecarlo.distributions.parameters import LOCATION, SCALE, above_zero

__all__ = ["JohnsonSU"]


class JohnsonSU(Family):
    """Johnson SU with location, scale, and two shapes: the first skews, the second thins the tails.

    >>> johnson = JohnsonSU()
    >>> print(johnson.ppf(np.array([0.1, 0.5, 0.9]), location=10, scale=2, shape_1=-1, shape_2=2).round(6))
    [ 9.717518 11.042191 12.809624]
    >>> johnson.check(scale=2, shape_1=0, shape_2=0)
    'Shape 2 (0) must be above 0'
    """

    name = "Johnson SU"
    parameters = (LOCATION, SCALE, SHAPE_1, SHAPE_2)
    rules = (above_zero(parameters, "scale"), above_zero(parameters, "shape_2"))
    open_below = True
    formula = "Shape 1 + Shape 2·arsinh((X − Location)/Scale) is standard normal"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 1, ch. 12, section 4.3"
    elsewhere = ("@RISK JohnsonSU(alpha1, alpha2, gamma, beta): both shapes, location, scale",)

    def _ppf(self, u: Array, location: Values, scale: Values, first: Values, second: Values) -> Array:
        from scipy.special import ndtri

        return np.asarray(location + scale * np.sinh((ndtri(u) - first) / second))

    def _cdf(self, x: Values, location: Values, scale: Values, first: Values, second: Values) -> Values:
        from scipy.special import ndtr

        return np.asarray(ndtr(first + second * np.arcsinh(np.divide(x - location, scale))))

    def _mean(self, location: Values, scale: Values, first: Values, second: Values) -> Values:
        inverse = np.divide(1.0, second)
        return location - scale * np.exp(inverse**2 / 2) * np.sinh(first * inverse)

    def _variance(self, location: Values, scale: Values, first: Values, second: Values) -> Values:
        inverse = np.divide(1.0, second)
        square = inverse**2
        spread = np.expm1(square) * (np.exp(square) * np.cosh(2 * first * inverse) + 1) / 2
        return np.asarray(np.square(scale) * spread + 0 * location)

    def _support(self, location: Values, scale: Values, first: Values, second: Values) -> tuple[Values, Values]:
        return ends(-np.inf, np.inf, location, scale, first, second)

    def _mirrored(self, location: Values, scale: Values, first: Values, second: Values) -> tuple[Values, ...]:
        return np.negative(location), scale, np.negative(first), second
