"""Fréchet: the largest of many values with heavy tails (extreme values, type II); floods, large losses."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.located import Located, when_above
from xlmc.montecarlo.distributions.parameters import LOCATION, SCALE, SHAPE, above_zero

__all__ = ["Frechet"]


class Frechet(Located):
    """Fréchet with location, its lowest value, scale and shape.

    The mean is infinite up to shape 1, the variance up to 2.

    >>> frechet = Frechet()
    >>> print(frechet.ppf(np.array([0.0, 0.5, 0.9]), location=1, scale=2, shape=3).round(6))
    [1.597893 3.259895 5.234518]
    >>> frechet.check(scale=2, shape=0)
    'Shape (0) must be above 0'
    """

    name = "Frechet"
    aliases = ("Fréchet", "Inverse Weibull")
    parameters = (LOCATION, SCALE, SHAPE)
    roles = ("location", "scale", "shape")
    rules = (above_zero(parameters, "scale"), above_zero(parameters, "shape"))
    open_below = True
    formula = "P(X ≤ x) = exp(−((x − Location)/Scale)^(−Shape)), x ≥ Location"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 2, ch. 22"
    elsewhere = ("@RISK Frechet(gamma, beta, alpha): location, scale, shape",)

    def _quantile(self, u: Array, shape: Values) -> Array:
        return np.asarray((-np.log(u)) ** np.divide(-1.0, shape))

    def _quantile_above(self, q: Array, shape: Values) -> Array:
        return np.asarray((-np.log1p(-q)) ** np.divide(-1.0, shape))

    def _below(self, z: Array, shape: Values) -> Values:
        return np.exp(-(z ** np.negative(shape)))

    def _above(self, z: Array, shape: Values) -> Values:
        return -np.expm1(-(z ** np.negative(shape)))

    def _moments(self, shape: Values) -> tuple[Values, Values]:
        from scipy.special import gamma, gammaln

        def variance(s: Array) -> Array:
            once = gammaln(1 - 1 / s)
            return np.asarray(np.exp(2 * once) * np.expm1(gammaln(1 - 2 / s) - 2 * once))

        return when_above(shape, 1.0, lambda s: gamma(1 - 1 / s)), when_above(shape, 2.0, variance)
