"""Distributions of counts. Excel rounds counts down before it looks at them."""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.excel.functions.registry import Logical, Number, excel
from xlmc.excel.functions.statistical.probabilities import binomial_mass, by_form, incomplete_beta, poisson_mass
from xlmc.excel.functions.values import NUM, Bools, Floats

__all__: list[str] = []

_SLACK: Final = 1e-14
"""A probability reaches another if it is below it by no more than this share: typed decimals are as far off."""

_LARGEST: Final = 2.0**31
"""Functions that count through things one by one refuse so many."""


def _is_probability(p: Floats) -> Bools:
    return (np.asarray(p) >= 0) & (p <= 1)


def _is_open(p: Floats) -> Bools:
    """Whether it is a probability, and neither 0 nor 1, which some of Excel's functions refuse."""
    return (np.asarray(p) > 0) & (p < 1)


@excel("POISSON.DIST", Number, Number, Logical, aliases=("POISSON",))
def poisson_dist(x: Floats, mean: Floats, cumulative: Bools) -> Floats:
    """Poisson distribution."""
    from scipy.special import gammaincc

    inside = (np.asarray(x) >= 0) & (mean >= 0)
    k, m = np.floor(np.where(inside, x, 0.0)), np.where(inside, mean, 1.0)
    return np.where(inside, by_form(cumulative, lambda: gammaincc(k + 1, m), lambda: poisson_mass(k, m)), NUM)


@excel("BINOM.DIST", Number, Number, Number, Logical, aliases=("BINOMDIST",))
def binom_dist(successes: Floats, trials: Floats, p: Floats, cumulative: Bools) -> Floats:
    """Binomial distribution of the successes among so many trials."""
    k, n = np.floor(successes), np.floor(trials)
    inside = (k >= 0) & (k <= n) & _is_probability(p)
    k, n, p = np.where(inside, k, 0.0), np.where(inside, n, 1.0), np.where(inside, p, 0.5)
    result = by_form(cumulative, lambda: _at_most(k, n, p), lambda: binomial_mass(k, n - k, p, 1 - p))
    return np.where(inside, result, NUM)


def _at_most(k: Floats, n: Floats, p: Floats) -> Floats:
    """Probability of at most k successes among n, k from -1."""
    between = (k >= 0) & (k < n)
    part = incomplete_beta(np.where(between, n - k, 1.0), np.where(between, k + 1, 1.0), 1 - p, p)
    return np.where(between, part, np.where(k < 0, 0.0, 1.0))


def _more_than(k: Floats, n: Floats, p: Floats) -> Floats:
    """Probability of more than k successes among n, k from -1."""
    between = (k >= 0) & (k < n)
    part = incomplete_beta(np.where(between, k + 1, 1.0), np.where(between, n - k, 1.0), p, 1 - p)
    return np.where(between, part, np.where(k < 0, 1.0, 0.0))


@excel("BINOM.DIST.RANGE", Number, Number, Number, Number(default=None))
def binom_dist_range(trials: Floats, p: Floats, least: Floats, most: Floats | None = None) -> Floats:
    """Probability of `least` to `most` successes; of `least` exactly, without `most`."""
    n, low = np.floor(trials), np.floor(least)
    high = low if most is None else np.floor(most)
    inside = _is_probability(p) & (low >= 0) & (low <= high) & (high <= n)
    low, high = np.where(inside, low, 0.0), np.where(inside, high, 0.0)
    n, p = np.where(inside, n, 1.0), np.where(inside, p, 0.5)
    # The smaller of the two tails is the one whose difference keeps its digits.
    above = _more_than(low - 1, n, p) - _more_than(high, n, p)
    below = _at_most(high, n, p) - _at_most(low - 1, n, p)
    several = np.where(low > n * p, above, below)
    return np.where(inside, np.where(low == high, binomial_mass(low, n - low, p, 1 - p), several), NUM)


@excel("BINOM.INV", Number, Number, Number, aliases=("CRITBINOM",))
def binom_inv(trials: Floats, p: Floats, alpha: Floats) -> Floats:
    """Return the least number of successes whose cumulative probability reaches alpha; for less than 2³¹ trials."""
    n = np.floor(trials)
    inside = (n >= 0) & (n < _LARGEST) & _is_open(p) & _is_open(alpha)
    n, p, alpha = np.where(inside, n, 0.0), np.where(inside, p, 0.5), np.where(inside, alpha, 0.5)
    low, high = np.full(np.shape(n), -1.0), n
    while np.any(high - low > 1):
        middle = np.floor((low + high) / 2)
        reached = (middle > low) & _reaches(np.maximum(middle, 0.0), n, p, alpha)
        low, high = np.where(reached, low, middle), np.where(reached, middle, high)
    return np.where(inside, high, NUM)


