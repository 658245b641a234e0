"""Uniform: every value between two limits is equally likely.

The choice when nothing but a range is known, which is the usual state of a crash scene: it allows the value to vary
more freely within the range than any other shape ("Choosing probability distributions" in the paper).
"""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, share
from xlmc.montecarlo.distributions.parameters import HIGH, LOW, Constraint

__all__ = ["Uniform"]


class Uniform(Family):
    """Uniform on [low, high]; low = high is a constant.

    >>> uniform = Uniform()
    >>> print(uniform.ppf(np.array([0.0, 0.25, 0.5]), low=0.60, high=0.95))
    [0.6    0.6875 0.775 ]
    >>> uniform.check(low=12, high=10)
    'Low (12) is above High (10)'
    >>> print(uniform.ppf(0.5, np.array([0.0, 12.0]), 10.0))
    [ 5. nan]
    """

    name = "Uniform"
    always_finite = True
    parameters = (LOW, HIGH)
    roles = ("ordered", "ordered")
    formula = "density 1/(High − Low) from Low to High"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 2, ch. 26"
    elsewhere = ("Crystal Ball Uniform (minimum, maximum)", "@RISK Uniform(min, max)")
    rules = (
        Constraint(
            "low",
            lambda low, high: low <= high,
            "Low ({low}) is above High ({high})",
            "Exchange the two, or correct the wrong one",
        ),
    )

    def offset_and_factor(self, low: float, high: float) -> tuple[float, float] | None:
        """Two numbers with which offset + factor·u has the bits of `ppf(u)`; otherwise None."""
        width = high - low
        return None if low + width > high else (low, width)

    def _ppf(self, u: Array, low: Values, high: Values) -> Array:
        width = high - low
        u *= width
        u += low
        # Rounding is monotonic, so only where the very top overshoots can any value do so.
        if np.any(low + width > high):
            np.minimum(u, high, out=u)
        return u

    def _cdf(self, x: Values, low: Values, high: Values) -> Values:
        inside = share(np.clip(x, low, high) - low, high - low)
        return np.where(high > low, inside, x >= low)

    def _mean(self, low: Values, high: Values) -> Values:
        return low / 2 + high / 2

    def _variance(self, low: Values, high: Values) -> Values:
        return (high - low) ** 2 / 12

    def _support(self, low: Values, high: Values) -> tuple[Values, Values]:
        return low, high

    def _mirrored(self, low: Values, high: Values) -> tuple[Values, ...]:
        return -high, -low
