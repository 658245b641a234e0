"""Pareto of the second kind (Lomax): what exceeds a threshold, counted from it; its tail falls as a power."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.located import Located, when_above
from xlmc.montecarlo.distributions.parameters import LOCATION, SCALE, SHAPE, above_zero

__all__ = ["Pareto2"]


class Pareto2(Located):
    """Pareto of the second kind with location, its lowest value, scale and shape.

    The mean is infinite up to shape 1, the variance up to 2.

    >>> pareto2 = Pareto2()
    >>> print(pareto2.ppf(np.array([0.0, 0.5, 0.9]), scale=2, shape=3).round(6))
    [0.       0.519842 2.308869]
    >>> pareto2.check(scale=2, shape=0)
    'Shape (0) must be above 0'
    """

    name = "Pareto2"
    aliases = ("Lomax", "Pareto II")
    parameters = (LOCATION, SCALE, SHAPE)
    roles = ("location", "scale", "shape")
    rules = (above_zero(parameters, "scale"), above_zero(parameters, "shape"))
    formula = "P(X > x) = (1 + (x − Location)/Scale)^(−Shape), x ≥ Location"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 1, ch. 20"
    elsewhere = ("@RISK Pareto2(b, q): scale, shape",)

    def _quantile(self, u: Array, shape: Values) -> Array:
        return np.asarray(np.expm1(-np.log1p(-u) / shape))

    def _quantile_above(self, q: Array, shape: Values) -> Array:
        return np.asarray(np.expm1(-np.log(q) / shape))

    def _below(self, z: Array, shape: Values) -> Values:
        return -np.expm1(-shape * np.log1p(z))

    def _above(self, z: Array, shape: Values) -> Values:
        return np.exp(-shape * np.log1p(z))

    def _moments(self, shape: Values) -> tuple[Values, Values]:
        mean = when_above(shape, 1.0, lambda s: 1 / (s - 1))
        return mean, when_above(shape, 2.0, lambda s: s / (s - 1) ** 2 / (s - 2))
