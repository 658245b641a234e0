"""The beta distribution, and the F distribution of ratios of variances, which is made of it."""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.functions.registry import Logical, Number, excel
from xlmc.functions.statistical.cumulative import by_form
from xlmc.functions.statistical.freedom import degrees_of_freedom
from xlmc.functions.statistical.incomplete_beta import incomplete_beta, inverse_beta
from xlmc.functions.statistical.saddle_point import binomial_mass
from xlmc.functions.values import NUM, Bools, Floats

__all__ = ["f_above", "f_below"]

_HUGE: Final = 1e300


@excel("BETA.DIST", Number, Number, Number, Logical, Number(default=0.0), Number(default=1.0))
def beta_dist(x: Floats, a: Floats, b: Floats, cumulative: Bools, low: Floats, high: Floats) -> Floats:
    """Beta distribution between `low` and `high`; at these ends themselves Excel gives `#NUM!` for the density."""
    inside = (np.asarray(a) > 0) & (b > 0) & (low <= x) & (x <= high) & (low < high)
    inside = inside & (cumulative | ((low < x) & (x < high)))
    a, b = np.where(inside, a, 1.0), np.where(inside, b, 1.0)
    width = np.where(inside, np.subtract(high, low), 1.0)
    z, rest = np.where(inside, np.subtract(x, low), 0.5) / width, np.where(inside, np.subtract(high, x), 0.5) / width
    result = by_form(cumulative, lambda: incomplete_beta(a, b, z, rest), lambda: _density(a, b, z, rest) / width)
    return np.where(inside, result, NUM)


def _density(a: Floats, b: Floats, z: Floats, rest: Floats) -> Floats:
    return binomial_mass(a, b, z, rest) * (a / (a + b) * b) / _not_zero(z) / _not_zero(rest)


def _not_zero(x: Floats) -> Floats:
    return np.where(x == 0, 1.0, x)


@excel("BETADIST", Number, Number, Number, Number(default=0.0), Number(default=1.0))
def betadist(x: Floats, a: Floats, b: Floats, low: Floats, high: Floats) -> Floats:
    """Probability that a beta number between `low` and `high` is at most x."""
    return np.asarray(beta_dist(x, a, b, np.asarray(True), low, high))


@excel("BETA.INV", Number, Number, Number, Number(default=0.0), Number(default=1.0), aliases=("BETAINV",))
def beta_inv(p: Floats, a: Floats, b: Floats, low: Floats, high: Floats) -> Floats:
    """The beta number of a probability, between `low` and `high`."""
    from scipy.special import betaincinv

    inside = (np.asarray(p) > 0) & (p < 1) & (a > 0) & (b > 0) & (low < high)
    z = betaincinv(*(np.where(inside, array, 0.5) for array in (a, b, p)))
    return np.where(inside, low + np.subtract(high, low) * z, NUM)


def _shares(x: Floats, m: Floats, n: Floats) -> tuple[Floats, Floats]:
    """The beta number of an F number and its complement: m·x and n as shares of their sum."""
    ratio = np.minimum(np.divide(m, n) * x, _HUGE)
    return ratio / (1 + ratio), 1 / (1 + ratio)


def f_below(x: Floats, m: Floats, n: Floats) -> Floats:
    """Probability that an F number with m and n degrees of freedom is at most x, 0 or more; arrays that broadcast."""
    share, rest = _shares(x, m, n)
    return incomplete_beta(m / 2, n / 2, share, rest)


def f_above(x: Floats, m: Floats, n: Floats) -> Floats:
    """Probability that an F number with m and n degrees of freedom is above x, 0 or more; arrays that broadcast."""
    share, rest = _shares(x, m, n)
    return incomplete_beta(n / 2, m / 2, rest, share)


def _f_density(x: Floats, m: Floats, n: Floats) -> Floats:
    share, rest = _shares(x, m, n)
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
    """The F number that a probability lies below."""
    (valid1, m), (valid2, n) = degrees_of_freedom(freedom1), degrees_of_freedom(freedom2)
    inside = valid1 & valid2 & (p >= 0) & (p < 1)
    share, rest = inverse_beta(m / 2, n / 2, np.where(inside, p, 0.5))
    return np.where(inside, n / m * (share / rest), NUM)


@excel("F.INV.RT", Number, Number, Number, aliases=("FINV",))
def f_inv_rt(p: Floats, freedom1: Floats, freedom2: Floats) -> Floats:
    """The F number that a probability lies above."""
    (valid1, m), (valid2, n) = degrees_of_freedom(freedom1), degrees_of_freedom(freedom2)
    inside = valid1 & valid2 & (p > 0) & (p <= 1)
    rest, share = inverse_beta(n / 2, m / 2, np.where(inside, p, 0.5))
    return np.where(inside, n / m * (share / rest), NUM)
