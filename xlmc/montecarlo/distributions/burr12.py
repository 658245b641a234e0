"""Burr type XII: incomes, losses and lifetimes; two shapes bend the beginning and the tail."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.located import SHAPE_1, SHAPE_2, Located, when_above
from xlmc.montecarlo.distributions.parameters import LOCATION, SCALE, above_zero

__all__ = ["Burr12"]


class Burr12(Located):
    """Burr type XII with location, its lowest value, scale and two shapes.

    The mean is infinite where the product of the shapes is at most 1, the variance where it is at most 2.

    >>> burr = Burr12()
    >>> print(burr.ppf(np.array([0.0, 0.5, 0.9]), location=1, scale=2, shape_1=2, shape_2=3).round(6))
    [1.       2.019649 3.148892]
    >>> burr.check(scale=2, shape_1=0, shape_2=1)
    'Shape 1 (0) must be above 0'
    """

    name = "Burr12"
    aliases = ("Burr XII", "Burr", "Singh-Maddala")
    parameters = (LOCATION, SCALE, SHAPE_1, SHAPE_2)
    roles = ("ordered", "scale", "shape", "shape")
    rules = (
        above_zero(parameters, "scale"),
        above_zero(parameters, "shape_1"),
        above_zero(parameters, "shape_2"),
    )
    formula = "P(X > x) = (1 + ((x − Location)/Scale)^Shape 1)^(−Shape 2), x ≥ Location"
    source = "Burr, Annals of Mathematical Statistics 13 (1942), 215–232, type XII"
    elsewhere = ("@RISK Burr12(gamma, beta, alpha1, alpha2): location, scale, both shapes",)

    def _quantile(self, u: Array, first: Values, second: Values) -> Array:
        return np.asarray(np.expm1(-np.log1p(-u) / second) ** np.divide(1.0, first))

    def _quantile_above(self, q: Array, first: Values, second: Values) -> Array:
        return np.asarray(np.expm1(-np.log(q) / second) ** np.divide(1.0, first))

    def _below(self, z: Array, first: Values, second: Values) -> Values:
        return -np.expm1(-second * np.logaddexp(0.0, first * np.log(z)))

    def _above(self, z: Array, first: Values, second: Values) -> Values:
        return np.exp(-second * np.logaddexp(0.0, first * np.log(z)))

    def _moments(self, first: Values, second: Values) -> tuple[Values, Values]:
        from scipy.special import betaln

        def log_moment(order: int) -> Values:
            step = np.divide(order, first)
            return np.asarray(np.log(second) + betaln(np.maximum(second - step, 1e-300), 1 + step))

        both, once = np.multiply(first, second), log_moment(1)
        spread = np.exp(2 * once) * np.expm1(log_moment(2) - 2 * once)
        return (
            when_above(both, 1.0, lambda _: np.exp(once)),
            when_above(both, 2.0, lambda _: spread),
        )
