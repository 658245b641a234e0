"""Double triangular: two triangles back to back at the likeliest value, each with a probability of its own."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values
from xlmc.montecarlo.distributions.parameters import HIGH, LIKELIEST, LOW, Constraint, ParameterSpec

__all__ = ["DoubleTriang"]


class DoubleTriang(Family):
    """Double triangular with low, likeliest and high, and the probability of a value below the likeliest.

    >>> double = DoubleTriang()
    >>> print(double.ppf(np.array([0.0, 0.19, 0.76, 0.94]), low=0, likeliest=4, high=10, lower_share=0.76).round(6))
    [0. 2. 4. 7.]
    >>> double.check(low=0, likeliest=4, high=10, lower_share=1)
    'Lower share (1) must be above 0 and below 1'
    """

    name = "DoubleTriang"
    aliases = ("Double triangular",)
    parameters = (LOW, LIKELIEST, HIGH, ParameterSpec("lower_share", ("Lower share", "Lower probability", "Lower p")))
    rules = (
        Constraint(
            "likeliest",
            lambda low, likeliest, high, _: (low < likeliest) & (likeliest < high),
            "Likeliest ({likeliest}) must be above Low ({low}) and below High ({high})",
            "Correct the wrong one",
        ),
        Constraint(
            "lower_share",
            lambda *values: (values[3] > 0) & (values[3] < 1),
            "Lower share ({lower_share}) must be above 0 and below 1",
            "Type the probability of a value below Likeliest, such as 0.76",
        ),
    )
    always_finite = True
    formula = (
        "density in straight lines from 0 at Low up to Likeliest, with the area Lower share; and from there to High"
    )
    source = "AACE International Recommended Practice 41R-08, Risk Analysis and Contingency Determination"
    elsewhere = ("@RISK DoubleTriang(min, m.likely, max, p)",)

    def _ppf(self, u: Array, low: Values, likeliest: Values, high: Values, share: Values) -> Array:
        rising = low + np.subtract(likeliest, low) * np.sqrt(u / share)
        falling = high - np.subtract(high, likeliest) * np.sqrt((1 - u) / np.subtract(1, share))
        return np.where(u <= share, np.minimum(rising, likeliest), np.maximum(falling, likeliest))

    def _cdf(self, x: Values, low: Values, likeliest: Values, high: Values, share: Values) -> Values:
        rise = np.divide(np.clip(x, low, likeliest) - low, np.subtract(likeliest, low))
        fall = np.divide(high - np.clip(x, likeliest, high), np.subtract(high, likeliest))
        return np.where(np.less(x, likeliest), share * rise**2, 1 - np.subtract(1, share) * fall**2)

    def _mean(self, low: Values, likeliest: Values, high: Values, share: Values) -> Values:
        below, above = np.subtract(likeliest, low), np.subtract(high, likeliest)
        return likeliest + (np.subtract(1, share) * above - share * below) / 3

    def _variance(self, low: Values, likeliest: Values, high: Values, share: Values) -> Values:
        below, above, rest = np.subtract(likeliest, low), np.subtract(high, likeliest), np.subtract(1, share)
        return np.asarray((share * below**2 + rest * above**2) / 6 - ((rest * above - share * below) / 3) ** 2)

    def _support(self, low: Values, likeliest: Values, high: Values, share: Values) -> tuple[Values, Values]:
        nothing = 0 * np.add(likeliest, share)
        return low + nothing + 0 * high, high + nothing + 0 * low

    def _mirrored(self, low: Values, likeliest: Values, high: Values, share: Values) -> tuple[Values, ...]:
        return np.negative(high), np.negative(likeliest), np.negative(low), np.subtract(1, share)
