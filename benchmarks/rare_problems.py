"""Problems with rare acceptance whose answers are known, for rare_acceptance.py: points are independent normals."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import integrate, optimize
from scipy.special import ndtr, ndtri

__all__ = ["PROBLEMS", "RANKS", "STATISTICS", "RareProblem"]

Floats = NDArray[np.float64]

STATISTICS = ("acceptance", "mean", "SD", "median", "24.5 %", "75.5 %")
RANKS = (0.5, 0.245, 0.755)


@dataclass(frozen=True, slots=True)
class RareProblem:
    """A filter and a forecast.

    Attributes:
        words: what it is.
        dimensions: d.
        distance: (n, d) -> (n,), 0 where accepted.
        forecast: (n, d) -> (n,).
        truth: by STATISTICS.
    """

    words: str
    dimensions: int
    distance: Callable[[Floats], Floats]
    forecast: Callable[[Floats], Floats]
    truth: tuple[float, ...]


def density(x: float) -> float:
    """Of the standard normal."""
    return math.exp(-0.5 * x * x) / math.sqrt(2.0 * math.pi)


def tail_moments(start: float) -> tuple[float, float]:
    """The mean and the mean square of a standard normal above `start`."""
    mean = density(start) / float(ndtr(-start))
    return mean, 1.0 + start * mean


def above(start: float, slope: float, rest: float) -> Callable[[float], float]:
    """P(slope·t + rest·e ≤ x, t > start), t and e independent standard normals."""

    def probability(x: float) -> float:
        def integrand(t: float) -> float:
            return density(t) * float(ndtr((x - slope * t) / rest))

        return float(integrate.quad(integrand, start, start + 12.0, epsabs=0.0, epsrel=1e-10, limit=200)[0])

    return probability


def ranks(probability: Callable[[float], float], total: float) -> list[float]:
    """The points below which RANKS of the probability lie."""
    return [optimize.brentq(lambda x, r=rank: probability(x) / total - r, -12.0, 12.0, xtol=1e-10) for rank in RANKS]


def correlated(chance: float, count: int = 6, correlation: float = 0.5) -> RareProblem:
    """The mean of equally correlated normals is far out; the forecast is one of them."""
    mix = np.linalg.cholesky(np.full((count, count), correlation) + (1.0 - correlation) * np.eye(count))
    slope = math.sqrt((1.0 + (count - 1) * correlation) / count)
    start, rest = -float(ndtri(chance)), math.sqrt(1.0 - slope * slope)

    def distance(z: Floats) -> Floats:
        return np.maximum(0.0, start - (z @ mix.T).mean(axis=1) / slope)

    first, second = tail_moments(start)
    spread = math.sqrt(slope**2 * (second - first**2) + rest**2)
    truth = (chance, slope * first, spread, *ranks(above(start, slope, rest), chance))
    return RareProblem(f"the mean of {count} correlated normals", count, distance, lambda z: z @ mix[0], truth)


def two_tails(chance: float, share: float = 0.8) -> RareProblem:
    """One normal of three is far out on either side, with unequal chances; the forecast adds half of another."""
    right, left = -float(ndtri(share * chance)), -float(ndtri((1.0 - share) * chance))

    def distance(z: Floats) -> Floats:
        return np.maximum(0.0, np.minimum(right - z[:, 0], left + z[:, 0]))

    upper, lower = above(right, 1.0, 0.5), above(left, -1.0, 0.5)
    (first, second), (other, square) = tail_moments(right), tail_moments(left)
    mean = share * first - (1.0 - share) * other
    spread = math.sqrt(share * second + (1.0 - share) * square + 0.25 - mean**2)
    truth = (chance, mean, spread, *ranks(lambda x: upper(x) + lower(x), chance))
    return RareProblem("two unequal tails of 1 in 3 normals", 3, distance, lambda z: z[:, 0] + 0.5 * z[:, 1], truth)


def corner(chance: float, narrowed: int = 4, count: int = 8) -> RareProblem:
    """Some of the uniforms are near 1; the forecast adds one of these, stretched to [0, 1], and a free one."""
    width = chance ** (1.0 / narrowed)

    def distance(z: Floats) -> Floats:
        return np.maximum(0.0, 1.0 - width - ndtr(z[:, :narrowed])).max(axis=1)

    def forecast(z: Floats) -> Floats:
        return (width - ndtr(-z[:, 0])) / width + ndtr(z[:, narrowed])

    truth = (chance, 1.0, math.sqrt(1.0 / 6.0), 1.0, math.sqrt(2 * RANKS[1]), 2.0 - math.sqrt(2 * (1.0 - RANKS[2])))
    return RareProblem(f"{narrowed} of {count} uniforms in a corner", count, distance, forecast, truth)


PROBLEMS = {"correlated": correlated(1e-4), "two tails": two_tails(1e-6), "corner": corner(1e-7)}
