"""The beta distribution and its kin: F and Student's t.

The incomplete beta function of x loses digits where x is near 1, so that every caller also says what 1 - x is, as it
knows it best, and the smaller of the two is worked with.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from xlmc.functions.cumulative import by_form
from xlmc.functions.registry import Logical, Number, excel
from xlmc.functions.saddle_point import binomial_mass, deviance, stirling_error
from xlmc.functions.values import DIV0, NUM, Bools, Floats

__all__ = ["f_above", "t_outside"]

_MOST_FREEDOM: Final = 1e10
_HUGE: Final = 1e300
_FAR: Final = 1e17
"""From this t²/freedom on, the first term of the t distribution's tail is all of it."""


def _incomplete(a: Any, b: Any, x: Any, y: Any) -> Floats:
    """The regularised incomplete beta function of x, where y = 1 - x; arrays that broadcast."""
    from scipy.special import betainc, betaincc

    low = np.asarray(x) <= y
    out = np.empty(np.broadcast_shapes(*(np.shape(array) for array in (a, b, low))))
    betainc(a, b, x, out=out, where=low)
    betaincc(b, a, y, out=out, where=~low)
    return out


def _inverse(a: Floats, b: Floats, p: Floats) -> tuple[Floats, Floats]:
    """The x at which `_incomplete` is p, and 1 - x, each to all of its digits."""
    from scipy.special import betainccinv, betaincinv

    return np.asarray(betaincinv(a, b, p)), np.asarray(betainccinv(b, a, p))


@excel("BETA.DIST", Number, Number, Number, Logical, Number(default=0.0), Number(default=1.0))
def beta_dist(x: Floats, a: Floats, b: Floats, cumulative: Bools, low: Floats, high: Floats) -> Floats:
    """Beta distribution between `low` and `high`; of these ends themselves Excel gives no density, but `#NUM!`."""
    inside = (np.asarray(a) > 0) & (b > 0) & (low <= x) & (x <= high) & (low < high)
    inside = inside & (cumulative | ((low < x) & (x < high)))
    a, b = np.where(inside, a, 1.0), np.where(inside, b, 1.0)
    width = np.where(inside, np.subtract(high, low), 1.0)
    z, rest = (np.where(inside, np.subtract(*ends), 0.5) / width for ends in ((x, low), (high, x)))
    result = by_form(cumulative, lambda: _incomplete(a, b, z, rest), lambda: _density(a, b, z, rest) / width)
    return np.where(inside, result, NUM)


def _density(a: Floats, b: Floats, z: Floats, rest: Floats) -> Floats:
    return binomial_mass(a, a + b, z, rest) * (a / (a + b)) * b / _not_zero(z) / _not_zero(rest)


def _not_zero(x: Floats) -> Floats:
    return np.where(x == 0, 1.0, x)


@excel("BETADIST", Number, Number, Number, Number(default=0.0), Number(default=1.0))
def betadist(x: Floats, a: Floats, b: Floats, low: Floats, high: Floats) -> Floats:
    """Probability that a beta number between `low` and `high` is at most x."""
    return beta_dist(x, a, b, np.asarray(True), low, high)


@excel("BETA.INV", Number, Number, Number, Number(default=0.0), Number(default=1.0), aliases=("BETAINV",))
def beta_inv(p: Floats, a: Floats, b: Floats, low: Floats, high: Floats) -> Floats:
    """The beta number of a probability, between `low` and `high`."""
    from scipy.special import betaincinv

    inside = (np.asarray(p) > 0) & (p < 1) & (a > 0) & (b > 0) & (low < high)
    z = betaincinv(*(np.where(inside, array, 0.5) for array in (a, b, p)))
    return np.where(inside, low + (high - low) * z, NUM)


def _freedom(given: Floats) -> tuple[Bools, Floats]:
    """Whether these are degrees of freedom, and their whole number."""
    valid = (np.asarray(given) >= 1) & (given <= _MOST_FREEDOM)
    return valid, np.floor(np.where(valid, given, 1.0))


@excel("F.DIST", Number, Number, Number, Logical)
def f_dist(x: Floats, freedom1: Floats, freedom2: Floats, cumulative: Bools) -> Floats:
    """F distribution of x, 0 or more; its density is infinite at 0, so `#NUM!`, with 1 degree of freedom."""
    (valid1, m), (valid2, n) = _freedom(freedom1), _freedom(freedom2)
    inside = valid1 & valid2 & (x >= 0)
    x = np.where(inside, x, 1.0)
    result = by_form(cumulative, lambda: 1 - f_above(x, m, n, True), lambda: _f_density(x, m, n))
    return np.where(inside, result, NUM)


def _shares(x: Floats, m: Floats, n: Floats) -> tuple[Floats, Floats]:
    """The beta numbers of an F number: m·x and n as shares of their sum."""
    ratio = np.minimum(np.divide(m, n) * x, _HUGE)
    return ratio / (1 + ratio), 1 / (1 + ratio)
