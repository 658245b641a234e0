"""Poisson: how many independent events fall into an interval, at a known mean rate.

SciPy's incomplete gamma function is right to 1e-13 within 4.5 standard deviations of a large mean, and loses digits
beyond (2e-6 at a rate of 1e9), where its continued fraction is cut short. There, the first two terms of the uniform
expansion leave a relative error below 1e-12.

Source: N. M. Temme, "The asymptotic expansion of the incomplete gamma functions", SIAM J. Math. Anal. 10, 1979.
"""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.parameters import Constraint
from xlmc.montecarlo.distributions.whole_numbers import MOST, RATE, WholeNumbers

__all__ = ["Poisson"]

_LARGE, _FAR = 1e5, 4.4

_NEAR, _TERMS = 0.1, 18


class Poisson(WholeNumbers):
    """Poisson with the mean number of events, which Crystal Ball calls its rate: 0, 1, 2, …

    >>> poisson = Poisson()
    >>> print(poisson.ppf(np.array([0.0, 0.5, 0.99]), rate=4))
    [0. 4. 9.]
    >>> poisson.check(rate=-1)
    'Rate (-1) must be from 0 to 1,000,000,000'
    >>> print(poisson.ppf(0.5, np.array([4.0, -4.0])))
    [ 4. nan]
    """

    name = "Poisson"
    formula = "P(k) = Rate^k·e^(-Rate) / k!"
    source = "N. L. Johnson, A. W. Kemp and S. Kotz, Univariate Discrete Distributions, 2005, chapter 4"
    elsewhere = ("Crystal Ball CB.Poisson(rate)", "@RISK Poisson(rate)")
    parameters = (RATE,)
    rules = (
        Constraint(
            "rate",
            lambda rate: (rate >= 0) & (rate <= MOST),
            f"Rate ({{rate}}) must be from 0 to {MOST:,.0f}",
            "Type the mean number of events",
        ),
    )

    def _at_most(self, k: Array, rate: Values) -> Values:
        return _poisson_at_most(k, rate)

    def _at_least(self, k: Array, rate: Values) -> Values:
        return _poisson_at_least(np.maximum(k, 1), rate)

    def _mean(self, rate: Values) -> Values:
        return rate

    def _variance(self, rate: Values) -> Values:
        return rate

    def _skewness(self, rate: Values) -> Values:
        return 1 / np.sqrt(np.maximum(rate, 1e-300))

    def _support(self, rate: Values) -> tuple[Values, Values]:
        return 0 * rate, np.where(np.equal(rate, 0), 0.0, np.inf)


def _poisson_at_most(k: Array, rate: Values) -> Array:
    """P(X <= k), k from 0 up."""
    from scipy.special import gammaincc

    return _from_the_right_side(k + 1, rate, gammaincc(k + 1, rate), 1.0)


def _poisson_at_least(k: Array, rate: Values) -> Array:
    """P(X >= k), k from 1 up."""
    from scipy.special import gammainc

    return _from_the_right_side(k, rate, gammainc(k, rate), -1.0)


def _from_the_right_side(shape: Array, rate: Values, value: Array, side: float) -> Array:
    """`value` with what lies far from a large mean replaced; `side` is 1 for the upper incomplete gamma function."""
    far = (shape > _LARGE) & (np.abs(rate - shape) > _FAR * np.sqrt(shape))
    if not np.any(far):
        return value
    a, x = (np.broadcast_to(each, np.shape(far))[far] for each in (shape, rate))
    mended = np.array(np.broadcast_to(value, np.shape(far)))
    mended[far] = _expanded(a, x, side)
    return mended


def _expanded(a: Array, x: Array, side: float) -> Array:
    from scipy.special import erfc

    mu = np.maximum((x - a) / a, 2.0**-53 - 1)
    half_square = _less_logarithm(mu)  # η²/2 = μ - ln(1 + μ)
    eta = np.sign(mu) * np.sqrt(2 * half_square)
    first = 1 / mu - 1 / eta
    second = 1 / eta**3 - 1 / mu**3 - 1 / mu**2 - 1 / (12 * mu)
    with np.errstate(under="ignore"):
        correction = np.exp(-a * half_square) / np.sqrt(2 * np.pi * a) * (first + second / a)
        tail = erfc(side * eta * np.sqrt(a / 2)) / 2 + side * correction
    return np.asarray(np.clip(tail, 0.0, 1.0))


def _less_logarithm(mu: Array) -> Array:
    """μ - ln(1 + μ) without cancellation."""
    small, series = np.where(np.abs(mu) < _NEAR, mu, 0.0), np.zeros(np.shape(mu))
    for power in range(_TERMS, 1, -1):
        series = series * small + (-1.0) ** power / power
    return np.where(np.abs(mu) < _NEAR, series * small * small, mu - np.log1p(mu))
