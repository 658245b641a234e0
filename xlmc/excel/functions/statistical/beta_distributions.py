"""The beta distribution, and two that are made of it: F, of ratios of variances, and Student's t."""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.excel.functions.registry import Logical, Number, excel
from xlmc.excel.functions.statistical.probabilities import (
    ROOT_2PI,
    binomial_mass,
    by_form,
    degrees_of_freedom,
    deviance,
    incomplete_beta,
    inverse_beta,
    stirling_error,
)
from xlmc.excel.functions.values import DIV0, NUM, Bools, Floats

__all__ = ["f_above", "f_below", "t_outside"]

_HUGE: Final = 1e300


@excel("BETA.DIST", Number, Number, Number, Logical, Number(default=0.0), Number(default=1.0))
def beta_dist(x: Floats, a: Floats, b: Floats, cumulative: Bools, low: Floats, high: Floats) -> Floats:
    """Beta distribution between `low` and `high`; at these ends themselves Excel gives `#NUM!` for the density."""
    inside = (np.asarray(a) > 0) & (b > 0) & (low <= x) & (x <= high) & (low < high)
    inside = inside & (cumulative | ((low < x) & (x < high)))
    a, b = np.where(inside, a, 1.0), np.where(inside, b, 1.0)
    width = np.where(inside, np.subtract(high, low), 1.0)
    z, rest = np.where(inside, np.subtract(x, low), 0.5) / width, np.where(inside, np.subtract(high, x), 0.5) / width
    result = by_form(cumulative, lambda: incomplete_beta(a, b, z, rest), lambda: _beta_density(a, b, z, rest) / width)
    return np.where(inside, result, NUM)


def _beta_density(a: Floats, b: Floats, z: Floats, rest: Floats) -> Floats:
    return binomial_mass(a, b, z, rest) * (a / (a + b) * b) / _not_zero(z) / _not_zero(rest)


def _not_zero(x: Floats) -> Floats:
    return np.where(x == 0, 1.0, x)


@excel("BETADIST", Number, Number, Number, Number(default=0.0), Number(default=1.0))
def betadist(x: Floats, a: Floats, b: Floats, low: Floats, high: Floats) -> Floats:
    """Probability that a beta number between `low` and `high` is at most x."""
    return np.asarray(beta_dist(x, a, b, np.asarray(True), low, high))


@excel("BETA.INV", Number, Number, Number, Number(default=0.0), Number(default=1.0), aliases=("BETAINV",))
def beta_inv(p: Floats, a: Floats, b: Floats, low: Floats, high: Floats) -> Floats:
    """Quantile of the beta distribution between `low` and `high`; `#NUM!` at the probabilities 0 and 1."""
    from scipy.special import betaincinv

    inside = (np.asarray(p) > 0) & (p < 1) & (a > 0) & (b > 0) & (low < high)
    z = betaincinv(*(np.where(inside, array, 0.5) for array in (a, b, p)))
    return np.where(inside, low + np.subtract(high, low) * z, NUM)


def _to_beta(x: Floats, m: Floats, n: Floats) -> tuple[Floats, Floats]:
    """Return the beta-distributed number that belongs to an F number, and 1 less it: m·x and n as shares of
    their sum.
    """
    ratio = np.minimum(np.divide(m, n) * x, _HUGE)
    return ratio / (1 + ratio), 1 / (1 + ratio)


def f_below(x: Floats, m: Floats, n: Floats) -> Floats:
    """Probability that an F number with m and n degrees of freedom is at most x, 0 or more; arrays that broadcast."""
    share, rest = _to_beta(x, m, n)
    return incomplete_beta(m / 2, n / 2, share, rest)


def f_above(x: Floats, m: Floats, n: Floats) -> Floats:
    """Probability that an F number with m and n degrees of freedom is above x, 0 or more; arrays that broadcast."""
    share, rest = _to_beta(x, m, n)
    return incomplete_beta(n / 2, m / 2, rest, share)


