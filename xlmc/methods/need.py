"""How many trials, and how many seconds, a method needs for an accuracy: its measured errors, carried on."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.methods.answer import STATISTICS
from xlmc.methods.curve import Curve, Rung
from xlmc.methods.rms import line
from xlmc.methods.sampled import MONTE_CARLO, Sampled
from xlmc.methods.study import Study

__all__ = ["NORMAL_95", "Need", "Shortfall", "need", "shortfall", "worst"]

NORMAL_95: Final = 1.959964
"""95 of 100 runs lie within so many root mean square errors."""

_LEAST_PART: Final = 0.25
_LEAST_SLOPE: Final = -0.05
"""Errors that fall more slowly with the trials are not carried on."""

_SHORTEST: Final = 1 / 16
"""Of the shortest measured runs: errors are not carried on to runs that are shorter still."""


@dataclass(frozen=True, slots=True)
class Need:
    """What a method needs.

    Attributes:
        trials: about; infinite where more of them would not do.
        seconds: likewise.
        forecast, statistic: whose accuracy needs the most.
        beyond: how many times as many trials as the longest measured runs had; below 1 where it is between them.
    """

    trials: float
    seconds: float
    forecast: str
    statistic: str
    beyond: float


@dataclass(frozen=True, slots=True)
class Shortfall:
    """The number that an answer given once misses by the most.

    Attributes:
        error: in the forecast's units.
        times: the error over what was asked for; infinite where the method gives no number.
    """

    forecast: str
    statistic: str
    error: float
    times: float


def need(study: Study, curve: Curve) -> Need:
    """What a method that draws needs, for 95 of 100 runs to keep the accuracy in every number of every forecast.

    All its errors are taken to fall with the trials as their mean does in logarithms: the single ones are too few to
    have slopes of their own. Of independent trials theory knows the slope, and a few runs would only guess at it.
    """
    budgets = [float(rung.budget) for rung in curve.rungs]
    varying = [(forecast, statistic) for forecast in study.varying for statistic in STATISTICS]
    kinds = [kind for kind in varying if study.converges(*kind)]
    logs = np.array([[_log(rung.errors[kind].value) for kind in kinds] for rung in curve.rungs])
    levels = [float(np.exp(np.mean(row[np.isfinite(row)]))) if np.isfinite(row).any() else np.nan for row in logs]
    independent = isinstance(curve.method, Sampled) and curve.method.method == MONTE_CARLO.method
    slope = -0.5 if independent else line(budgets, levels)[0]
    worst = Need(0.0, 0.0, "", "mean", 0.0)
    for place, kind in enumerate(kinds):
        tolerance = study.tolerance(*kind) / NORMAL_95
        trials = _trials(budgets, logs[:, place], slope, tolerance)
        last = curve.rungs[-1].errors[kind]
        if last.biased and abs(last.bias) * NORMAL_95 > study.tolerance(*kind):
            trials = np.inf
        if trials > worst.trials:
            worst = Need(trials, seconds_of(curve, trials), *kind, trials / budgets[-1])
    return worst


def shortfall(study: Study, curve: Curve) -> Shortfall:
    """Which number of an answer that was given once is worst; of those that are not good enough, a mean comes first."""
    found = [*_shortfalls(study, curve)]
    means = [each for each in found if each.statistic == "mean" and each.times > 1.0]
    return max(means or found, key=lambda each: each.times)


def _shortfalls(study: Study, curve: Curve) -> Iterator[Shortfall]:
    for (forecast, statistic), error in curve.rungs[-1].errors.items():
        if not study.converges(forecast, statistic):
            continue
        tolerance = study.tolerance(forecast, statistic)
        known = np.isfinite(error.value)
        times = error.value / tolerance if known and tolerance > 0.0 else np.inf
        yield Shortfall(forecast, statistic, error.value, float(times))


def worst(study: Study, curve: Curve, rung: Rung) -> float:
    """The largest error of a run length over the one asked for, in 95 of 100 runs; infinite where a number is missing.

    Infinite too where a relative accuracy is asked of a number that is zero.
    """
    wide = 1.0 if curve in study.once else NORMAL_95
    found = 0.0
    for kind, error in rung.errors.items():
        if not study.converges(*kind):
            continue
        tolerance = study.tolerance(*kind)
        known = tolerance > 0.0 and np.isfinite(error.value)
        found = max(found, wide * error.value / tolerance if known else np.inf)
    return found


def seconds_of(curve: Curve, trials: float) -> float:
    """A run of so many trials: a fixed part and one for each, as the two longest measured runs have them.

    What a trial costs is not taken for less than a quarter of the longest run's average: runs that are shorter than a
    block of trials all take the same time, and say nothing of it.
    """
    if not np.isfinite(trials):
        return np.inf
    timed = [rung for rung in curve.rungs if np.isfinite(rung.seconds)]
    budgets = np.array([float(rung.budget) for rung in timed])
    seconds = np.array([rung.seconds for rung in timed])
    if not timed:
        return np.inf
    if budgets.size < 2:
        return float(seconds[0] * trials / budgets[0])
    least = _LEAST_PART * float(seconds[-1] / budgets[-1])
    each = max(float((seconds[-1] - seconds[-2]) / (budgets[-1] - budgets[-2])), least)
    return max(float(seconds[-1]) - each * float(budgets[-1]), 0.0) + each * trials


def _trials(budgets: list[float], logs: NDArray[np.float64], slope: float, tolerance: float) -> float:
    """Where the line of this slope through these logarithms comes down to the tolerance.

    The shortest runs do where none was off at all, as those of whole numbers; and nothing is carried on to runs that
    are much shorter than they.
    """
    least = _SHORTEST * budgets[0]
    known = np.isfinite(logs)
    if tolerance <= 0.0 or np.isnan(logs[-1]):
        return np.inf
    if not known.any():
        return budgets[0]
    if not slope < _LEAST_SLOPE:
        return budgets[-1] if np.exp(logs[known][-1]) <= tolerance else np.inf
    height = float(np.mean(logs[known] - slope * np.log(np.array(budgets)[known])))
    return max(float(np.exp((np.log(tolerance) - height) / slope)), least)


def _log(value: float) -> float:
    """Of an error: of none at all minus infinity, of one that is not known NaN."""
    return float(np.log(value)) if value > 0.0 else (-np.inf if value == 0.0 else np.nan)