def _reaches(k: Floats, n: Floats, p: Floats, alpha: Floats) -> Bools:
    """Whether the probability of at most k successes, k below n, reaches alpha; judged by the smaller tail."""
    upper, more, less = alpha > 0.5, k + 1, np.maximum(n - k, 1.0)
    beta, share = np.where(upper, [more, less], [less, more]), np.where(upper, [p, 1 - p], [1 - p, p])
    tail = incomplete_beta(*beta, *share)
    return np.where(upper, tail <= (1 - alpha) + _SLACK * alpha, tail >= alpha * (1 - _SLACK))


@excel("NEGBINOM.DIST", Number, Number, Number, Logical)
def negbinom_dist(failures: Floats, successes: Floats, p: Floats, cumulative: Bools) -> Floats:
    """Negative binomial distribution: how many failures come before so many successes."""
    k, n = np.floor(failures), np.floor(successes)
    inside = (k >= 0) & (n >= 1) & _is_open(p)
    k, n, p = np.where(inside, k, 0.0), np.where(inside, n, 1.0), np.where(inside, p, 0.5)
    result = by_form(
        cumulative,
        lambda: incomplete_beta(n, k + 1, p, 1 - p),
        lambda: n / (n + k) * binomial_mass(n, k, p, 1 - p),
    )
    return np.where(inside, result, NUM)


@excel("NEGBINOMDIST", Number, Number, Number)
def negbinomdist(failures: Floats, successes: Floats, p: Floats) -> Floats:
    """Probability of exactly so many failures before so many successes."""
    return np.asarray(negbinom_dist(failures, successes, p, np.asarray(False)))


@excel("HYPGEOM.DIST", Number, Number, Number, Number, Logical)
def hypgeom_dist(successes: Floats, drawn: Floats, marked: Floats, size: Floats, cumulative: Bools) -> Floats:
    """Hypergeometric distribution: how many of the things drawn are marked, of less than 2³¹ in all."""
    counts = [np.floor(count) for count in (successes, drawn, marked, size)]
    x, n, m, total = counts
    inside = (x >= np.maximum(0.0, n - total + m)) & (x <= np.minimum(n, m)) & (n > 0) & (n <= total)
    inside = inside & (m > 0) & (m <= total) & (total < _LARGEST)
    x, n, m, total = (np.where(inside, count, 1.0) for count in counts)
    result = by_form(cumulative, lambda: _probability_up_to(x, n, m, total), lambda: _probability_of(x, n, m, total))
    return np.where(inside, result, NUM)


def _probability_of(x: Floats, n: Floats, m: Floats, total: Floats) -> Floats:
    """Probability of x marked among n drawn, where m of the total are marked; 0 where that is impossible."""
    possible = (x >= np.maximum(0.0, n - total + m)) & (x <= np.minimum(n, m))
    x = np.where(possible, x, np.maximum(0.0, n - total + m))
    share, rest = n / total, (total - n) / total
    marked, plain = binomial_mass(x, m - x, share, rest), binomial_mass(n - x, total - m - n + x, share, rest)
    return np.where(possible, marked * (plain / binomial_mass(n, total - n, share, rest)), 0.0)


def _probability_up_to(x: Floats, n: Floats, m: Floats, total: Floats) -> Floats:
    """Probability of at most x marked; above the mean it is 1 less the probability of fewer unmarked ones."""
    low = x * total <= n * m
    k, kind = np.where(low, x, n - x - 1), np.where(low, m, total - m)
    tail = _probability_of(k, n, kind, total) * _relative_tail(k, n, kind, total)
    return np.where(low, tail, 1 - tail)


def _relative_tail(k: Floats, n: Floats, m: Floats, total: Floats) -> Floats:
    """Return the sum of the probabilities of k, k - 1, … in units of that of k; k is at most about the mean."""
    term = np.ones(np.shape(k))
    tail, k = term, np.maximum(k, 0.0)
    while np.any(term > tail * 1e-17):
        step = k * np.maximum(total - m - n + k, 0.0) / ((m - k + 1) * (n - k + 1))
        term, k = term * step, np.maximum(k - 1, 0.0)
        tail = tail + term
    return tail


@excel("HYPGEOMDIST", Number, Number, Number, Number)
def hypgeomdist(successes: Floats, drawn: Floats, marked: Floats, size: Floats) -> Floats:
    """Probability that exactly so many of the things drawn are marked."""
    return np.asarray(hypgeom_dist(successes, drawn, marked, size, np.asarray(False)))
