"""Reciprocal (log-uniform): every doubling is equally likely; what is known only by its order of magnitude."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values
from xlmc.montecarlo.distributions.parameters import HIGH, LOW, Constraint, above_zero

__all__ = ["Reciprocal"]


class Reciprocal(Family):
    """Reciprocal between low and high, both above 0.

    >>> reciprocal = Reciprocal()
    >>> print(reciprocal.ppf(np.array([0.0, 0.5, 0.75]), low=1, high=100).round(6))
    [ 1.       10.       31.622777]
    >>> reciprocal.check(low=0, high=100)
    'Low (0) must be above 0'
    """

    name = "Reciprocal"
    aliases = ("Log uniform",)
    parameters = (LOW, HIGH)
    rules = (
        above_zero(parameters, "low"),
        Constraint(
            "low", lambda low, high: low < high, "Low ({low}) must be below High ({high})", "Correct the wrong one"
        ),
    )
    always_finite = True
    formula = "density 1/(x·ln(High/Low)) from Low to High: ln X is uniform"
    source = "Hamming, Bell System Technical Journal 49 (1970), 1609–1625"
    elsewhere = ("@RISK Reciprocal(min, max)",)

    def _ppf(self, u: Array, low: Values, high: Values) -> Array:
        ratio = _log_ratio(low, high)
        x = np.where(u < 0.5, low * np.exp(u * ratio), high * np.exp((u - 1) * ratio))
        return np.asarray(np.clip(x, low, high))

    def _isf(self, q: Array, low: Values, high: Values) -> Array:
        ratio = _log_ratio(low, high)
        x = np.where(q < 0.5, high * np.exp(-q * ratio), low * np.exp((1 - q) * ratio))
        return np.asarray(np.clip(x, low, high))

    def _cdf(self, x: Values, low: Values, high: Values) -> Values:
        return _log_ratio(low, np.clip(x, low, high)) / _log_ratio(low, high)

    def _sf(self, x: Values, low: Values, high: Values) -> Values:
        return _log_ratio(np.clip(x, low, high), high) / _log_ratio(low, high)

    def _mean(self, low: Values, high: Values) -> Values:
        return np.subtract(high, low) / _log_ratio(low, high)

    def _variance(self, low: Values, high: Values) -> Values:
        width, ratio = np.subtract(high, low), _log_ratio(low, high)
        return width * (np.add(high, low) / 2 - width / ratio) / ratio

    def _support(self, low: Values, high: Values) -> tuple[Values, Values]:
        return low + 0 * high, high + 0 * low


def _log_ratio(low: Values, high: Values) -> Values:
    """Return the logarithm of high/low, to its last digits where they are near to each other."""
    share = np.subtract(high, low) / low
    return np.where(share < 1, np.log1p(np.minimum(share, 1.0)), np.log(high) - np.log(low))
