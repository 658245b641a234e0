"""Pearson type VI: the ratio of two gammas."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.located import SHAPE_1, SHAPE_2, Located, when_above
from xlmc.montecarlo.distributions.parameters import LOCATION, SCALE, above_zero

__all__ = ["Pearson6"]


class Pearson6(Located):
    """Pearson type VI, the beta prime, with location, its lowest value, scale and two shapes.

    The mean is infinite up to shape 2 of 1, the variance up to 2.

    >>> pearson6 = Pearson6()
    >>> print(pearson6.ppf(np.array([0.1, 0.5, 0.9]), scale=2, shape_1=3, shape_2=4).round(6))
    [0.502843 1.456662 4.002502]
    >>> pearson6.check(scale=2, shape_1=0, shape_2=1)
    'Shape 1 (0) must be above 0'
    """

    name = "Pearson6"
    aliases = ("Pearson VI", "Beta prime")
    parameters = (LOCATION, SCALE, SHAPE_1, SHAPE_2)
    roles = ("ordered", "scale", "shape", "shape")
    rules = (
        above_zero(parameters, "scale"),
        above_zero(parameters, "shape_1"),
        above_zero(parameters, "shape_2"),
    )
    formula = "z/(1 + z), z = (X − Location)/Scale, is beta distributed with Shape 1 and Shape 2"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 2, ch. 27, section 8"
    elsewhere = ("@RISK Pearson6(alpha1, alpha2, beta): both shapes, scale",)

    def _quantile(self, u: Array, first: Values, second: Values) -> Array:
        from scipy.special import betaincinv

        share = betaincinv(first, second, u)
        rest = betaincinv(second, first, 1 - u)  # 1 - share, where that would lose its digits
        return np.asarray(np.where(share < 0.5, share / (1 - share), (1 - rest) / rest))

    def _quantile_above(self, q: Array, first: Values, second: Values) -> Array:
        return 1 / self._quantile(q, second, first)

    def _below(self, z: Array, first: Values, second: Values) -> Values:
        from scipy.special import betainc

        small = z < 1
        share = np.where(small, z / (1 + z), 1 / (1 + z))
        below = betainc(np.where(small, first, second), np.where(small, second, first), share)
        return np.asarray(np.where(small, below, 1 - below))

    def _above(self, z: Array, first: Values, second: Values) -> Values:
        return self._below(1 / z, second, first)

    def _moments(self, first: Values, second: Values) -> tuple[Values, Values]:
        mean = when_above(second, 1.0, lambda s: first / (s - 1))
        return mean, when_above(second, 2.0, lambda s: first * (first + s - 1) / ((s - 1) ** 2 * (s - 2)))
