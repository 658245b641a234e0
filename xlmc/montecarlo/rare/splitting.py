"""Send populations to the accepted region level by level (subset simulation, or splitting).

Kahn & Harris 1951; Au & Beck 2001; as a sequential Monte Carlo method Cérou, Del Moral, Furon & Guyader 2012. Of a
population spread as the assumptions are, the points nearest to acceptance are kept; copies of them, moved at random
without leaving their level, fill the population up again; until the level is acceptance. The product of the shares
that were kept estimates the probability of acceptance.

**Moves** leave the standard normal distribution as it is within the level. They alternate between steps from the
point towards 0 and on (preconditioned Crank-Nicolson: Neal 1998; Papaioannou, Betz, Zwirglmaier & Straub 2015), and
steps of the same kind about the mean of the population with its covariance, of which some are refused to make that
exact (Pinski, Simpson, Stuart & Weber 2015): where the region is a thin layer, these go far along it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["EXPLORING", "Descent", "Distance", "descend", "explore"]

Floats = NDArray[np.float64]

Distance = Callable[[Floats], Floats]
"""Takes (n, d) points of independent standard normals, gives (n,): 0 where accepted, else above it the more the
farther away, infinite where that cannot be said."""

_KEPT: Final = 0.2
_SWEEPS: Final = 8
_LAST_SWEEPS: Final = 8
_SNAPSHOTS: Final = 4
"""Copies of the population in the region, each some moves after the one before: more points to fit a proposal to."""

_LEAST: Final = 16
"""Points below a level from which a population is made again, where more of them stand level."""

_LEVEL: Final = 0.9
"""A share of points that are no farther than a level: with more of them, it tells none apart."""

_TRIES: Final = 4
"""Times that a population is moved on without coming nearer, before it counts as stuck."""

_LEAST_LOG: Final = math.log(1e-15)
"""The search ends if the probability of acceptance is below this."""

_WANTED_RATE: Final = 0.3

_EXPLORERS: Final = 1_024
"""A population that begins within the region."""

_FIRST_STEP: Final = 0.3
"""The size of the steps, at first."""

EXPLORING: Final = _EXPLORERS * _SWEEPS * (_SNAPSHOTS + 1)
"""Distances that it asks for, at most."""


@dataclass(frozen=True, slots=True, eq=False)
class Descent:
    """How a population came to the accepted region.

    Attributes:
        points: (n, d), spread about as accepted trials are; where the region was not reached, as far as they came.
        reached: whether they are accepted.
        log_probability: of the level they stand at, about.
        levels: distances that were gone through.
        evaluations: points whose distance was asked for.
        nearest: (d,) the point that came nearest.
        explored: whether it began at accepted points that were known, and how likely these are with it.
    """

    points: Floats
    reached: bool
    log_probability: float
    levels: tuple[float, ...]
    evaluations: int
    nearest: Floats
    explored: bool = False


def descend(
    distance: Distance, dimensions: int, random: np.random.Generator, *, population: int = 4096, first: int = 65_536
) -> Descent:
    """Send a population of `population` points on its way, the best of `first` draws of the assumptions."""
    points = random.standard_normal((first, dimensions))
    values = distance(points)
    evaluations, logs, levels, stuck = first, 0.0, [math.inf], 0
    steps = _Steps()
    while levels[-1] > 0.0 and stuck < _TRIES and logs > _LEAST_LOG:
        level = _next_level(values, int(population * _KEPT), levels[-1])
        stuck = 0 if level is not None else stuck + 1
        if level is not None:
            logs += math.log(float(np.mean(values <= level)))
            levels.append(level)
        inside = random.permutation(np.flatnonzero(values <= levels[-1]))
        if not inside.size:
            break
        chosen = np.resize(inside, population)
        points, values, asked = _moved(points[chosen], values[chosen], levels[-1], distance, steps, _SWEEPS, random)
        evaluations += asked
    nearest, reached, taken = points[int(np.argmin(values))], levels[-1] == 0.0, [points]
    while reached and len(taken) < _SNAPSHOTS:
        points, values, asked = _moved(points, values, 0.0, distance, steps, _LAST_SWEEPS, random)
        evaluations += asked
        taken.append(points)
    return Descent(np.concatenate(taken), reached, logs, tuple(levels[1:]), evaluations, nearest)


def explore(
    distance: Distance,
    seeds: Floats,
    shares: Floats,
    log_mass: float,
    random: np.random.Generator,
) -> Descent:
    """Spread a population about accepted points, without leaving the region.

    Args:
        distance: 0 in the region.
        seeds: (k, d) accepted points.
        shares: (k,) of the population, from each; they sum to 1.
        log_mass: logarithm of the probability that the points stand for.
        random: to move with.
    """
    points = seeds[random.choice(len(seeds), _EXPLORERS, p=shares)]
    values, steps, asked, taken = np.zeros(_EXPLORERS), _Steps(_FIRST_STEP, _FIRST_STEP), 0, list[Floats]()
    for turn in range(_SNAPSHOTS + 1):
        moved = _moved(points, values, 0.0, distance, steps, _SWEEPS, random, alone=not turn)
        points, asked, taken = moved[0], asked + moved[2], [*taken, moved[0]]
    return Descent(np.concatenate(taken[1:]), True, log_mass, (0.0,), asked, points[0], explored=True)


def _next_level(values: Floats, wanted: int, before: float) -> float | None:
    """Return the next lower level; None if hardly a point lies below the last one.

    Where most points stand level, as where a filter says no more than no, the few below them are taken.
    """
    level = float(np.partition(values, wanted - 1)[wanted - 1])
    if level < before and np.mean(values <= level) <= _LEVEL:
        return level
    below = values[values < min(level, before)]
    if below.size >= _LEAST:
        return float(below.max())
    return level if level < before else None


@dataclass(slots=True)
class _Steps:
    """The lengths of both kinds of steps, 0 to 1, which follow how many are taken."""

    own: float = 0.7
    common: float = 0.7


def _moved(
    points: Floats,
    values: Floats,
    level: float,
    distance: Distance,
    steps: _Steps,
    sweeps: int,
    random: np.random.Generator,
    *,
    alone: bool = False,
) -> tuple[Floats, Floats, int]:
    """Return the population, its distances, and how many were asked for; `alone` without steps by all points'
    covariance.
    """
    count, dimensions = points.shape
    common = None
    asked = 0
    for sweep in range(sweeps):
        noise = random.standard_normal(points.shape)
        if sweep % 2 and not alone and dimensions * 20 <= count:
            common = common or _Common.of(points)
            step = _lengths(steps.common, count, random)
            offered = common.offered(points, noise, step)
            allowed = np.log(random.random(count)) < common.log_ratio(offered) - common.log_ratio(points)
        else:
            step = _lengths(steps.own, count, random)
            offered = np.sqrt(1.0 - step**2) * points + step * noise
            allowed = np.ones(count, bool)
        there = np.full(count, np.inf)
        there[allowed] = distance(offered[allowed])
        asked += int(np.count_nonzero(allowed))
        taken = there <= level
        points, values = np.where(taken[:, None], offered, points), np.where(taken, there, values)
        factor = math.exp(float(np.mean(taken)) - _WANTED_RATE)
        if sweep % 2 and common is not None:
            steps.common = min(1.0, max(1e-3, steps.common * factor))
        else:
            steps.own = min(1.0, max(1e-3, steps.own * factor))
    return points, values, asked


def _lengths(usual: float, count: int, random: np.random.Generator) -> Floats:
    """(count, 1) about the usual length: some points need shorter steps than others."""
    return np.minimum(1.0, usual * np.exp(0.7 * random.standard_normal((count, 1))))


@dataclass(frozen=True, slots=True, eq=False)
class _Common:
    """The normal distribution with the population's mean (d,) and covariance."""

    mean: Floats
    root: Floats
    inverse: Floats

    @classmethod
    def of(cls, points: Floats) -> _Common:
        mean = points.mean(axis=0)
        covariance = np.cov(points, rowvar=False).reshape(points.shape[1], points.shape[1])
        root = np.linalg.cholesky(covariance + 1e-9 * np.eye(len(covariance)))
        return cls(np.round(mean, 9), np.round(root, 9), np.linalg.inv(root))

    def offered(self, points: Floats, noise: Floats, step: Floats) -> Floats:
        moved = np.einsum("nd,ed->ne", noise, self.root)
        return np.asarray(self.mean + np.sqrt(1.0 - step**2) * (points - self.mean) + step * moved)

    def log_ratio(self, points: Floats) -> Floats:
        """(n,) the logarithm of the standard normal density over this one's, but for a constant."""
        apart = np.einsum("nd,ed->ne", points - self.mean, self.inverse)
        return np.asarray(0.5 * (np.square(apart).sum(axis=1) - np.square(points).sum(axis=1)))
