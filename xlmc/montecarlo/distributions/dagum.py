"""Dagum (Burr type III): incomes, whose two shapes bend the beginning and the tail."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.located import SHAPE_1, SHAPE_2, Located, when_above
from xlmc.montecarlo.distributions.parameters import LOCATION, SCALE, above_zero

__all__ = ["Dagum"]


class Dagum(Located):
    """Dagum with location, its lowest value, scale and two shapes; the first is that of the tail.

    The mean is infinite up to shape 1 of 1, the variance up to 2.

    >>> dagum = Dagum()
    >>> print(dagum.ppf(np.array([0.1, 0.5, 0.9]), location=1, scale=2, shape_1=3, shape_2=2).round(6))
    [2.546653 3.683008 6.288317]
    >>> dagum.check(scale=2, shape_1=1, shape_2=0)
    'Shape 2 (0) must be above 0'
    """

    name = "Dagum"
    aliases = ("Burr III",)
    parameters = (LOCATION, SCALE, SHAPE_1, SHAPE_2)
    roles = ("ordered", "scale", "shape", "shape")
    rules = (
        above_zero(parameters, "scale"),
        above_zero(parameters, "shape_1"),
        above_zero(parameters, "shape_2"),
    )
    open_below = True
    formula = "P(X ≤ x) = (1 + ((x − Location)/Scale)^(−Shape 1))^(−Shape 2), x ≥ Location"
    source = "Kleiber and Kotz, Statistical Size Distributions in Economics and Actuarial Sciences (2003), ch. 6"
    elsewhere = ("@RISK Dagum(gamma, beta, alpha1, alpha2): location, scale, both shapes",)

    def _quantile(self, u: Array, first: Values, second: Values) -> Array:
        return np.asarray(np.expm1(-np.log(u) / second) ** np.divide(-1.0, first))

    def _quantile_above(self, q: Array, first: Values, second: Values) -> Array:
        return np.asarray(np.expm1(-np.log1p(-q) / second) ** np.divide(-1.0, first))

    def _below(self, z: Array, first: Values, second: Values) -> Values:
        return np.exp(-second * np.logaddexp(0.0, -first * np.log(z)))

    def _above(self, z: Array, first: Values, second: Values) -> Values:
        return -np.expm1(-second * np.logaddexp(0.0, -first * np.log(z)))

    def _moments(self, first: Values, second: Values) -> tuple[Values, Values]:
        from scipy.special import betaln

        def log_moment(order: int) -> Values:
            step = np.divide(order, first)
            return np.asarray(np.log(second) + betaln(second + step, np.maximum(1 - step, 1e-300)))

        once = log_moment(1)
        spread = np.exp(2 * once) * np.expm1(log_moment(2) - 2 * once)
        return when_above(first, 1.0, lambda _: np.exp(once)), when_above(first, 2.0, lambda _: spread)
