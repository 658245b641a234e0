"""Negbin: how many independent trials fail before so many have succeeded, @RISK's negative binomial distribution."""

from __future__ import annotations

from xlmc.distributions.negative_binomial import NegativeBinomial

__all__ = ["Negbin"]


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
