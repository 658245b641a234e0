"""Triangular: a range and its likeliest value."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, share
from xlmc.montecarlo.distributions.parameters import HIGH, LIKELIEST, LOW, Constraint

__all__ = ["Triangular"]


class Triangular(Family):
    """Triangular on [low, high] with its peak at likeliest, which may be one of the ends.

    >>> triangular = Triangular()
    >>> print(triangular.ppf(np.array([0.0, 0.5, 0.875]), low=0, likeliest=2, high=4))
    [0. 2. 3.]
    >>> triangular.check(low=0, likeliest=5, high=4)
    'Likeliest (5) is above High (4)'
    >>> print(triangular.ppf(0.5, 0.0, np.array([2.0, 5.0]), 4.0))
    [ 2. nan]
    """

    name = "Triangular"
    aliases = ("Triangle", "Triang")
    parameters = (LOW, LIKELIEST, HIGH)
    formula = "density in straight lines from 0 at Low to its peak at Likeliest and down to 0 at High"
    source = "Kotz and van Dorp, Beyond Beta (2004), ch. 1"
    elsewhere = ("Crystal Ball Triangular (minimum, likeliest, maximum)", "@RISK Triang(min, likeliest, max)")
    roles = ("ordered", "ordered", "ordered")
    always_finite = True
    rules = (
        Constraint(
            "low",
            lambda low, _likeliest, high: low <= high,
            "Low ({low}) is above High ({high})",
            "Exchange the two, or correct the wrong one",
        ),
        Constraint(
            "likeliest",
            lambda low, likeliest, _high: low <= likeliest,
            "Likeliest ({likeliest}) is below Low ({low})",
            "Give a value from Low to High",
        ),
        Constraint(
            "likeliest",
            lambda _low, likeliest, high: likeliest <= high,
            "Likeliest ({likeliest}) is above High ({high})",
            "Give a value from Low to High",
        ),
    )

    def _ppf(self, u: Array, low: Values, likeliest: Values, high: Values) -> Array:
        width = high - low
        left, right = share(likeliest - low, width), share(high - likeliest, width)
        rising = low + width * np.sqrt(u * left)
        falling = high - width * np.sqrt((1 - u) * right)
        return np.clip(np.where(u < left, rising, falling), low, high)

    def _cdf(self, x: Values, low: Values, likeliest: Values, high: Values) -> Values:
        width, rise, fall = high - low, likeliest - low, high - likeliest
        up = np.clip(x, low, likeliest) - low
        down = high - np.clip(x, likeliest, high)
        below = share(up, width) * share(up, rise)
        above = share(down, width) * share(down, fall)
        inside = np.where(x < likeliest, below, 1 - above)
        return np.where(high > low, inside, x >= low)

    def _mean(self, low: Values, likeliest: Values, high: Values) -> Values:
        return (low + likeliest + high) / 3

    def _variance(self, low: Values, likeliest: Values, high: Values) -> Values:
        rise, fall = likeliest - low, high - likeliest
        return (rise**2 + rise * fall + fall**2) / 18

    def _support(self, low: Values, likeliest: Values, high: Values) -> tuple[Values, Values]:
        return low + 0 * likeliest, high + 0 * likeliest

    def _mirrored(self, low: Values, likeliest: Values, high: Values) -> tuple[Values, ...]:
        return -high, -likeliest, -low
