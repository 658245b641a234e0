"""Beta: between two limits, in shapes from a bathtub over a flat top to a narrow peak."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, share
from xlmc.montecarlo.distributions.parameters import HIGH, LOW, ParameterSpec, above_zero, at_most, rising

__all__ = ["Beta"]

_NARROW = "So narrow a Beta is Normal: give its mean and standard deviation"


class Beta(Family):
    """Beta on [low, high] with the shapes alpha and beta; low = high is a constant.

    >>> beta = Beta()
    >>> print(beta.ppf(np.array([0.0, 0.5, 0.9]), low=10, high=20, alpha=2, beta=3).round(6))
    [10.       13.857276 16.795394]
    >>> beta.check(low=10, high=20, alpha=0, beta=3)
    'Alpha (0) must be above 0'
    >>> print(beta.ppf(0.5, 10.0, 20.0, np.array([2.0, 0.0]), 3.0).round(6))
    [13.857276       nan]
    """

    name = "Beta"
    aliases = ("Beta general", "Beta2")
    parameters = (LOW, HIGH, ParameterSpec("alpha", ("Alpha",)), ParameterSpec("beta", ("Beta",)))
    roles = ("ordered", "ordered", "shape", "shape")
    rules = (
        rising(parameters, "low", "high"),
        above_zero(parameters, "alpha"),
        above_zero(parameters, "beta"),
        at_most(parameters, "alpha", 1e6, _NARROW),
        at_most(parameters, "beta", 1e6, _NARROW),
    )
    formula = "density ∝ z^(Alpha − 1) · (1 − z)^(Beta − 1), z = (x − Low)/(High − Low)"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 2, ch. 25"
    elsewhere = (
        "Crystal Ball Beta (minimum, maximum, alpha, beta)",
        "@RISK BetaGeneral(alpha, beta, min, max)",
        "@RISK Beta(alpha, beta) with Low 0 and High 1",
    )

    def _ppf(self, u: Array, low: Values, high: Values, alpha: Values, beta: Values) -> Array:
        from scipy.special import betaincinv

        betaincinv(alpha, beta, u, out=u)
        u *= high - low
        u += low
        return np.minimum(u, high, out=u)

    def _cdf(self, x: Values, low: Values, high: Values, alpha: Values, beta: Values) -> Values:
        from scipy.special import betainc, betaincc

        near = np.clip(x, low, high)
        left, right = share(near - low, high - low), share(high - near, high - low)
        # From the nearer end, where the density may be infinite.
        inside = np.where(left < right, betainc(alpha, beta, left), betaincc(beta, alpha, right))
        return np.where(high > low, inside, x >= low)

    def _mean(self, low: Values, high: Values, alpha: Values, beta: Values) -> Values:
        return low + (high - low) * np.divide(alpha, alpha + beta)

    def _variance(self, low: Values, high: Values, alpha: Values, beta: Values) -> Values:
        whole = alpha + beta
        return (high - low) ** 2 * np.divide(alpha, whole) * np.divide(beta, whole) / (whole + 1)

    def _support(self, low: Values, high: Values, alpha: Values, beta: Values) -> tuple[Values, Values]:
        inner = 0 * (alpha + beta)
        return low + inner, high + inner

    def _mirrored(self, low: Values, high: Values, alpha: Values, beta: Values) -> tuple[Values, ...]:
        return -high, -low, beta, alpha
