"""The normal and the lognormal distribution, and functions based on them."""

from __future__ import annotations

import numpy as np

from xlmc.excel.functions.registry import Logical, Number, excel
from xlmc.excel.functions.statistical.probabilities import ROOT_2PI, by_form
from xlmc.excel.functions.values import NUM, Bools, Floats

__all__: list[str] = []


def _below(z: Floats) -> Floats:
    from scipy.special import ndtr

    return np.asarray(ndtr(z))


def _quantile(p: Floats) -> Floats:
    """Return the inverse of `_below`; any number where p is no probability above 0 and below 1."""
    from scipy.special import ndtri

    return np.asarray(ndtri(np.where(_is_open_probability(p), p, 0.5)))


def _is_open_probability(p: Floats) -> Bools:
    return (p > 0) & (p < 1)


@excel("PHI", Number)
def phi(z: Floats) -> Floats:
    """Density of the standard normal distribution."""
    return np.exp(-z * z / 2) / ROOT_2PI


@excel("GAUSS", Number)
def gauss(z: Floats) -> Floats:
    """Probability that a standard normal number lies between 0 and z."""
    from scipy.special import erf

    return np.asarray(erf(z / np.sqrt(2)) / 2)


@excel("NORM.S.DIST", Number, Logical)
def norm_s_dist(z: Floats, cumulative: Bools) -> Floats:
    """Return the standard normal distribution."""
    return by_form(cumulative, lambda: _below(z), lambda: phi(z))


@excel("NORMSDIST", Number)
def normsdist(z: Floats) -> Floats:
    """Probability that a standard normal number is at most z."""
    return _below(z)


@excel("NORM.S.INV", Number, aliases=("NORMSINV",))
def norm_s_inv(p: Floats) -> Floats:
    """Quantile of the standard normal distribution."""
    return np.where(_is_open_probability(p), _quantile(p), NUM)


@excel("STANDARDIZE", Number, Number, Number)
def standardize(x: Floats, mean: Floats, deviation: Floats) -> Floats:
    """Distance from the mean in standard deviations."""
    positive = np.asarray(deviation) > 0
    return np.where(positive, (x - mean) / np.where(positive, deviation, 1.0), NUM)


@excel("NORM.DIST", Number, Number, Number, Logical, aliases=("NORMDIST",))
def norm_dist(x: Floats, mean: Floats, deviation: Floats, cumulative: Bools) -> Floats:
    """Return the normal distribution."""
    spread = np.where(np.asarray(deviation) > 0, deviation, 1.0)
    z = (x - mean) / spread
    result = by_form(cumulative, lambda: _below(z), lambda: phi(z) / spread)
    return np.where(np.asarray(deviation) > 0, result, NUM)


@excel("NORM.INV", Number, Number, Number, aliases=("NORMINV",))
def norm_inv(p: Floats, mean: Floats, deviation: Floats) -> Floats:
    """Quantile of the normal distribution."""
    return np.where(_is_open_probability(p) & (deviation > 0), mean + deviation * _quantile(p), NUM)


@excel("LOGNORM.DIST", Number, Number, Number, Logical)
def lognorm_dist(x: Floats, mean: Floats, deviation: Floats, cumulative: Bools) -> Floats:
    """Lognormal distribution; mean and standard deviation are those of ln x."""
    inside = (np.asarray(x) > 0) & (deviation > 0)
    point, spread = np.where(inside, x, 1.0), np.where(inside, deviation, 1.0)
    z = (np.log(point) - mean) / spread
    result = by_form(cumulative, lambda: _below(z), lambda: phi(z) / spread / point)
    return np.where(inside, result, NUM)


@excel("LOGNORMDIST", Number, Number, Number)
def lognormdist(x: Floats, mean: Floats, deviation: Floats) -> Floats:
    """Probability that a lognormal number is at most x."""
    return np.asarray(lognorm_dist(x, mean, deviation, np.asarray(True)))


@excel("LOGNORM.INV", Number, Number, Number, aliases=("LOGINV",))
def lognorm_inv(p: Floats, mean: Floats, deviation: Floats) -> Floats:
    """Quantile of the lognormal distribution; mean and standard deviation are those of the logarithm."""
    inside = _is_open_probability(p) & (deviation > 0)
    return np.where(inside, np.exp(np.where(inside, mean + deviation * _quantile(p), 0.0)), NUM)


@excel("CONFIDENCE.NORM", Number, Number, Number, aliases=("CONFIDENCE",))
def confidence_norm(alpha: Floats, deviation: Floats, size: Floats) -> Floats:
    """Half the width of the interval that holds a mean with probability 1 - alpha; the deviation is known."""
    k = np.floor(size)
    inside = _is_open_probability(alpha) & (deviation > 0) & (k >= 1)
    return np.where(inside, -_quantile(alpha / 2) * deviation / np.sqrt(np.maximum(k, 1.0)), NUM)


@excel("FISHER", Number)
def fisher(r: Floats) -> Floats:
    """Fisher's transformation of a correlation."""
    inside = np.abs(r) < 1
    return np.where(inside, np.arctanh(np.where(inside, r, 0.0)), NUM)


excel("FISHERINV", Number)(np.tanh)
