"""Binomial: how many of so many independent trials succeed."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.whole_numbers import PROBABILITY, TRIALS, WholeNumbers, probability, whole

__all__ = ["Binomial"]


class Binomial(WholeNumbers):
    """Binomial with the probability of success and the number of trials: 0, 1, …, trials.

    >>> binomial = Binomial()
    >>> print(binomial.ppf(np.array([0.0, 0.5, 0.99]), probability=0.5, trials=10))
    [0. 5. 9.]
    >>> binomial.check(probability=0.5, trials=2.5)
    'Trials (2.5) must be a whole number from 0 to 1,000,000,000'
    >>> print(binomial.ppf(0.5, np.array([0.5, 1.5]), 10.0))
    [ 5. nan]
    """

    name = "Binomial"
    formula = "P(k) = C(Trials, k)·Probability^k·(1 - Probability)^(Trials - k)"
    source = "N. L. Johnson, A. W. Kemp and S. Kotz, Univariate Discrete Distributions, 2005, chapter 3"
    elsewhere = ("Crystal Ball CB.Binomial(p, n)", "@RISK Binomial(n, p)")
    parameters = (PROBABILITY, TRIALS)
    rules = (probability(parameters), whole(parameters, TRIALS, 0))

    def _at_most(self, k: Array, probability: Values, trials: Values) -> Values:
        from scipy.special import betaincc

        # At k = trials the function's second argument would be 0; the value there is not looked at.
        return betaincc(k + 1, np.maximum(trials - k, 1), probability)  # type: ignore[no-any-return]

    def _at_least(self, k: Array, probability: Values, trials: Values) -> Values:
        from scipy.special import betainc

        return betainc(np.maximum(k, 1), trials - k + 1, probability)  # type: ignore[no-any-return]

    def _mean(self, probability: Values, trials: Values) -> Values:
        return probability * trials

    def _variance(self, probability: Values, trials: Values) -> Values:
        return trials * probability * (1 - probability)

    def _skewness(self, probability: Values, trials: Values) -> Values:
        return (1 - 2 * probability) / np.sqrt(np.maximum(self._variance(probability, trials), 1e-300))

    def _support(self, probability: Values, trials: Values) -> tuple[Values, Values]:
        return 0 * (probability + trials), trials + 0 * probability
