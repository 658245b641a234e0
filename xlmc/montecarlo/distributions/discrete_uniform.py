"""Discrete uniform: every whole number between two limits is equally likely."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.parameters import HIGH, LOW, Constraint, ParameterSpec
from xlmc.montecarlo.distributions.whole_numbers import MOST, WholeNumbers

__all__ = ["DiscreteUniform"]


def _whole(spec: ParameterSpec, index: int) -> Constraint:
    return Constraint(
        spec.key,
        lambda *ends: (abs(ends[index]) <= MOST) & (ends[index] == np.floor(ends[index])),
        f"{spec.heading} ({{{spec.key}}}) must be a whole number from -{MOST:,.0f} to {MOST:,.0f}",
        "Correct the number, or wrap its formula in ROUND",
    )


class DiscreteUniform(WholeNumbers):
    """Discrete uniform on low, low + 1, …, high.

    >>> die = DiscreteUniform()
    >>> print(die.ppf(np.array([0.0, 0.5, 0.99]), low=1, high=6))
    [1. 3. 6.]
    >>> die.check(low=6, high=1)
    'Low (6) is above High (1)'
    >>> print(die.ppf(0.5, np.array([1.0, 1.5]), 6.0))
    [ 3. nan]
    """

    name = "Discrete Uniform"
    aliases = ("IntUniform", "Integer uniform")
    formula = "P(k) = 1 / (High - Low + 1), k from Low to High"
    source = "N. L. Johnson, A. W. Kemp and S. Kotz, Univariate Discrete Distributions, 2005, chapter 6"
    elsewhere = ("Crystal Ball CB.DiscreteUniform(min, max)", "@RISK IntUniform(min, max)")
    parameters = (LOW, HIGH)
    rules = (
        _whole(LOW, 0),
        _whole(HIGH, 1),
        Constraint(
            "low",
            lambda low, high: low <= high,
            "Low ({low}) is above High ({high})",
            "Exchange the two, or correct the wrong one",
        ),
    )

    def _at_most(self, k: Array, low: Values, high: Values) -> Values:
        return (k - low + 1) / (high - low + 1)

    def _at_least(self, k: Array, low: Values, high: Values) -> Values:
        return (high - k + 1) / (high - low + 1)

    def _guess(self, u: Array, q: Array, *params: Values) -> Array:
        low, high = params
        return np.asarray(low - 1 + np.ceil(u * (high - low + 1)))

    def _mean(self, low: Values, high: Values) -> Values:
        return low / 2 + high / 2

    def _variance(self, low: Values, high: Values) -> Values:
        return ((high - low + 1) ** 2 - 1) / 12

    def _skewness(self, low: Values, high: Values) -> Values:
        return 0 * (low + high)

    def _support(self, low: Values, high: Values) -> tuple[Values, Values]:
        return low + 0 * high, high + 0 * low