def _f_density(x: Floats, m: Floats, n: Floats) -> Floats:
    share, rest = _to_beta(x, m, n)
    inside = binomial_mass(m / 2, n / 2, share, rest) * m / (m + n) * m / 2 * rest / _not_zero(share)
    at_zero = np.where(m < 2, NUM, np.where(m == 2, 1.0, 0.0))
    return np.where(share == 0, at_zero, inside)


@excel("F.DIST", Number, Number, Number, Logical)
def f_dist(x: Floats, freedom1: Floats, freedom2: Floats, cumulative: Bools) -> Floats:
    """F distribution of x, 0 or more; its density is infinite at 0, so `#NUM!`, with 1 degree of freedom."""
    (valid1, m), (valid2, n) = degrees_of_freedom(freedom1), degrees_of_freedom(freedom2)
    inside = valid1 & valid2 & (x >= 0)
    point = np.where(inside, x, 1.0)
    return np.where(inside, by_form(cumulative, lambda: f_below(point, m, n), lambda: _f_density(point, m, n)), NUM)


@excel("F.DIST.RT", Number, Number, Number, aliases=("FDIST",))
def f_dist_rt(x: Floats, freedom1: Floats, freedom2: Floats) -> Floats:
    """Probability that an F number is above x, 0 or more."""
    (valid1, m), (valid2, n) = degrees_of_freedom(freedom1), degrees_of_freedom(freedom2)
    inside = valid1 & valid2 & (x >= 0)
    return np.where(inside, f_above(np.where(inside, x, 1.0), m, n), NUM)


@excel("F.INV", Number, Number, Number)
def f_inv(p: Floats, freedom1: Floats, freedom2: Floats) -> Floats:
    """Quantile of the F distribution: p is the probability below it."""
    (valid1, m), (valid2, n) = degrees_of_freedom(freedom1), degrees_of_freedom(freedom2)
    inside = valid1 & valid2 & (p >= 0) & (p < 1)
    share, rest = inverse_beta(m / 2, n / 2, np.where(inside, p, 0.5))
    return np.where(inside, n / m * (share / rest), NUM)


@excel("F.INV.RT", Number, Number, Number, aliases=("FINV",))
def f_inv_rt(p: Floats, freedom1: Floats, freedom2: Floats) -> Floats:
    """Quantile of the F distribution: p is the probability above it."""
    (valid1, m), (valid2, n) = degrees_of_freedom(freedom1), degrees_of_freedom(freedom2)
    inside = valid1 & valid2 & (p > 0) & (p <= 1)
    rest, share = inverse_beta(n / 2, m / 2, np.where(inside, p, 0.5))
    return np.where(inside, n / m * (share / rest), NUM)


_FAR: Final = 1e17
"""From this t²/freedom on, the first term of the tail's series is enough."""

_HALF: Final = np.asarray(0.5)


def _log_tail(freedom: Floats) -> Floats:
    """Logarithm of c in the tail c·(t²/freedom)^(-freedom/2) that the distribution tends to."""
    from scipy.special import betaln

    return np.asarray(-np.log(freedom / 2) - betaln(freedom / 2, 0.5))


def t_outside(t: Floats, freedom: Floats) -> Floats:
    """Probability that the size of a t number is above t, 0 or more; arrays that broadcast."""
    root = t / np.sqrt(freedom)
    far = root > np.sqrt(_FAR)
    ratio = np.where(far, 1.0, root) * np.where(far, 1.0, root)
    near = incomplete_beta(freedom / 2, _HALF, 1 / (1 + ratio), ratio / (1 + ratio))
    tail = np.exp(_log_tail(freedom) - freedom * np.log(np.where(far, root, 1.0)))
    return np.where(far, tail, near)


def _t_quantile(p: Floats, freedom: Floats) -> Floats:
    """Return the t, 0 or more, that the size of a t number exceeds with probability p; arrays that broadcast."""
    rest, share = inverse_beta(freedom / 2, _HALF, p)
    far = rest < 1 / _FAR
    near = np.sqrt(freedom * (share / np.where(far, 1.0, rest)))
    tail = np.exp(np.where(far, _log_tail(freedom) - np.log(p), 0.0) / freedom) * np.sqrt(freedom)
    return np.where(far, tail, near)


