"""Hyperbolic secant: like the normal, with a sharper peak and heavier tails."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends
from xlmc.montecarlo.distributions.parameters import MEAN, STD_DEV, above_zero

__all__ = ["HyperbolicSecant"]


class HyperbolicSecant(Family):
    """Hyperbolic secant with mean and standard deviation.

    >>> secant = HyperbolicSecant()
    >>> print(secant.ppf(np.array([0.1, 0.5, 0.9]), mean=10, std_dev=2).round(6))
    [ 7.653763 10.       12.346237]
    >>> secant.check(mean=10, std_dev=-1)
    'Std dev (-1) must be above 0'
    """

    name = "Hyperbolic secant"
    aliases = ("HypSecant",)
    parameters = (MEAN, STD_DEV)
    roles = ("location", "scale")
    rules = (above_zero(parameters, "std_dev"),)
    open_below = True
    formula = "density 1 / (2·Std dev·cosh(π·(x − Mean)/(2·Std dev)))"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 2, ch. 23, section 11"
    elsewhere = ("@RISK HypSecant(gamma, beta)",)

    def _ppf(self, u: Array, mean: Values, std_dev: Values) -> Array:
        tail = np.minimum(u, 1 - u)
        distance = np.log(np.tan(tail * (np.pi / 2))) * np.divide(std_dev, np.pi / 2)
        return mean + np.where(u < 0.5, distance, -distance)

    def _cdf(self, x: Values, mean: Values, std_dev: Values) -> Values:
        z = np.divide(x - mean, std_dev)
        tail = np.arctan(np.exp(-np.abs(z) * (np.pi / 2))) * (2 / np.pi)
        return np.where(z < 0, tail, 1 - tail)

    def _mean(self, mean: Values, std_dev: Values) -> Values:
        return mean + 0 * std_dev

    def _variance(self, mean: Values, std_dev: Values) -> Values:
        return np.square(std_dev) + 0 * mean

    def _support(self, mean: Values, std_dev: Values) -> tuple[Values, Values]:
        return ends(-np.inf, np.inf, mean, std_dev)

    def _mirrored(self, mean: Values, std_dev: Values) -> tuple[Values, ...]:
        return -mean, std_dev
