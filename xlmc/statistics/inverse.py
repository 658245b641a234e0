"""Shares where trials go on until there are enough successes, rather than successes of a number of trials fixed before.

The number of trials n until the N-th success has a negative binomial distribution. N/n is then too large on average;
(N − 1)/(n − 1) is right on average (Haldane 1945), and p(1 − p)/(n − 2) is so for its variance (Finney 1949). The
interval is exact: at either end as many trials or more, or as few or fewer, have the probability of one tail (George &
Elston 1993). As n ≤ k just where k trials have N successes or more, the ends are quantiles of beta distributions, like
Clopper and Pearson's.
"""

from __future__ import annotations

from xlmc.statistics.estimate import Estimate, one_tail
from xlmc.statistics.proportions import least_error

__all__ = ["inverse_proportion"]


def inverse_proportion(successes: int, trials: int, *, confidence: float = 0.95) -> Estimate:
    """The share of successes, of which so many were waited for; the last trial is one.

    Raises:
        ValueError: fewer than 2 successes, or fewer trials than successes.

    >>> inverse_proportion(3, 9).value
    0.25
    """
    from scipy.special import betaincinv

    if not 2 <= successes <= trials:
        raise ValueError(f"{successes} successes, waited for in {trials} trials")
    tail, misses = one_tail(confidence), trials - successes
    p = (successes - 1) / (trials - 1)
    error = least_error(trials) if misses == 0 else max((p * (1.0 - p) / (trials - 2)) ** 0.5, least_error(trials))
    low = float(betaincinv(successes, misses + 1.0, tail))
    high = 1.0 if misses == 0 else float(betaincinv(successes, misses, 1.0 - tail))
    return Estimate(p, error, (low, high), trials)
