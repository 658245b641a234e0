"""Geometric: how many independent trials it takes until the first success; Geomet counts the failures before it."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.whole_numbers import PROBABILITY, WholeNumbers, probability, within_reach

__all__ = ["Geomet", "Geometric"]


class Geometric(WholeNumbers):
    """Geometric with the probability of success, counting trials as Crystal Ball does: 1, 2, 3, …

    >>> geometric = Geometric()
    >>> print(geometric.ppf(np.array([0.0, 0.5, 0.99]), probability=0.25))
    [ 1.  3. 17.]
    >>> geometric.check(probability=0)
    'Probability (0) must be above 0 and at most 1'
    >>> print(geometric.ppf(0.5, np.array([0.25, 1.25])))
    [ 3. nan]
    """

    name = "Geometric"
    formula = "P(k) = Probability·(1 - Probability)^(k - 1), k from 1"
    source = "N. L. Johnson, A. W. Kemp and S. Kotz, Univariate Discrete Distributions, 2005, chapter 5"
    elsewhere = ("Crystal Ball CB.Geometric(p)",)
    parameters = (PROBABILITY,)
    rules = (probability(parameters, positive=True), within_reach(lambda _: 1.0))
    first = 1.0
    """The least number: 1 counts trials, 0 counts failures."""

    def _at_most(self, k: Array, probability: Values) -> Values:
        return -np.expm1(self._log_none(k + 1, probability))

    def _at_least(self, k: Array, probability: Values) -> Values:
        return np.exp(self._log_none(k, probability))

    def _log_none(self, k: Array, probability: Values) -> Array:
        """Compute the logarithm of the probability that everything before k failed; far below 0 where it is certain to
        end.
        """
        with np.errstate(divide="ignore"):
            each = np.maximum(np.log1p(-np.asarray(probability)), -1e300)
        return np.asarray(np.maximum(k - self.first, 0.0) * each)

    def _guess(self, u: Array, q: Array, *params: Values) -> Array:
        (probability,) = params
        each = np.minimum(np.log1p(-np.minimum(probability, LARGEST_SHARE)), -1e-300)
        log_above = np.where(u < q, np.log1p(-np.minimum(u, 0.5)), np.log(np.clip(q, 1e-300, 1.0)))
        return np.asarray(self.first - 1 + np.ceil(log_above / each))

    def _mean(self, probability: Values) -> Values:
        return 1 / probability - (1 - self.first)

    def _variance(self, probability: Values) -> Values:
        return (1 - probability) / probability / probability

    def _skewness(self, probability: Values) -> Values:
        return (2 - probability) / np.sqrt(np.maximum(1 - probability, 1e-16))

    def _support(self, probability: Values) -> tuple[Values, Values]:
        return self.first + 0 * probability, np.where(np.equal(probability, 1), self.first, np.inf) + 0 * probability


LARGEST_SHARE = 1 - 2.0**-53


class Geomet(Geometric):
    """Geometric with the probability of success, counting failures as @RISK does: 0, 1, 2, …

    >>> geomet = Geomet()
    >>> print(float(geomet.ppf(0.99, probability=0.25)), float(Geometric().ppf(0.99, probability=0.25)))
    16.0 17.0
    """

    name = "Geomet"
    aliases = ("Geometric failures",)
    formula = "P(k) = Probability·(1 - Probability)^k, k from 0"
    source = "N. L. Johnson, A. W. Kemp and S. Kotz, Univariate Discrete Distributions, 2005, chapter 5"
    elsewhere = ("@RISK Geomet(p)",)
    first = 0.0
