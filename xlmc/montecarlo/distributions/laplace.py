"""Laplace: two exponentials back to back; differences and returns with a sharp peak and heavy tails."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends
from xlmc.montecarlo.distributions.parameters import MEAN, STD_DEV, above_zero

__all__ = ["Laplace"]


class Laplace(Family):
    """Laplace with mean and standard deviation.

    >>> laplace = Laplace()
    >>> print(laplace.ppf(np.array([0.1, 0.5, 0.9]), mean=10, std_dev=2).round(6))
    [ 7.723911 10.       12.276089]
    >>> laplace.check(mean=10, std_dev=-1)
    'Std dev (-1) must be above 0'
    """

    name = "Laplace"
    aliases = ("Double exponential",)
    parameters = (MEAN, STD_DEV)
    roles = ("location", "scale")
    rules = (above_zero(parameters, "std_dev"),)
    open_below = True
    formula = "density exp(−√2·|x − Mean|/Std dev) / (√2·Std dev)"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 2, ch. 24"
    elsewhere = ("@RISK Laplace(mu, sigma)",)

    def _ppf(self, u: Array, mean: Values, std_dev: Values) -> Array:
        distance = np.log(2 * np.minimum(u, 1 - u)) * np.divide(std_dev, np.sqrt(2))
        return np.asarray(mean + np.where(u < 0.5, distance, -distance))

    def _cdf(self, x: Values, mean: Values, std_dev: Values) -> Values:
        z = np.divide(x - mean, std_dev) * np.sqrt(2)
        tail = np.exp(-np.abs(z)) / 2
        return np.asarray(np.where(z < 0, tail, 1 - tail))

    def _mean(self, mean: Values, std_dev: Values) -> Values:
        return mean + 0 * std_dev

    def _variance(self, mean: Values, std_dev: Values) -> Values:
        return np.square(std_dev) + 0 * mean

    def _support(self, mean: Values, std_dev: Values) -> tuple[Values, Values]:
        return ends(-np.inf, np.inf, mean, std_dev)

    def _mirrored(self, mean: Values, std_dev: Values) -> tuple[Values, ...]:
        return -mean, std_dev
