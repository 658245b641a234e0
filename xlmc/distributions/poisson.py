"""Poisson: how many independent events fall into an interval, at a known mean rate."""

from __future__ import annotations

import numpy as np

from xlmc.distributions.base import Array, Rule, Values
from xlmc.distributions.poisson_tails import at_least, at_most
from xlmc.distributions.whole_numbers import MOST, RATE, WholeNumbers

__all__ = ["Poisson"]


class Poisson(WholeNumbers):
    """Poisson with the mean number of events, which Crystal Ball calls its rate: 0, 1, 2, …

    >>> poisson = Poisson()
    >>> print(poisson.ppf(np.array([0.0, 0.5, 0.99]), rate=4))
    [0. 4. 9.]
    >>> poisson.check(rate=0)
    'Rate (0) must be above 0 and at most 1,000,000,000'
    >>> print(poisson.ppf(0.5, np.array([4.0, -4.0])))
    [ 4. nan]
    """

    name = "Poisson"
    formula = "P(k) = Rate^k·e^(-Rate) / k!"
    source = "N. L. Johnson, A. W. Kemp and S. Kotz, Univariate Discrete Distributions, 2005, chapter 4"
    elsewhere = ("Crystal Ball CB.Poisson(rate)", "@RISK Poisson(rate)")
    parameters = (RATE,)
    rules = (
        Rule(
            "rate",
            lambda rate: (rate > 0) & (rate <= MOST),
            f"Rate ({{rate}}) must be above 0 and at most {MOST:,.0f}",
            "Type the mean number of events",
        ),
    )

    def _at_most(self, k: Array, rate: Values) -> Values:
        return at_most(k, rate)

    def _at_least(self, k: Array, rate: Values) -> Values:
        return at_least(np.maximum(k, 1), rate)

    def _mean(self, rate: Values) -> Values:
        return rate

    def _variance(self, rate: Values) -> Values:
        return rate

    def _skewness(self, rate: Values) -> Values:
        return 1 / np.sqrt(rate)

    def _support(self, rate: Values) -> tuple[Values, Values]:
        return 0 * rate, np.inf + 0 * rate
