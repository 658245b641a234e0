"""The gamma distribution and its kin: chi-square, exponential, Weibull; the gamma function."""

from __future__ import annotations

import numpy as np

from xlmc.excel.functions.registry import Logical, Number, excel
from xlmc.excel.functions.statistical.probabilities import by_form, degrees_of_freedom, poisson_mass
from xlmc.excel.functions.values import NUM, Bools, Floats

__all__ = ["chi_square_above"]


@excel("GAMMA", Number)
def gamma(x: Floats) -> Floats:
    """Return the gamma function; `#NUM!` for 0 and negative whole numbers."""
    from scipy.special import gamma as function

    pole = (x <= 0) & (np.floor(x) == x)
    return np.where(pole, NUM, function(np.where(pole, 1.0, x)))


@excel("GAMMALN", Number, aliases=("GAMMALN.PRECISE",))
def gamma_ln(x: Floats) -> Floats:
    """Logarithm of the gamma function, of numbers above 0."""
    from scipy.special import gammaln

    return np.where(x > 0, gammaln(np.where(x > 0, x, 1.0)), NUM)


@excel("GAMMA.DIST", Number, Number, Number, Logical, aliases=("GAMMADIST",))
def gamma_dist(x: Floats, shape: Floats, scale: Floats, cumulative: Bools) -> Floats:
    """Gamma distribution of x, 0 or more; its density is infinite at 0, so `#NUM!`, for shapes below 1."""
    inside = (np.asarray(x) >= 0) & (shape > 0) & (scale > 0)
    a, b = np.where(inside, shape, 1.0), np.where(inside, scale, 1.0)
    y = np.where(inside, x, 1.0) / b
    return np.where(inside, by_form(cumulative, lambda: _below(a, y), lambda: _density(a, y) / b), NUM)


def _below(a: Floats, y: Floats) -> Floats:
    from scipy.special import gammainc

    return np.asarray(gammainc(a, y))


def _density(a: Floats, y: Floats) -> Floats:
    inside = np.where(y > 0, poisson_mass(a, y) * a / np.where(y > 0, y, 1.0), 0.0)
    return np.where((y == 0) & (a <= 1), np.where(a == 1, 1.0, NUM), inside)


@excel("GAMMA.INV", Number, Number, Number, aliases=("GAMMAINV",))
def gamma_inv(p: Floats, shape: Floats, scale: Floats) -> Floats:
    """Quantile of the gamma distribution."""
    from scipy.special import gammaincinv

    inside = (np.asarray(p) >= 0) & (p < 1) & (shape > 0) & (scale > 0)
    return np.where(inside, gammaincinv(np.where(inside, shape, 1.0), np.where(inside, p, 0.0)) * scale, NUM)


@excel("CHISQ.DIST", Number, Number, Logical)
def chisq_dist(x: Floats, freedom: Floats, cumulative: Bools) -> Floats:
    """Chi-square distribution."""
    valid, k = degrees_of_freedom(freedom)
    return np.where(valid, gamma_dist(x, k / 2, np.asarray(2.0), cumulative), NUM)


def chi_square_above(x: Floats, freedom: Floats) -> Floats:
    """Probability that a chi-square number is above x, 0 or more; arrays that broadcast."""
    from scipy.special import gammaincc

    return np.asarray(gammaincc(freedom / 2, x / 2))


@excel("CHISQ.DIST.RT", Number, Number, aliases=("CHIDIST",))
def chisq_dist_rt(x: Floats, freedom: Floats) -> Floats:
    """Probability that a chi-square number is above x."""
    valid, k = degrees_of_freedom(freedom)
    inside = valid & (x >= 0)
    return np.where(inside, chi_square_above(np.where(inside, x, 0.0), k), NUM)


@excel("CHISQ.INV", Number, Number)
def chisq_inv(p: Floats, freedom: Floats) -> Floats:
    """Quantile of the chi-square distribution: p is the probability below it."""
    valid, k = degrees_of_freedom(freedom)
    return np.where(valid, gamma_inv(p, k / 2, np.asarray(2.0)), NUM)


@excel("CHISQ.INV.RT", Number, Number, aliases=("CHIINV",))
def chisq_inv_rt(p: Floats, freedom: Floats) -> Floats:
    """Quantile of the chi-square distribution: p is the probability above it."""
    from scipy.special import gammainccinv

    valid, k = degrees_of_freedom(freedom)
    inside = valid & (p > 0) & (p <= 1)
    return np.where(inside, gammainccinv(k / 2, np.where(inside, p, 1.0)) * 2, NUM)


@excel("EXPON.DIST", Number, Number, Logical, aliases=("EXPONDIST",))
def expon_dist(x: Floats, rate: Floats, cumulative: Bools) -> Floats:
    """Exponential distribution of x, 0 or more."""
    inside = (np.asarray(x) >= 0) & (rate > 0)
    y = np.where(inside, x, 0.0) * rate
    return np.where(inside, by_form(cumulative, lambda: -np.expm1(-y), lambda: rate * np.exp(-y)), NUM)


@excel("WEIBULL.DIST", Number, Number, Number, Logical, aliases=("WEIBULL",))
def weibull_dist(x: Floats, shape: Floats, scale: Floats, cumulative: Bools) -> Floats:
    """Weibull distribution of x, 0 or more; its density is infinite at 0, so `#NUM!`, for shapes below 1.

    At 0 Excel gives the density 0 for the shape 1 too, where it is 1/scale.
    """
    inside = (np.asarray(x) >= 0) & (shape > 0) & (scale > 0)
    a, b = np.where(inside, shape, 1.0), np.where(inside, scale, 1.0)
    y = np.where(inside, x, 1.0) / b
    log_y = np.log(np.where(y > 0, y, 1.0))
    z = np.where(y > 0, np.exp(a * log_y), 0.0)
    result = by_form(cumulative, lambda: -np.expm1(-z), lambda: _weibull_density(a, y, log_y, z) / b)
    return np.where(inside, result, NUM)


def _weibull_density(a: Floats, y: Floats, log_y: Floats, z: Floats) -> Floats:
    at_zero = np.where(a < 1, NUM, 0.0)
    return np.where(y > 0, a * np.exp((a - 1) * log_y - z), at_zero)
