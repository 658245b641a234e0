"""Yes-No: whether something happens, 1 or 0."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.whole_numbers import PROBABILITY, WholeNumbers, probability

__all__ = ["YesNo"]


class YesNo(WholeNumbers):
    """Yes (1) with the given probability, else No (0).

    >>> yes_no = YesNo()
    >>> print(yes_no.ppf(np.array([0.0, 0.75, 0.76]), probability=0.25))
    [0. 0. 1.]
    >>> yes_no.check(probability=25)
    'Probability (25) must be from 0 to 1'
    >>> print(yes_no.ppf(0.9, np.array([0.25, 25.0])))
    [ 1. nan]
    """

    name = "Yes-No"
    aliases = ("Bernoulli",)
    formula = "P(1) = Probability, P(0) = 1 - Probability"
    source = "N. L. Johnson, A. W. Kemp and S. Kotz, Univariate Discrete Distributions, 2005, chapter 3"
    elsewhere = ("Crystal Ball CB.YesNo(p)", "@RISK Bernoulli(p)")
    parameters = (PROBABILITY,)
    rules = (probability(parameters),)

    def _at_most(self, k: Array, probability: Values) -> Values:
        return np.where(k < 1, 1 - probability, 1.0)

    def _at_least(self, k: Array, probability: Values) -> Values:
        return np.where(k > 0, probability, 1.0)

    def _ppf(self, u: Array, *params: Values) -> Array:
        (chance,) = params
        return np.where(np.isnan(chance), np.nan, u > 1 - np.asarray(chance))

    def _mean(self, probability: Values) -> Values:
        return probability

    def _variance(self, probability: Values) -> Values:
        return probability * (1 - probability)

    def _skewness(self, probability: Values) -> Values:
        return 0 * probability

    def _support(self, probability: Values) -> tuple[Values, Values]:
        return np.where(np.equal(probability, 1), 1.0, 0.0), np.where(np.equal(probability, 0), 0.0, 1.0)
