"""Exponential: the wait for the next event of those that come at random at a steady rate."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends
from xlmc.montecarlo.distributions.parameters import ParameterSpec, above_zero

__all__ = ["Exponential"]


class Exponential(Family):
    """Exponential with a rate: events per unit; the mean is 1/rate.

    >>> exponential = Exponential()
    >>> print(exponential.ppf(np.array([0.0, 0.5, 0.9]), rate=0.5).round(6))
    [0.       1.386294 4.60517 ]
    >>> exponential.check(rate=0)
    'Rate (0) must be above 0'
    >>> print(exponential.ppf(0.5, np.array([0.5, -0.5])).round(6))
    [1.386294      nan]
    """

    name = "Exponential"
    aliases = ("Expon", "Exp")
    parameters = (ParameterSpec("rate", ("Rate", "Lambda")),)
    roles = ("rate",)
    rules = (above_zero(parameters, "rate", "Give a positive number: 1 / mean, the number of events per unit"),)
    formula = "P(X ≤ x) = 1 − exp(−Rate·x), x ≥ 0; mean 1/Rate"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 1, ch. 19"
    elsewhere = ("Crystal Ball Exponential (rate)", "@RISK Expon(mean), whose mean is 1/Rate")

    def _ppf(self, u: Array, rate: Values) -> Array:
        np.negative(u, out=u)
        np.log1p(u, out=u)
        u /= -rate
        return u

    def _isf(self, q: Array, rate: Values) -> Array:
        return -np.log(q) / rate

    def _cdf(self, x: Values, rate: Values) -> Values:
        return -np.expm1(-rate * np.maximum(x, 0.0))

    def _sf(self, x: Values, rate: Values) -> Values:
        return np.exp(-rate * np.maximum(x, 0.0))

    def _mean(self, rate: Values) -> Values:
        return 1 / rate

    def _variance(self, rate: Values) -> Values:
        return np.square(1 / rate)

    def _support(self, rate: Values) -> tuple[Values, Values]:
        return ends(0.0, np.inf, rate)
