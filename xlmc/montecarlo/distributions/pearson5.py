"""Pearson type V: one over a gamma; times and amounts with a tail that falls as a power."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.located import Located, when_above
from xlmc.montecarlo.distributions.parameters import LOCATION, SCALE, SHAPE, above_zero

__all__ = ["Pearson5"]


class Pearson5(Located):
    """Pearson type V, the inverse gamma, with location, its lowest value, scale and shape.

    The mean is infinite up to shape 1, the variance up to 2.

    >>> pearson5 = Pearson5()
    >>> print(pearson5.ppf(np.array([0.1, 0.5, 0.9]), scale=2, shape=3).round(6))
    [0.375776 0.747926 1.814774]
    >>> pearson5.check(scale=2, shape=0)
    'Shape (0) must be above 0'
    """

    name = "Pearson5"
    aliases = ("Pearson V", "Inverse gamma")
    parameters = (LOCATION, SCALE, SHAPE)
    roles = ("location", "scale", "shape")
    rules = (above_zero(parameters, "scale"), above_zero(parameters, "shape"))
    open_below = True
    formula = "Scale/(X − Location) is gamma distributed with scale 1 and Shape"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 1, ch. 17, section 8"
    elsewhere = ("@RISK Pearson5(alpha, beta): shape, scale",)

    def _quantile(self, u: Array, shape: Values) -> Array:
        from scipy.special import gammainccinv

        return np.asarray(1 / gammainccinv(shape, u))

    def _quantile_above(self, q: Array, shape: Values) -> Array:
        from scipy.special import gammaincinv

        return np.asarray(1 / gammaincinv(shape, q))

    def _below(self, z: Array, shape: Values) -> Values:
        from scipy.special import gammaincc

        return np.asarray(gammaincc(shape, 1 / z))

    def _above(self, z: Array, shape: Values) -> Values:
        from scipy.special import gammainc

        return np.asarray(gammainc(shape, 1 / z))

    def _moments(self, shape: Values) -> tuple[Values, Values]:
        mean = when_above(shape, 1.0, lambda s: 1 / (s - 1))
        return mean, when_above(shape, 2.0, lambda s: 1 / ((s - 1) ** 2 * (s - 2)))
