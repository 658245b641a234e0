"""Kumaraswamy: like the beta, between two limits, with formulas that can be inverted."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values
from xlmc.montecarlo.distributions.located import SHAPE_1, SHAPE_2
from xlmc.montecarlo.distributions.parameters import HIGH, LOW, Constraint, above_zero

__all__ = ["Kumaraswamy"]


class Kumaraswamy(Family):
    """Kumaraswamy between low and high, with two shapes.

    >>> kumaraswamy = Kumaraswamy()
    >>> print(kumaraswamy.ppf(np.array([0.0, 0.5, 0.9]), low=0, high=1, shape_1=2, shape_2=3).round(6))
    [0.       0.454202 0.732012]
    >>> kumaraswamy.check(low=0, high=1, shape_1=0, shape_2=3)
    'Shape 1 (0) must be above 0'
    """

    name = "Kumaraswamy"
    parameters = (LOW, HIGH, SHAPE_1, SHAPE_2)
    roles = ("ordered", "ordered", "shape", "shape")
    rules = (
        Constraint(
            "low", lambda low, high, *_: low < high, "Low ({low}) must be below High ({high})", "Correct the wrong one"
        ),
        above_zero(parameters, "shape_1"),
        above_zero(parameters, "shape_2"),
    )
    always_finite = True
    formula = "P(X > x) = (1 − z^Shape 1)^Shape 2, z = (x − Low)/(High − Low)"
    source = "Kumaraswamy, Journal of Hydrology 46 (1980), 79–88"
    elsewhere = ("@RISK Kumaraswamy(alpha1, alpha2, min, max): both shapes, low, high",)

    def _ppf(self, u: Array, low: Values, high: Values, first: Values, second: Values) -> Array:
        return _between(np.log1p(-u) / second, low, high, first)

    def _isf(self, q: Array, low: Values, high: Values, first: Values, second: Values) -> Array:
        return _between(np.log(q) / second, low, high, first)

    def _cdf(self, x: Values, low: Values, high: Values, first: Values, second: Values) -> Values:
        return -np.expm1(second * _log_rest(x, low, high, first))

    def _sf(self, x: Values, low: Values, high: Values, first: Values, second: Values) -> Values:
        return np.exp(second * _log_rest(x, low, high, first))

    def _mean(self, low: Values, high: Values, first: Values, second: Values) -> Values:
        return low + np.subtract(high, low) * np.exp(_log_moment(1, first, second))

    def _variance(self, low: Values, high: Values, first: Values, second: Values) -> Values:
        once = _log_moment(1, first, second)
        spread = np.exp(2 * once) * np.expm1(_log_moment(2, first, second) - 2 * once)
        return np.asarray(np.square(np.subtract(high, low)) * spread)

    def _support(self, low: Values, high: Values, first: Values, second: Values) -> tuple[Values, Values]:
        nothing = 0 * np.add(first, second)
        return low + nothing + 0 * high, high + nothing + 0 * low


def _between(log_rest: Array, low: Values, high: Values, first: Values) -> Array:
    """Return the value where 1 - z^first has this logarithm; counted from the nearer end."""
    log_share = np.log(-np.expm1(log_rest)) / first
    width = np.subtract(high, low)
    near = log_share < -0.7
    return np.asarray(np.where(near, low + width * np.exp(log_share), high + width * np.expm1(log_share)))


def _log_rest(x: Values, low: Values, high: Values, first: Values) -> Array:
    """Return the logarithm of 1 - z^first."""
    inside, width = np.clip(x, low, high), np.subtract(high, low)
    z = (inside - low) / width
    log_z = np.where(z < 0.5, np.log(z), np.log1p(-(high - inside) / width))
    power = first * log_z
    return np.asarray(np.where(power < -0.7, np.log1p(-np.exp(power)), np.log(-np.expm1(power))))


def _log_moment(order: int, first: Values, second: Values) -> Values:
    from scipy.special import betaln

    return np.asarray(np.log(second) + betaln(1 + np.divide(order, first), second))
