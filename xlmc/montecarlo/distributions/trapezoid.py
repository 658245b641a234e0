"""Trapezoid: equally likely between two limits, tailing off in straight lines to the extremes.

Figure 4 of the paper, for a coefficient of friction: random variation is normal, but its mean is known only to lie
between two limits (0.70 and 0.85), and the literature gives the extremes.
"""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, share
from xlmc.montecarlo.distributions.parameters import HIGH, LOW, Constraint, ParameterSpec

__all__ = ["Trapezoid"]


class Trapezoid(Family):
    """Trapezoid on [low, high], flat on [low_likeliest, high_likeliest].

    Equal likeliest values make it triangular; a flat part from low to high makes it uniform.

    >>> trapezoid = Trapezoid()
    >>> friction = {"low": 0.55, "low_likeliest": 0.70, "high_likeliest": 0.85, "high": 1.0}
    >>> print(trapezoid.ppf(np.array([0.0, 0.25, 0.5, 0.75]), **friction))
    [0.55  0.7   0.775 0.85 ]
    >>> trapezoid.check(low=0.55, low_likeliest=0.9, high_likeliest=0.85, high=1.0)
    'Low likeliest (0.9) is above High likeliest (0.85)'
    >>> print(trapezoid.ppf(0.5, 0.55, np.array([0.7, 0.9]), 0.85, 1.0))
    [0.775   nan]
    """

    name = "Trapezoid"
    aliases = ("Trapezoidal",)
    parameters = (
        LOW,
        ParameterSpec("low_likeliest", ("Low likeliest",)),
        ParameterSpec("high_likeliest", ("High likeliest",)),
        HIGH,
    )
    formula = "density ∝ straight lines through (Low, 0), (Low likeliest, 1), (High likeliest, 1), (High, 0)"
    source = "Figure 4 of the paper; van Dorp and Kotz, Metrika 58 (2003), 85–97"
    elsewhere = ("@RISK General(low, high, {low likeliest, high likeliest}, {1, 1})",)
    roles = ("ordered", "ordered", "ordered", "ordered")
    rules = (
        Constraint(
            "low",
            lambda low, _b, _c, high: low <= high,
            "Low ({low}) is above High ({high})",
            "Exchange the two, or correct the wrong one",
        ),
        Constraint(
            "low_likeliest",
            lambda low, low_likeliest, _c, _high: low <= low_likeliest,
            "Low likeliest ({low_likeliest}) is below Low ({low})",
            "The four must rise: Low, Low likeliest, High likeliest, High",
        ),
        Constraint(
            "low_likeliest",
            lambda _low, low_likeliest, high_likeliest, _high: low_likeliest <= high_likeliest,
            "Low likeliest ({low_likeliest}) is above High likeliest ({high_likeliest})",
            "Exchange the two, or correct the wrong one",
        ),
        Constraint(
            "high_likeliest",
            lambda _low, _b, high_likeliest, high: high_likeliest <= high,
            "High likeliest ({high_likeliest}) is above High ({high})",
            "The four must rise: Low, Low likeliest, High likeliest, High",
        ),
    )

    def _ppf(self, u: Array, low: Values, low_likeliest: Values, high_likeliest: Values, high: Values) -> Array:
        rise, fall = low_likeliest - low, high - high_likeliest
        whole = _area(rise, high_likeliest - low_likeliest, fall)
        left = u * whole
        right = (1 - u) * whole
        # Roots are taken one by one: the product of two narrow widths may underflow.
        rising = low + np.sqrt(2 * left) * np.sqrt(rise)
        falling = high - np.sqrt(2 * right) * np.sqrt(fall)
        flat = low_likeliest + (left - rise / 2)
        x = np.where(left < rise / 2, rising, np.where(right < fall / 2, falling, flat))
        return np.clip(x, low, high)

    def _cdf(self, x: Values, low: Values, low_likeliest: Values, high_likeliest: Values, high: Values) -> Values:
        rise, flat, fall = low_likeliest - low, high_likeliest - low_likeliest, high - high_likeliest
        up = np.clip(x, low, low_likeliest) - low
        across = np.clip(x, low_likeliest, high_likeliest) - low_likeliest
        down = high - np.clip(x, high_likeliest, high)
        left = up * share(up, rise) / 2 + across + (fall - down * share(down, fall)) / 2
        return np.where(high > low, share(left, _area(rise, flat, fall)), x >= low)

    def _mean(self, low: Values, low_likeliest: Values, high_likeliest: Values, high: Values) -> Values:
        first, _ = _moments(low, low_likeliest, high_likeliest, high)
        return low + first

    def _variance(self, low: Values, low_likeliest: Values, high_likeliest: Values, high: Values) -> Values:
        first, second = _moments(low, low_likeliest, high_likeliest, high)
        return second - first**2

    def _support(
        self, low: Values, low_likeliest: Values, high_likeliest: Values, high: Values
    ) -> tuple[Values, Values]:
        inner = 0 * (low_likeliest + high_likeliest)
        return low + inner, high + inner

    def _mirrored(self, low: Values, low_likeliest: Values, high_likeliest: Values, high: Values) -> tuple[Values, ...]:
        return -high, -high_likeliest, -low_likeliest, -low


def _area(rise: Values, flat: Values, fall: Values) -> Values:
    """Return the area under the outline drawn at height 1, as wide as the flat part and half of each slope."""
    return rise / 2 + flat + fall / 2


def _moments(low: Values, low_likeliest: Values, high_likeliest: Values, high: Values) -> tuple[Values, Values]:
    """Mean and mean square of the distance from low: two triangles and a rectangle, weighted by their areas."""
    rise, flat, fall = low_likeliest - low, high_likeliest - low_likeliest, high - high_likeliest
    corner = rise + flat
    whole = _area(rise, flat, fall)
    first = (
        share(rise / 2, whole) * (2 * rise / 3)
        + share(flat, whole) * (rise + flat / 2)
        + share(fall / 2, whole) * (corner + fall / 3)
    )
    second = (
        share(rise / 2, whole) * (rise**2 / 2)
        + share(flat, whole) * (rise**2 + rise * flat + flat**2 / 3)
        + share(fall / 2, whole) * (corner**2 + 2 * corner * fall / 3 + fall**2 / 6)
    )
    return first, second
