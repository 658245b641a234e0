"""What distribution functions share: their two forms, degrees of freedom, and probabilities without loss of digits.

A probability mass is a ratio of factorials times powers, each of which may be enormous. Their logarithms nearly cancel,
which would lose digits. Loader's saddle-point expansion splits the mass into deviances, which are small near the mode
and exact far from it. Its arguments need not be whole, so that the densities of the gamma, beta, F and t distributions
come from the same two masses. Source: C. Loader, "Fast and Accurate Computation of Binomial Probabilities", 2000.

The incomplete beta function of x loses digits where x is near 1. So the caller gives y = 1 - x as well, as exactly as
it can, and the smaller of the two is used.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from xlmc.excel.functions.values import Bools, Floats

__all__ = [
    "ROOT_2PI",
    "binomial_mass",
    "by_form",
    "degrees_of_freedom",
    "deviance",
    "incomplete_beta",
    "inverse_beta",
    "poisson_mass",
    "stirling_error",
]


def incomplete_beta(a: Floats, b: Floats, x: Floats, y: Floats) -> Floats:
    """Return the regularised incomplete beta function, the probability of a number up to x = 1 - y; arrays that
    broadcast.
    """
    from scipy.special import betainc, betaincc

    low = np.asarray(x) <= y
    out = np.empty(np.broadcast_shapes(np.shape(a), np.shape(b), np.shape(low)))
    betainc(a, b, x, out=out, where=low)
    betaincc(b, a, y, out=out, where=~low)
    return out


def inverse_beta(a: Floats, b: Floats, p: Floats) -> tuple[Floats, Floats]:
    """Return the quantile x of the beta distribution, and 1 - x; arrays that broadcast."""
    from scipy.special import betainccinv, betaincinv

    return np.asarray(betaincinv(a, b, p)), np.asarray(betainccinv(b, a, p))


_MOST_FREEDOM: Final = 1e10


def degrees_of_freedom(given: Floats) -> tuple[Bools, Floats]:
    """Whether numbers are degrees of freedom, 1 to 10¹⁰; and the numbers without fractions, 1 where they are not."""
    valid = (np.asarray(given) >= 1) & (given <= _MOST_FREEDOM)
    return valid, np.floor(np.where(valid, given, 1.0))


def by_form(cumulative: Bools, probability: Callable[[], Any], density: Callable[[], Any]) -> Floats:
    """Return the probability up to a point where `cumulative`, else the density there; each is computed only
    if needed.
    """
    below = probability() if np.any(cumulative) else 0.0
    at = 0.0 if np.all(cumulative) else density()
    return np.where(cumulative, below, at)


_SERIES_FROM: Final = 16.0
_STIRLING: Final = (1 / 12, -1 / 360, 1 / 1260, -1 / 1680, 1 / 1188)
"""Coefficients of 1/x, 1/x³, 1/x⁵, …: from 16 on the first term left out is below 1e-16."""

_NEAR: Final = 0.1
_DEVIANCE_TERMS: Final = 9
"""With |v| < 0.1 the first term left out is below 1e-20 of the deviance."""

_LOG_2PI: Final = float(np.log(2 * np.pi))
ROOT_2PI: Final = float(np.sqrt(2 * np.pi))


def stirling_error(x: Floats) -> Floats:
    """Logarithm of Γ(x + 1) minus Stirling's formula for it, x above 0; any shape -> the same."""
    from scipy.special import gammaln

    large = np.maximum(x, _SERIES_FROM)
    inverse = 1 / (large * large)
    series = np.zeros(np.shape(x))
    for coefficient in reversed(_STIRLING):
        series = series * inverse + coefficient
    small = np.minimum(x, _SERIES_FROM)
    exact = gammaln(small + 1) - (small + 0.5) * np.log(small) + small - _LOG_2PI / 2
    return np.where(x < _SERIES_FROM, exact, series / large)


def deviance(x: Floats, mean: Floats) -> Floats:
    """x·ln(x/mean) + mean - x, x and mean above 0: no digits are lost where x is near the mean."""
    v = (x - mean) / (x + mean)
    near = np.abs(v) < _NEAR
    small = np.where(near, v, 0.0)
    square, tail = small * small, np.zeros(np.shape(v))
    for j in range(_DEVIANCE_TERMS, 0, -1):
        tail = tail * square + 2 / (2 * j + 1)
    close = (x - mean) * v + x * small * square * tail
    return np.where(near, close, x * np.log(np.divide(x, mean)) + mean - x)


def poisson_mass(x: Floats, mean: Floats) -> Floats:
    """mean^x·e^-mean / Γ(x + 1), x and mean 0 or more; arrays that broadcast."""
    from scipy.special import gammaln, xlogy

    few = np.minimum(x, _SERIES_FROM)
    direct = np.exp(xlogy(few, mean) - mean - gammaln(few + 1))
    many = np.maximum(x, _SERIES_FROM)
    some = np.where(np.asarray(mean) > 0, mean, 1.0)
    expansion = np.exp(-stirling_error(many) - deviance(many, some)) / np.sqrt(2 * np.pi * many)
    return np.where(x < _SERIES_FROM, direct, np.where(np.asarray(mean) > 0, expansion, 0.0))


def binomial_mass(x: Floats, y: Floats, p: Floats, q: Floats) -> Floats:
    """Γ(x+y+1)/(Γ(x+1)·Γ(y+1))·p^x·q^y, x and y 0 or more, p + q = 1, each as exact as it is known; they broadcast."""
    from scipy.special import xlog1py, xlogy

    inside = (x > 0) & (y > 0) & (p > 0) & (q > 0)
    hits, misses = np.where(inside, x, 1.0), np.where(inside, y, 1.0)
    odds, against, n = np.where(inside, p, 0.5), np.where(inside, q, 0.5), hits + misses
    log_mass = stirling_error(n) - stirling_error(hits) - stirling_error(misses)
    log_mass = log_mass - deviance(hits, n * odds) - deviance(misses, n * against)
    log_mass = log_mass - (_LOG_2PI + np.log(hits) + np.log(misses / n)) / 2
    powers = xlogy(x, p) + np.where(np.asarray(q) > 0.5, xlog1py(y, -np.minimum(p, 0.5)), xlogy(y, q))
    return np.asarray(np.exp(np.where(inside, log_mass, powers)))
