"""Negative binomial: how many independent trials it takes until so many succeed; Negbin counts the failures."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.whole_numbers import (
    PROBABILITY,
    SHAPE,
    WholeNumbers,
    probability,
    whole,
    within_reach,
)

__all__ = ["NegativeBinomial", "Negbin"]


class NegativeBinomial(WholeNumbers):
    """Negative binomial with the probability of success and the number of successes, called its shape.

    It counts trials as Crystal Ball does: shape, shape + 1, …

    >>> negative_binomial = NegativeBinomial()
    >>> print(negative_binomial.ppf(np.array([0.0, 0.5, 0.99]), probability=0.25, shape=3))
    [ 3. 11. 31.]
    >>> negative_binomial.check(probability=0.25, shape=0)
    'Shape (0) must be a whole number from 1 to 1,000,000,000'
    >>> print(negative_binomial.ppf(0.5, 0.25, np.array([3.0, -3.0])))
    [11. nan]
    """

    name = "Negative Binomial"
    formula = "P(k) = C(k - 1, Shape - 1)·Probability^Shape·(1 - Probability)^(k - Shape), k from Shape"
    source = "N. L. Johnson, A. W. Kemp and S. Kotz, Univariate Discrete Distributions, 2005, chapter 5"
    elsewhere = ("Crystal Ball CB.NegBinomial(p, shape)",)
    parameters = (PROBABILITY, SHAPE)
    rules = (probability(parameters, positive=True), whole(parameters, SHAPE, 1), within_reach(lambda _, shape: shape))
    counts_successes = True
    """Whether the successes are counted, too: trials, not failures."""

    def _at_most(self, k: Array, probability: Values, shape: Values) -> Values:
        from scipy.special import betainc

        return betainc(shape, k - self._least(shape) + 1, probability)  # type: ignore[no-any-return]

    def _at_least(self, k: Array, probability: Values, shape: Values) -> Values:
        from scipy.special import betaincc

        failures = np.maximum(k - self._least(shape), 1)
        return betaincc(shape, failures, probability)  # type: ignore[no-any-return]

    def _least(self, shape: Values) -> Values:
        return shape if self.counts_successes else 0 * shape

    def _mean(self, probability: Values, shape: Values) -> Values:
        return shape * (1 - probability) / probability + self._least(shape)

    def _variance(self, probability: Values, shape: Values) -> Values:
        return shape * (1 - probability) / probability / probability

    def _skewness(self, probability: Values, shape: Values) -> Values:
        return (2 - probability) / np.sqrt(shape * np.maximum(1 - probability, 1e-16))

    def _support(self, probability: Values, shape: Values) -> tuple[Values, Values]:
        least = self._least(shape) + 0 * probability
        return least, np.where(np.equal(probability, 1), least, np.inf) + 0 * least


class Negbin(NegativeBinomial):
    """Negative binomial with the probability of success and the number of successes, counting failures as @RISK does.

    >>> negbin = Negbin()
    >>> print(float(negbin.ppf(0.99, probability=0.25, shape=3)))
    28.0
    """

    name = "Negbin"
    aliases = ("Negative binomial failures",)
    formula = "P(k) = C(k + Shape - 1, k)·Probability^Shape·(1 - Probability)^k, k from 0"
    source = "N. L. Johnson, A. W. Kemp and S. Kotz, Univariate Discrete Distributions, 2005, chapter 5"
    elsewhere = ("@RISK Negbin(s, p)",)
    counts_successes = False
