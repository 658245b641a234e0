"""Geomet: how many independent trials fail before the first success, @RISK's geometric distribution."""

from __future__ import annotations

from xlmc.distributions.geometric import Geometric

__all__ = ["Geomet"]


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
