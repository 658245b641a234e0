"""Cauchy: the ratio of two normals; its tails are so heavy that it has no mean."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.located import Located

__all__ = ["Cauchy"]


class Cauchy(Located):
    """Cauchy with location, its median, and scale, half the distance between its quartiles. It has no mean.

    The mean of many draws is as uncertain as one draw. Median and percentiles are what to report.

    >>> cauchy = Cauchy()
    >>> print(cauchy.ppf(np.array([0.1, 0.5, 0.75]), location=10, scale=2).round(6))
    [ 3.844633 10.       12.      ]
    >>> print(cauchy.mean(location=10, scale=2))
    nan
    >>> cauchy.check(location=10, scale=-1)
    'Scale (-1) must be above 0'
    """

    name = "Cauchy"
    lowest = -np.inf
    open_below = True
    formula = "P(X ≤ x) = 1/2 + arctan((x − Location)/Scale)/π; it has no mean and no variance"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 1, ch. 16"
    elsewhere = ("@RISK Cauchy(location, scale)",)

    def _quantile(self, u: Array) -> Array:
        # The tangent from the nearest of 0, 1/2 and 1, where it keeps its digits.
        tail = np.minimum(u, 1 - u)
        far = np.copysign(1 / np.tan(np.pi * np.maximum(tail, 1e-300)), u - 0.5)
        return np.where(tail < 0.25, far, np.tan(np.pi * (u - 0.5)))

    def _quantile_above(self, q: Array) -> Array:
        return -self._quantile(q)

    def _below(self, z: Array) -> Values:
        return np.arctan2(1.0, -z) / np.pi

    def _above(self, z: Array) -> Values:
        return np.arctan2(1.0, z) / np.pi

    def _moments(self) -> tuple[Values, Values]:
        return np.nan, np.nan
