"""Forecasts with and without tails whose answers are known, for tail_coverage.py: functions of two uniforms."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import integrate, optimize, special, stats
from scipy.special import ndtr, ndtri

__all__ = ["ORDINARY", "PROBLEMS", "RANKS", "STATISTICS", "Problem"]

Floats = NDArray[np.float64]

RANKS = (0.1, 0.5, 0.9)
STATISTICS = ("mean", "SD", "10 %", "50 %", "90 %", "share")

ORDINARY = ("normal", "uniform", "bimodal", "kink")
"""Those of which nothing should be told, and whose intervals should be short, from 10,000 trials on."""


def _all(u: Floats) -> NDArray[np.bool_]:
    return np.full(u.shape[1], True)


@dataclass(frozen=True)
class Problem:
    """A forecast, its distribution, and what is asked of it.

    Attributes:
        forecast: (2, n) uniforms -> (n,) values.
        cdf: P(forecast ≤ x) of the accepted ones.
        mean, deviation: of them.
        above: the share of forecasts above this is asked for.
        keeps: (2, n) uniforms -> (n,) which are accepted.
        support: between which numbers the percentiles lie.
    """

    forecast: Callable[[Floats], Floats]
    cdf: Callable[[float], float]
    mean: float
    deviation: float
    above: float
    keeps: Callable[[Floats], NDArray[np.bool_]] = field(default=_all)
    support: tuple[float, float] = (-20.0, 400.0)

    @cached_property
    def truth(self) -> Floats:
        """(6,) by STATISTICS."""
        ranks = [self._quantile(p) for p in RANKS]
        return np.array([self.mean, self.deviation, *ranks, 1.0 - self.cdf(self.above)])

    def _quantile(self, p: float) -> float:
        """The least x with P(forecast ≤ x) ≥ p, within the support."""
        low, high = self.support
        if self.cdf(low) >= p or self.cdf(high) < p:
            return low if self.cdf(low) >= p else high
        result = optimize.bisect(lambda x: -1.0 if self.cdf(x) < p else 1.0, low, high, xtol=1e-12)
        return float(np.round(result)) if abs(result - np.round(result)) < 1e-9 else float(result)


def _lognormal(sigma: float) -> Problem:
    there = stats.lognorm(sigma)
    return Problem(lambda u: np.exp(sigma * ndtri(u[0])), there.cdf, there.mean(), there.std(), 1.3)


def _of(there: Any, above: float) -> Problem:
    """A forecast that one uniform decides, with a power tail."""
    support = float(there.ppf(1e-9)) - 1.0, float(there.isf(1e-9))
    return Problem(lambda u: there.ppf(u[0]), there.cdf, there.mean(), there.std(), above, support=support)


def _gumbel_and_uniform() -> Problem:
    middles = 2.0 * (np.arange(4_000) + 0.5) / 4_000
    deviation = np.sqrt(np.pi**2 / 6.0 + 4.0 / 12.0)
    return Problem(
        lambda u: -np.log(-np.log(u[0])) + 2.0 * u[1],
        lambda x: float(np.mean(np.exp(-np.exp(-(x - middles))))),
        float(np.euler_gamma) + 1.0,
        float(deviation),
        2.2,
    )


def _two_normals(x: Floats) -> Floats:
    return np.asarray(0.4 * ndtr(x) + 0.6 * ndtr(x - 5.0))


def _bimodal(forecast: Callable[[Floats], Floats]) -> Problem:
    """Two normals 5 standard deviations apart."""
    return Problem(forecast, lambda x: float(_two_normals(np.array(x))), 3.0, float(np.sqrt(1.0 + 25.0 * 0.24)), 4.7)


@cache
def _table() -> tuple[Floats, Floats]:
    """Values of the two normals, and where they stand."""
    x = np.linspace(-9.0, 14.0, 200_001)
    return x, _two_normals(x)


def _of_one_input(u: Floats) -> Floats:
    x, below = _table()
    return np.asarray(np.interp(u[0], below, x))


def _switched(u: Floats) -> Floats:
    return np.asarray(ndtri(u[0]) + np.where(u[1] < 0.4, 0.0, 5.0))


def _kink() -> Problem:
    mean = 1.0 / np.sqrt(2.0 * np.pi)
    return Problem(
        lambda u: np.maximum(ndtri(u[0]), 0.0),
        lambda x: float(ndtr(x)) if x >= 0.0 else 0.0,
        float(mean),
        float(np.sqrt(0.5 - mean**2)),
        0.7,
    )


def _discrete() -> Problem:
    """Poisson with a mean of 3.5."""
    there = stats.poisson(3.5)
    steps = there.cdf(np.arange(60))
    return Problem(
        lambda u: np.searchsorted(steps, u[0], side="right").astype(np.float64), there.cdf, 3.5, np.sqrt(3.5), 4.0
    )


def _filtered() -> Problem:
    """A lognormal forecast, exp(z / 2), kept where z and another normal add up to more than 0.5: 36 %."""

    def moment(power: int, upto: float = np.inf) -> float:
        def density(z: float) -> float:
            normal = math.exp(0.5 * z * (power - z)) / math.sqrt(2.0 * math.pi)
            return normal * 0.5 * math.erfc((0.5 - z) / math.sqrt(2.0))

        return float(integrate.quad(density, -10.0, min(upto, 12.0), epsabs=1e-13, limit=400)[0])

    kept = moment(0)
    mean = moment(1) / kept
    return Problem(
        lambda u: np.exp(0.5 * ndtri(u[0])),
        lambda x: moment(0, 2.0 * np.log(x)) / kept if x > 0.0 else 0.0,
        mean,
        float(np.sqrt(moment(2) / kept - mean**2)),
        1.8,
        lambda u: ndtri(u[0]) + ndtri(u[1]) > 0.5,
        (0.01, 50.0),
    )


def _yes_or_no(x: float) -> float:
    return 0.0 if x < 0.0 else 0.693 if x < 1.0 else 1.0


PROBLEMS: dict[str, Problem] = {
    "normal": Problem(lambda u: ndtri(u[0]), lambda x: float(ndtr(x)), 0.0, 1.0, 0.4),
    "uniform": Problem(lambda u: u[0], lambda x: float(np.clip(x, 0.0, 1.0)), 0.5, 12.0**-0.5, 0.64),
    "bimodal": _bimodal(_of_one_input),
    "kink": _kink(),
    "lognormal, σ .5": _lognormal(0.5),
    "lognormal, σ 1": _lognormal(1.0),
    "lognormal, σ 1.5": _lognormal(1.5),
    "lognormal, σ 2": _lognormal(2.0),
    "Student, 3 degrees": _of(stats.t(3), 0.8),
    "Pareto, 3": _of(stats.pareto(3), 1.4),
    "exponential": Problem(lambda u: -np.log1p(-u[0]), lambda x: float(-special.expm1(-max(x, 0.0))), 1.0, 1.0, 1.1),
    "Gumbel + uniform": _gumbel_and_uniform(),
    "switch": _bimodal(_switched),
    "discrete": _discrete(),
    "yes or no": Problem(lambda u: (u[0] < 0.307).astype(np.float64), _yes_or_no, 0.307, (0.307 * 0.693) ** 0.5, 0.5),
    "filtered": _filtered(),
}
