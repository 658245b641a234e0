"""Logistic: like the normal, with heavier tails."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends
from xlmc.montecarlo.distributions.parameters import MEAN, SCALE, above_zero

__all__ = ["Logistic"]


class Logistic(Family):
    """Logistic with mean and scale; the standard deviation is scale·π/√3.

    >>> logistic = Logistic()
    >>> print(logistic.ppf(np.array([0.1, 0.5, 0.9]), mean=10, scale=2).round(6))
    [ 5.605551 10.       14.394449]
    >>> logistic.check(mean=10, scale=-2)
    'Scale (-2) must be above 0'
    >>> print(logistic.ppf(0.5, 10.0, np.array([2.0, -1.0])))
    [10. nan]
    """

    name = "Logistic"
    parameters = (MEAN, SCALE)
    roles = ("location", "scale")
    rules = (above_zero(parameters, "scale"),)
    open_below = True
    formula = "P(X ≤ x) = 1 / (1 + exp(−(x − Mean)/Scale)); standard deviation Scale·π/√3"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 2, ch. 23"
    elsewhere = ("Crystal Ball Logistic (mean, scale)", "@RISK Logistic(mean, scale)")

    def _ppf(self, u: Array, mean: Values, scale: Values) -> Array:
        from scipy.special import logit

        logit(u, out=u)
        u *= scale
        u += mean
        return u

    def _cdf(self, x: Values, mean: Values, scale: Values) -> Values:
        from scipy.special import expit

        with np.errstate(over="ignore"):
            return expit(np.divide(x - mean, scale))  # type: ignore[no-any-return]  # SciPy has no types

    def _mean(self, mean: Values, scale: Values) -> Values:
        return mean + 0 * scale

    def _variance(self, mean: Values, scale: Values) -> Values:
        return scale**2 * (np.pi**2 / 3) + 0 * mean

    def _support(self, mean: Values, scale: Values) -> tuple[Values, Values]:
        return ends(-np.inf, np.inf, mean, scale)

    def _mirrored(self, mean: Values, scale: Values) -> tuple[Values, ...]:
        return -mean, scale
