"""BetaPERT: a range and its likeliest value, smoother than the triangle and with less weight near the ends."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, share
from xlmc.montecarlo.distributions.beta import Beta
from xlmc.montecarlo.distributions.parameters import HIGH, LIKELIEST, LOW
from xlmc.montecarlo.distributions.triangular import Triangular

__all__ = ["BetaPERT"]

_BETA = Beta()
_WEIGHT = 4.0  # of the likeliest value in the mean


class BetaPERT(Family):
    """Beta on [low, high] with its peak at likeliest and the mean (low + 4·likeliest + high)/6.

    >>> pert = BetaPERT()
    >>> print(pert.ppf(np.array([0.0, 0.5, 0.9]), low=10, likeliest=12, high=20).round(6))
    [10.       12.766723 15.453341]
    >>> pert.check(low=10, likeliest=25, high=20)
    'Likeliest (25) is above High (20)'
    >>> print(pert.ppf(0.5, 10.0, np.array([12.0, 25.0]), 20.0).round(6))
    [12.766723       nan]
    """

    name = "BetaPERT"
    aliases = ("PERT",)
    parameters = (LOW, LIKELIEST, HIGH)
    roles = ("ordered", "ordered", "ordered")
    always_finite = True
    rules = Triangular.rules
    formula = "Beta with Alpha = 1 + 4·(Likeliest − Low)/(High − Low) and Beta = 1 + 4·(High − Likeliest)/(High − Low)"
    source = "Malcolm, Roseboom, Clark and Fazar, Operations Research 7 (1959), 646–669, with λ = 4"
    elsewhere = ("Crystal Ball BetaPERT (minimum, likeliest, maximum)", "@RISK Pert(min, likeliest, max)")

    def _ppf(self, u: Array, low: Values, likeliest: Values, high: Values) -> Array:
        return _BETA._ppf(u, low, high, *_shapes(low, likeliest, high))

    def _cdf(self, x: Values, low: Values, likeliest: Values, high: Values) -> Values:
        return _BETA._cdf(x, low, high, *_shapes(low, likeliest, high))

    def _mean(self, low: Values, likeliest: Values, high: Values) -> Values:
        return (low + _WEIGHT * likeliest + high) / (_WEIGHT + 2)

    def _variance(self, low: Values, likeliest: Values, high: Values) -> Values:
        mean = self._mean(low, likeliest, high)
        return (mean - low) * (high - mean) / (_WEIGHT + 3)

    def _support(self, low: Values, likeliest: Values, high: Values) -> tuple[Values, Values]:
        return low + 0 * likeliest, high + 0 * likeliest

    def _mirrored(self, low: Values, likeliest: Values, high: Values) -> tuple[Values, ...]:
        return -high, -likeliest, -low


def _shapes(low: Values, likeliest: Values, high: Values) -> tuple[Array, Array]:
    """Alpha and beta."""
    width = np.subtract(high, low)
    return 1 + _WEIGHT * share(likeliest - low, width), 1 + _WEIGHT * share(high - likeliest, width)
