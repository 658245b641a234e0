"""Johnson by moments: the member of Johnson's system that has a mean, a deviation, a skewness and a kurtosis."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Member, Values
from xlmc.montecarlo.distributions.johnson_sb import JohnsonSB, share_moments
from xlmc.montecarlo.distributions.johnson_su import JohnsonSU
from xlmc.montecarlo.distributions.lognormal import Lognorm2
from xlmc.montecarlo.distributions.normal import Normal
from xlmc.montecarlo.distributions.parameters import MEAN, STD_DEV, Constraint, Fault, ParameterSpec, above_zero, show

__all__ = ["JohnsonMoments"]

_NORMAL, _LOGNORMAL, _BOUNDED, _UNBOUNDED = Normal(), Lognorm2(), JohnsonSB(), JohnsonSU()
_ON_THE_LINE = 1e-6
"""A kurtosis this near to the lognormal's, as a share, is the lognormal's."""

_MET = 1e-9
_STARTS = tuple((first, second) for second in (1.0, 0.5, 2.0, 0.25, 5.0) for first in (0.5, 0.1, 1.5, 3.0))


class JohnsonMoments(Family):
    """Johnson with mean, standard deviation, skewness, and kurtosis, which is 3 for the normal.

    It is normal, lognormal, Johnson SU above the lognormal's kurtosis, or Johnson SB below it. No distribution has a
    kurtosis of skewness² + 1 or less.

    >>> johnson = JohnsonMoments()
    >>> print(johnson.ppf(np.array([0.1, 0.5, 0.9]), mean=10, std_dev=2, skewness=0.5, kurtosis=5).round(6))
    [ 7.682912  9.881354 12.457657]
    >>> johnson.check(mean=10, std_dev=2, skewness=2, kurtosis=5)
    'Kurtosis (5) must be above 1 + Skewness (2) squared'
    """

    name = "Johnson moments"
    parameters = (
        MEAN,
        STD_DEV,
        ParameterSpec("skewness", ("Skewness",)),
        ParameterSpec("kurtosis", ("Kurtosis",)),
    )
    rules = (
        above_zero(parameters, "std_dev"),
        Constraint(
            "kurtosis",
            lambda _mean, _std_dev, skewness, kurtosis: kurtosis > 1 + np.square(skewness),
            "Kurtosis ({kurtosis}) must be above 1 + Skewness ({skewness}) squared",
            "Correct the wrong one; the kurtosis of a normal is 3",
        ),
    )
    given_by = "moments"
    formula = "normal, lognormal, Johnson SU or Johnson SB, whichever has these moments"
    source = "Johnson, Biometrika 36 (1949), 149–176; SU by Tuenter, J. Statist. Comput. Simul. 70 (2001), 325–347"
    elsewhere = ("@RISK JohnsonMoments(mu, sigma, skewness, kurtosis)",)

    def broken_rule(self, *values: float) -> Fault | None:
        """Return the first rule that these numbers break, or that no member was found."""
        fault = super().broken_rule(*values)
        if fault is None and _member(*map(float, values[2:])) is None:
            message = (
                f"No Johnson distribution with skewness {show(values[2])} and kurtosis {show(values[3])} was found"
            )
            return Fault(
                "kurtosis", message, "Choose a kurtosis farther from the least possible, or another distribution"
            )
        return fault

    def _ppf(self, u: Array, *values: Values) -> Array:
        return self._scaled(lambda member, u: member.ppf(u), u, values)

    def _isf(self, q: Array, *values: Values) -> Array:
        return self._scaled(lambda member, q: member.isf(q), q, values)

    def _cdf(self, x: Values, mean: Values, std_dev: Values, skewness: Values, kurtosis: Values) -> Values:
        z = np.divide(np.subtract(x, mean), std_dev)
        return _by_member(lambda member, z: member.cdf(z), z, skewness, kurtosis)

    def _sf(self, x: Values, mean: Values, std_dev: Values, skewness: Values, kurtosis: Values) -> Values:
        z = np.divide(np.subtract(x, mean), std_dev)
        return _by_member(lambda member, z: member.sf(z), z, skewness, kurtosis)

    def _scaled(self, hook: Callable[[Member, Array], Array], u: Array, values: tuple[Values, ...]) -> Array:
        mean, std_dev, skewness, kurtosis = values
        return np.asarray(mean + std_dev * _by_member(hook, u, skewness, kurtosis))

    def _mean(self, mean: Values, std_dev: Values, skewness: Values, kurtosis: Values) -> Values:
        return mean + 0 * std_dev * np.add(skewness, kurtosis)

    def _variance(self, mean: Values, std_dev: Values, skewness: Values, kurtosis: Values) -> Values:
        return np.square(std_dev) + 0 * mean * np.add(skewness, kurtosis)

    def _support(self, mean: Values, std_dev: Values, skewness: Values, kurtosis: Values) -> tuple[Values, Values]:
        def end(side: int) -> Values:
            z = _by_member(lambda member, z: member.support()[side] + 0 * z, np.zeros(()), skewness, kurtosis)
            return mean + std_dev * z

        return end(0), end(1)


def _by_member(hook: Callable[[Member, Array], Any], at: Values, skewness: Values, kurtosis: Values) -> Array:
    """Evaluate a function of the standardised member; NaN without one."""
    at, skewness, kurtosis = np.broadcast_arrays(*(np.asarray(each, dtype=float) for each in (at, skewness, kurtosis)))
    values = np.full(at.shape, np.nan)
    flat = values.reshape(-1)
    pairs, which = np.unique(np.stack([skewness.ravel(), kurtosis.ravel()]), axis=1, return_inverse=True)
    for i, (skew, kurt) in enumerate(pairs.T.tolist()):
        member = _member(skew, kurt)
        if member is not None:
            own = which.ravel() == i
            flat[own] = hook(member, at.ravel()[own])
    return flat.reshape(at.shape)


@lru_cache(maxsize=256)
def _member(skewness: float, kurtosis: float) -> Member | None:
    """Find the member with mean 0, variance 1 and these moments; None if none is found."""
    if not (math.isfinite(skewness) and math.isfinite(kurtosis) and abs(skewness) < 1e6 and kurtosis < 1e12):
        return None
    if skewness < 0:
        mirrored = _member(-skewness, kurtosis)
        return None if mirrored is None else _mirror(mirrored)
    square = skewness * skewness
    if not kurtosis > 1 + square:
        return None
    omega = _lognormal_omega(square)
    line = omega**4 + 2 * omega**3 + 3 * omega**2 - 3
    if abs(kurtosis - line) <= _ON_THE_LINE * line:
        return Member(_NORMAL, (0.0, 1.0)) if omega - 1 < 1e-9 else _lognormal(omega)
    with np.errstate(all="ignore"):
        return _unbounded(square, kurtosis) if kurtosis > line else _bounded(skewness, kurtosis)


def _mirror(member: Member) -> Member:
    """Return the member of -X."""
    return Member(_Mirrored(member.family), member.values)


class _Mirrored(Family):
    """-X of a family."""

    name = "mirrored"
    parameters = ()

    def __init__(self, of: Family) -> None:
        self.of = of

    def _ppf(self, u: Array, *values: Values) -> Array:
        return -self.of._isf(u, *values)

    def _isf(self, q: Array, *values: Values) -> Array:
        return -self.of._ppf(q, *values)

    def _cdf(self, x: Values, *values: Values) -> Values:
        return self.of._sf(np.negative(x), *values)

    def _sf(self, x: Values, *values: Values) -> Values:
        return self.of._cdf(np.negative(x), *values)

    def _mean(self, *values: Values) -> Values:
        return np.negative(self.of._mean(*values))

    def _variance(self, *values: Values) -> Values:
        return self.of._variance(*values)

    def _support(self, *values: Values) -> tuple[Values, Values]:
        low, high = self.of._support(*values)
        return np.negative(high), np.negative(low)


def _lognormal_omega(square: float) -> float:
    """exp(σ²) of the lognormal with this squared skewness: the root of (ω - 1)(ω + 2)² = skewness²."""
    part = math.log1p(square / 2 + math.sqrt(square + square * square / 4))  # ω + 1/ω… solved with cosh
    return 2 * math.cosh(part / 3) - 1


def _lognormal(omega: float) -> Member:
    """Mean 0 and variance 1."""
    sigma = math.sqrt(math.log(omega))
    median = 1 / math.sqrt(omega * (omega - 1))
    return Member(_LOGNORMAL, (-median * math.sqrt(omega), math.log(median), sigma))


def _unbounded(square: float, kurtosis: float) -> Member | None:
    """Johnson SU with a skewness that is 0 or positive (Tuenter 2001, in ω = exp(1/Shape 2²))."""
    from scipy.optimize import brentq

    def half(omega: float) -> float:
        return -2 + math.sqrt(max(4 + 2 * (omega**2 - (kurtosis + 3) / (omega**2 + 2 * omega + 3)), 0.0))

    def excess(omega: float) -> float:
        m = half(omega)
        return (omega - 1 - m) * (omega + 2 + m / 2) ** 2 - square

    most = math.sqrt(max(-1 + math.sqrt(2 * (kurtosis - 1)), 1.0))
    least = max(_quartic_root(kurtosis), 1.0)
    low, high = min(least, most), max(least, most)
    if excess(low) * excess(high) > 0:
        return None
    omega = brentq(excess, low, high, xtol=1e-15, rtol=1e-15) if square else most
    m = half(omega)
    if not omega > 1:
        return None
    inside = (omega + 1) / (2 * omega) * ((omega - 1) / m - 1) if m > 0 else 0.0
    ratio = -math.asinh(math.sqrt(max(inside, 0.0)))
    second = 1 / math.sqrt(math.log(omega))
    shapes = (ratio * second, second)
    scale = 1 / math.sqrt(float(_UNBOUNDED._variance(0.0, 1.0, *shapes)))
    location = -scale * float(_UNBOUNDED._mean(0.0, 1.0, *shapes))
    return Member(_UNBOUNDED, (location, scale, *shapes))


def _quartic_root(kurtosis: float) -> float:
    """Return the ω of the lognormal with this kurtosis, 3 or more."""
    from scipy.optimize import brentq

    def excess(omega: float) -> float:
        return omega**4 + 2 * omega**3 + 3 * omega**2 - 3 - kurtosis

    return float(brentq(excess, 0.5, 2 + kurtosis**0.25, xtol=1e-15, rtol=1e-15))


def _bounded(skewness: float, kurtosis: float) -> Member | None:
    """Johnson SB with a skewness that is 0 or positive."""
    from scipy.optimize import least_squares

    def misfit(point: Array) -> Array:
        _, variance, third, fourth = (float(each) for each in share_moments(point[0], np.exp(point[1]), 4))
        if not variance > 0:
            return np.array([1e3, 1e3])
        return np.array([third / variance**1.5 - skewness, (fourth / variance**2 - kurtosis) / kurtosis])

    for first, second in _STARTS:
        start = np.array([0.0 if skewness == 0 else first, math.log(second)])
        value = least_squares(misfit, start, method="lm", xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=400)
        if np.all(np.abs(value.fun) < _MET * max(1.0, skewness)):
            shapes = float(value.x[0]), math.exp(float(value.x[1]))
            mean, variance = (float(each) for each in share_moments(*shapes))
            width = 1 / math.sqrt(variance)
            return Member(_BOUNDED, (-mean * width, (1 - mean) * width, *shapes))
    return None
