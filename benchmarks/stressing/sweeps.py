"""The sweeps: evidence that comes ever nearer to where a form fails, each made by a crash that could happen."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

import numpy as np

from stressing.exact import forward
from stressing.forms import INPUTS

__all__ = ["SWEEPS", "Point", "Sweep", "in_order", "random_crashes"]


class Point(NamedTuple):
    """Evidence at one place of a sweep.

    Attributes:
        x: how near it is.
        evidence: by the names of `forms.INPUTS`.
    """

    x: float
    evidence: dict[str, float]


class Sweep(NamedTuple):
    """A way towards trouble.

    Attributes:
        axis: what `Point.x` is, with its unit.
        places: from harmless to worst.
        crash: a place -> the evidence there.
    """

    title: str
    axis: str
    places: tuple[float, ...]
    crash: Callable[[float], Mapping[str, float]]

    def points(self) -> list[Point]:
        """Evidence at each place."""
        return [Point(x, in_order(self.crash(x))) for x in self.places]


MASSES: Final = (1650.0, 1210.0)
REST: Final = {"I_1": 2900.0, "I_2": 1750.0, "a_1": 1.9, "b_1": 0.45, "a_2": -0.35, "b_2": 1.1, "gamma_t": 101.0}
"""kg·m² and m: what does not depend on the place."""


def in_order(evidence: Mapping[str, float]) -> dict[str, float]:
    """In the order of `INPUTS`."""
    return {name: float(evidence[name]) for name in INPUTS}


def _direction(degrees: float) -> tuple[float, float]:
    return math.cos(math.radians(degrees)), math.sin(math.radians(degrees))


def _closing(alphas: tuple[float, float], speeds: tuple[float, float]) -> tuple[float, float]:
    u, v = _direction(alphas[0]), _direction(alphas[1])
    return speeds[0] * u[0] - speeds[1] * v[0], speeds[0] * u[1] - speeds[1] * v[1]


def _central(alphas: tuple[float, float], speeds: tuple[float, float], part: float = 1.1) -> dict[str, float]:
    """A blow against the closing velocity; `part` of the impulse that makes the velocities equal."""
    reduced = MASSES[0] * MASSES[1] / sum(MASSES)
    impulse = tuple(-part * reduced * v for v in _closing(alphas, speeds))
    return forward(alphas, speeds, MASSES, impulse) | REST


def _catching_up(delta: float) -> dict[str, float]:
    return _central((197.0 + delta, 197.0), (24.0, 9.0))


def _side_by_side(delta: float) -> dict[str, float]:
    """A sideswipe: the blow is across the approaches, whatever the angle between them."""
    u = _direction(197.0)
    impulse = (-600.0 * u[0] - 2500.0 * -u[1], -600.0 * u[1] - 2500.0 * u[0])
    return forward((197.0 + delta, 197.0), (24.0, 15.0), MASSES, impulse) | REST


def _head_on(gap: float) -> dict[str, float]:
    return _central((188.0, 8.0 + gap), (20.0, 14.0))


def _across(quarter: float) -> Callable[[float], dict[str, float]]:
    return lambda away: _central((quarter - 82.0, quarter + away), (18.0, 11.0))


def _light(part: float) -> dict[str, float]:
    """Hardly a touch: delta-V is this part of the speed."""
    return _central((191.0, 262.0), (20.0, 12.0), part * 20.0 * sum(MASSES) / MASSES[1] / 19.4)


def _glide(away: float) -> dict[str, float]:
    """The tangent so far from square to the sliding velocity, where (10) divides by 0; vehicles that do not turn."""
    alphas, speeds = (187.0, 281.0), (15.0, 6.0)
    x, y = _closing(alphas, speeds)
    return _central(alphas, speeds, 1.2) | {"gamma_t": math.degrees(math.atan2(y, x)) + 90.0 + away}


def _decades(first: float, last: float, each: int) -> tuple[float, ...]:
    count = round(abs(math.log10(last / first)) * each) + 1
    return tuple(float(x) for x in np.geomspace(first, last, count))


_APPROACHES: Final = "angle between the approaches δ, degrees"

SWEEPS: Final = {
    "catching up": Sweep("One vehicle catches the other up", _APPROACHES, _decades(90, 1e-8, 3), _catching_up),
    "sideswipe": Sweep("A sideswipe", _APPROACHES, _decades(90, 1e-8, 3), _side_by_side),
    "head-on": Sweep("Head-on", "180° less δ, degrees", _decades(90, 1e-8, 3), _head_on),
    "through 90": Sweep("α2 near 90°", "α2 less 90°, degrees", (*_decades(30, 1e-12, 2), 0.0), _across(90.0)),
    "through 270": Sweep("α2 near 270°", "α2 less 270°, degrees", (*_decades(30, 1e-12, 2), 0.0), _across(270.0)),
    "light": Sweep("A light touch", "delta-V over speed, vehicle 1", _decades(0.5, 1e-6, 4), _light),
    "pole": Sweep("e_t near its pole", "tangent, from square to the sliding, degrees", _decades(30, 1e-8, 3), _glide),
}


def random_crashes(count: int, seed: int) -> list[Point]:
    """Crashes of all kinds: δ at least 10° from 0 and 180, as the templates' check asks."""
    rng = np.random.default_rng(seed)
    points = []
    while len(points) < count:
        alphas = tuple(rng.uniform(0.0, 360.0, 2).tolist())
        if abs(math.sin(math.radians(alphas[0] - alphas[1]))) < math.sin(math.radians(10.0)):
            continue
        evidence = _central(alphas, tuple(rng.uniform(3.0, 35.0, 2).tolist()), rng.uniform(0.3, 1.9))
        evidence |= {"gamma_t": rng.uniform(0.0, 180.0), "a_1": rng.uniform(-2.0, 2.0), "b_2": rng.uniform(-2.0, 2.0)}
        points.append(Point(float(len(points)), in_order(evidence)))
    return points
