"""Log-logistic: its logarithm is logistic; lifetimes and claims with a tail that falls as a power."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.located import Located, when_above
from xlmc.montecarlo.distributions.parameters import LOCATION, SCALE, SHAPE, above_zero

__all__ = ["LogLogistic"]


class LogLogistic(Located):
    """Log-logistic with location, its lowest value, scale, its median above that, and shape.

    The mean is infinite up to shape 1, the variance up to 2.

    >>> log_logistic = LogLogistic()
    >>> print(log_logistic.ppf(np.array([0.0, 0.5, 0.9]), location=1, scale=2, shape=3).round(6))
    [1.000008 3.       5.160168]
    >>> log_logistic.check(scale=2, shape=0)
    'Shape (0) must be above 0'
    """

    name = "Log-logistic"
    aliases = ("Fisk",)
    parameters = (LOCATION, SCALE, SHAPE)
    roles = ("location", "scale", "shape")
    rules = (above_zero(parameters, "scale"), above_zero(parameters, "shape"))
    open_below = True
    formula = "P(X ≤ x) = 1 / (1 + ((x − Location)/Scale)^(−Shape)), x ≥ Location"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 2, ch. 23, section 11"
    elsewhere = ("@RISK Loglogistic(gamma, beta, alpha): location, scale, shape",)

    def _quantile(self, u: Array, shape: Values) -> Array:
        from scipy.special import logit

        return np.asarray(np.exp(logit(u) / shape))

    def _quantile_above(self, q: Array, shape: Values) -> Array:
        from scipy.special import logit

        return np.asarray(np.exp(-logit(q) / shape))

    def _below(self, z: Array, shape: Values) -> Values:
        from scipy.special import expit

        return np.asarray(expit(shape * np.log(z)))

    def _above(self, z: Array, shape: Values) -> Values:
        from scipy.special import expit

        return np.asarray(expit(-shape * np.log(z)))

    def _moments(self, shape: Values) -> tuple[Values, Values]:
        mean = when_above(shape, 1.0, lambda s: 1 / np.sinc(1 / s))
        square = when_above(shape, 2.0, lambda s: 1 / np.sinc(2 / s) - 1 / np.sinc(1 / s) ** 2)
        return mean, square
