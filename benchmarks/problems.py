"""Problems of three uniforms with known answers, for interval_coverage.py: mean, spread, ranks after a filter."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy import optimize, stats
from scipy.special import ndtri

__all__ = ["PROBLEMS", "STATISTICS", "Problem"]

Floats = NDArray[np.float64]
Bounds = Callable[[Floats, Floats], tuple[Floats, Floats]]

STATISTICS = ("mean", "SD", "median", "24.5 %", "75.5 %")
RANKS = (0.5, 0.245, 0.755)

GRID = 1_200
"""Midpoints along each of two axes; the third is integrated exactly."""


class Problem(Protocol):
    """A forecast and a filter.

    Attributes:
        trials: of a run.
    """

    trials: int

    def forecast(self, u: Floats) -> Floats:
        """(3, n) uniforms -> (n,) values."""

    def keeps(self, u: Floats) -> NDArray[np.bool_]:
        """(3, n) uniforms -> (n,) whether a trial is accepted."""

    def truth(self) -> Floats:
        """(5,) by STATISTICS."""


@dataclass(frozen=True)
class Normals:
    """3x + 2y + z of standard normals, kept where it is above its standard deviation times `above`."""

    trials: int
    above: float = -np.inf

    def forecast(self, u: Floats) -> Floats:
        z = ndtri(np.maximum(u, 2.0**-54))
        return np.asarray(3.0 * z[0] + 2.0 * z[1] + z[2])

    def keeps(self, u: Floats) -> NDArray[np.bool_]:
        return np.asarray(self.forecast(u) > self.above * np.sqrt(14.0))

    def truth(self) -> Floats:
        left = stats.truncnorm(self.above, np.inf, scale=np.sqrt(14.0))
        return np.array([left.mean(), left.std(), *left.ppf(RANKS)])


@dataclass(frozen=True, eq=False)
class Skid:
    """A speed from skid marks, √(2 g µ d), m/s: µ from 0.4 to 0.8, d from 20 to 40 m, and a factor from 0.9 to 1.1.

    Kept where the first uniform lies between two functions of the others, as a filter on another quantity would have
    it.
    """

    trials: int
    bounds: Bounds = lambda v, w: (np.zeros_like(v), np.ones_like(v))

    def forecast(self, u: Floats) -> Floats:
        return np.asarray(_factor(u[1], u[2]) * np.sqrt(0.4 + 0.4 * u[0]))

    def keeps(self, u: Floats) -> NDArray[np.bool_]:
        low, high = self.bounds(u[1], u[2])
        return np.asarray((low <= u[0]) & (u[0] < high))

    def truth(self) -> Floats:
        return _skid_truth(self)


def _factor(v: Floats, w: Floats) -> Floats:
    return np.asarray(np.sqrt(2.0 * 9.81 * (20.0 + 20.0 * v)) * (0.9 + 0.2 * w))


@cache
def _skid_truth(problem: Skid) -> Floats:
    """Over the first uniform in closed form, over the others by midpoints."""
    middles = (np.arange(GRID) + 0.5) / GRID
    v, w = (each.ravel() for each in np.meshgrid(middles, middles))
    low, high = (each.clip(0.0, 1.0) for each in problem.bounds(v, w))
    high = np.maximum(low, high)
    factor, total = _factor(v, w), float(np.sum(high - low))

    def power(u: Floats, exponent: float) -> Floats:
        return np.asarray((0.4 + 0.4 * u) ** (exponent + 1.0) / (0.4 * (exponent + 1.0)))

    mean = float(np.sum(factor * (power(high, 0.5) - power(low, 0.5)))) / total
    square = float(np.sum(factor**2 * (power(high, 1.0) - power(low, 1.0)))) / total

    def below(speed: float) -> float:
        return float(np.sum(((speed / factor) ** 2 / 0.4 - 1.0).clip(low, high) - low)) / total

    ranks = [optimize.brentq(lambda speed, p=p: below(speed) - p, 5.0, 30.0, xtol=1e-9) for p in RANKS]
    return np.array([mean, np.sqrt(square - mean**2), *ranks])


PROBLEMS: dict[str, Problem] = {
    "sum of normals": Normals(16_384),
    "sum of normals, 16 % kept": Normals(16_384, above=1.0),
    "speed": Skid(8_192),
    "speed, 33 % kept": Skid(16_384, lambda v, w: (0.6 * v * w, 0.6 * v * w + 0.33)),
    "speed, 3 % kept": Skid(8_192, lambda v, w: (v * (1.0 - w) + 0.1, v * (1.0 - w) + 0.13)),
}
