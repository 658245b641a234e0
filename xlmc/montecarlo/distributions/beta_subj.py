"""Subjective beta: a beta defined by its limits, its likeliest value and its mean."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values
from xlmc.montecarlo.distributions.beta import Beta
from xlmc.montecarlo.distributions.parameters import HIGH, LIKELIEST, LOW, MEAN, Constraint

__all__ = ["BetaSubj"]

_BETA = Beta()


class BetaSubj(Family):
    """Beta with low, likeliest, mean and high. The mean lies between the likeliest value and the middle.

    >>> subjective = BetaSubj()
    >>> print(subjective.ppf(np.array([0.1, 0.5, 0.9]), low=0, likeliest=2, mean=3, high=10).round(6))
    [0.899021 2.766723 5.453341]
    >>> subjective.check(low=0, likeliest=2, mean=6, high=10)
    'Mean (6) must lie between Likeliest (2) and the middle of Low (0) and High (10)'
    """

    name = "BetaSubj"
    aliases = ("Subjective beta",)
    parameters = (LOW, LIKELIEST, MEAN, HIGH)
    rules = (
        Constraint(
            "likeliest",
            lambda low, likeliest, _mean, high: (low < likeliest) & (likeliest < high),
            "Likeliest ({likeliest}) must be above Low ({low}) and below High ({high})",
            "Correct the wrong one",
        ),
        Constraint(
            "mean",
            lambda low, likeliest, mean, high: (mean - likeliest) * (low / 2 + high / 2 - mean) > 0,
            "Mean ({mean}) must lie between Likeliest ({likeliest}) and the middle of Low ({low}) and High ({high})",
            "No other beta has this mean and this peak; if all three are one, choose BetaPERT",
        ),
    )
    always_finite = True
    formula = (
        "Beta with Alpha = 2·(Mean − Low)·(m − Likeliest)/((Mean − Likeliest)·(High − Low)), m = (Low + High)/2,"
        " and Beta = Alpha·(High − Mean)/(Mean − Low)"
    )
    source = "@RISK's manual, BetaSubj; it is the beta whose mode and mean are these"
    elsewhere = ("@RISK BetaSubj(min, m.likely, mean, max)",)

    def _ppf(self, u: Array, low: Values, likeliest: Values, mean: Values, high: Values) -> Array:
        return _BETA._ppf(u, *_of_beta(low, likeliest, mean, high))

    def _cdf(self, x: Values, low: Values, likeliest: Values, mean: Values, high: Values) -> Values:
        return _BETA._cdf(x, *_of_beta(low, likeliest, mean, high))

    def _mean(self, low: Values, likeliest: Values, mean: Values, high: Values) -> Values:
        return mean + 0 * (low + likeliest + high)

    def _variance(self, low: Values, likeliest: Values, mean: Values, high: Values) -> Values:
        return _BETA._variance(*_of_beta(low, likeliest, mean, high))

    def _support(self, low: Values, likeliest: Values, mean: Values, high: Values) -> tuple[Values, Values]:
        nothing = 0 * np.add(likeliest, mean)
        return low + nothing + 0 * high, high + nothing + 0 * low

    def _mirrored(self, low: Values, likeliest: Values, mean: Values, high: Values) -> tuple[Values, ...]:
        return np.negative(high), np.negative(likeliest), np.negative(mean), np.negative(low)


def _of_beta(low: Values, likeliest: Values, mean: Values, high: Values) -> tuple[Values, Values, Values, Values]:
    """Return the parameters of `Beta`."""
    width = np.subtract(high, low)
    offset = (np.subtract(low, likeliest) + np.subtract(high, likeliest)) / np.subtract(mean, likeliest)
    alpha = np.subtract(mean, low) * offset / width
    return low, high, alpha, np.subtract(high, mean) * offset / width