def _student_density(t: Floats, freedom: Floats) -> Floats:
    more = (freedom + 1) / 2
    log_scale = stirling_error(more) - stirling_error(freedom / 2) - deviance(freedom / 2, more)
    return np.exp(log_scale - more * np.log1p(t / freedom * t)) / ROOT_2PI


def _t_below(t: Floats, freedom: Floats) -> Floats:
    outside = t_outside(np.abs(t), freedom) / 2
    return np.where(t < 0, outside, 1 - outside)


@excel("T.DIST", Number, Number, Logical)
def t_dist(t: Floats, freedom: Floats, cumulative: Bools) -> Floats:
    """Student's t distribution; the density with 0 degrees of freedom is `#DIV/0!`, as in Excel."""
    valid, k = degrees_of_freedom(freedom)
    result = by_form(cumulative, lambda: _t_below(t, k), lambda: _student_density(t, k))
    error = np.where((np.floor(freedom) == 0) & ~np.asarray(cumulative), DIV0, NUM)
    return np.where(valid, result, error)


@excel("T.DIST.RT", Number, Number)
def t_dist_rt(t: Floats, freedom: Floats) -> Floats:
    """Probability that a t number is above t."""
    valid, k = degrees_of_freedom(freedom)
    return np.where(valid, _t_below(-t, k), NUM)


@excel("T.DIST.2T", Number, Number)
def t_dist_2t(t: Floats, freedom: Floats) -> Floats:
    """Probability that the size of a t number is above t, which must not be negative."""
    valid, k = degrees_of_freedom(freedom)
    return np.where(valid & (t >= 0), t_outside(np.abs(t), k), NUM)


@excel("TDIST", Number, Number, Number)
def tdist(t: Floats, freedom: Floats, tails: Floats) -> Floats:
    """Probability that a t number (1 tail), or its size (2 tails), is above t, which must not be negative."""
    both, sides = t_dist_2t(t, freedom), np.floor(tails)
    return np.where((sides == 1) | (sides == 2), np.where(sides == 1, both / 2, both), NUM)


@excel("T.INV", Number, Number)
def t_inv(p: Floats, freedom: Floats) -> Floats:
    """Quantile of Student's t distribution: p is the probability below it."""
    valid, k = degrees_of_freedom(freedom)
    inside = valid & (p > 0) & (p < 1)
    q = np.where(inside, p, 0.5)
    size = _t_quantile(2 * np.minimum(q, 1 - q), k)
    return np.where(inside, np.where(q < 0.5, -size, size), NUM)


@excel("T.INV.2T", Number, Number, aliases=("TINV",))
def t_inv_2t(p: Floats, freedom: Floats) -> Floats:
    """Return the t, 0 or more, that the size of a t number exceeds with probability p."""
    valid, k = degrees_of_freedom(freedom)
    inside = valid & (p > 0) & (p <= 1)
    return np.where(inside, _t_quantile(np.where(inside, p, 0.5), k), NUM)


@excel("CONFIDENCE.T", Number, Number, Number)
def confidence_t(alpha: Floats, deviation: Floats, size: Floats) -> Floats:
    """Half the width of the interval that holds a mean with probability 1 - alpha; the deviation is of the sample."""
    k = np.floor(size)
    inside = (np.asarray(alpha) > 0) & (alpha < 1) & (deviation > 0) & (k > 1)
    t = _t_quantile(np.where(inside, alpha, 0.5), np.where(inside, k, 2.0) - 1)
    alone = (np.asarray(alpha) > 0) & (alpha < 1) & (deviation > 0) & (k == 1)
    return np.where(inside, t * deviation / np.sqrt(np.maximum(k, 1.0)), np.where(alone, DIV0, NUM))
