"""How many trials and seconds each method needs for an accuracy, and which method to choose.

Of a method that gives its answer once, the question is whether that answer is near enough.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final, Literal, TypeVar

import numpy as np

from xlmc.analysis.studies.methods.answer import STATISTICS
from xlmc.analysis.studies.methods.curve import NORMAL_95, Curve, Runs
from xlmc.analysis.studies.methods.law import CONFIDENCE, law
from xlmc.analysis.studies.methods.sampled import MONTE_CARLO
from xlmc.analysis.studies.methods.study import Study

__all__ = [
    "ENGINE_READY",
    "NO_TIME",
    "Choice",
    "Need",
    "Verdict",
    "WorstError",
    "choice",
    "chosen_of",
    "need",
    "reach_of",
    "seconds_of",
    "tied",
    "worst_error",
]

Each = TypeVar("Each")

Verdict = Literal["yes", "no", "unknown"]

_TIE: Final = 1.2
"""Methods whose seconds are within this factor of the least are a tie: clocks and fits tell no more."""

NO_TIME: Final = 0.1
"""A difference of fewer seconds does not matter."""

_NO_MATTER: Final = 1.5
"""A method must be faster by this factor to be chosen instead of Monte Carlo."""

ENGINE_READY: Final = 0.5
"""Seconds that another engine takes to compile a workbook of usual size, or less where it has kept the code."""


@dataclass(frozen=True, slots=True)
class Need:
    """What a method needs.

    Attributes:
        trials: about; infinite where more of them would not do.
        seconds: likewise.
        forecast, statistic: whose accuracy needs the most.
        beyond: how many times as many trials as the longest measured runs had; below 1 where it is between them.
        reaches: whether the method reaches the accuracy at all, as far as the runs can tell.
        error: the standard error of the logarithm of the trials; 0 where theory alone gives them.
        floor: the error that 95 of 100 runs of any length stay within, in tolerances; 0 for a method that converges.
    """

    trials: float
    seconds: float
    forecast: str
    statistic: str
    beyond: float
    reaches: Verdict = "yes"
    floor: float = 0.0
    error: float = 0.0

    @property
    def usable(self) -> bool:
        """Whether it can be recommended."""
        return self.reaches == "yes" and bool(np.isfinite(self.seconds))


@dataclass(frozen=True, slots=True)
class WorstError:
    """The largest error, over its tolerance, of a method that gives its answer once.

    Attributes:
        error: in the forecast's units, with its sign.
        own: the standard error of the reference, likewise.
        times: the error over what was asked for; infinite where the method gives no number.
        reaches: whether it is near enough, as far as the reference can tell.
    """

    forecast: str
    statistic: str
    error: float
    own: float
    times: float
    reaches: Verdict


def _asked_kinds(study: Study) -> list[tuple[str, str]]:
    """Return the statistics that converge: forecast and attribute of `Answer`."""
    return [(name, each) for name in study.varying for each in STATISTICS if study.converges(name, each)]


def need(study: Study, curve: Curve) -> Need:
    """Return what a method that draws needs, for 95 of 100 runs to keep the accuracy in every number of every
    forecast.
    """
    longest = float(curve.lengths[-1].budget)
    worst = Need(0.0, 0.0, "", "mean", 0.0)
    for kind in _asked_kinds(study):
        tolerance = study.tolerance(kind[0])
        result = law(study, curve, kind)
        reaches = _verdict(result.floor_low, result.floor_high, tolerance)
        trials = np.inf if reaches == "no" else result.trials(tolerance)
        rank = (("yes", "unknown", "no").index(reaches), trials)
        if rank > (("yes", "unknown", "no").index(worst.reaches), worst.trials) or not worst.forecast:
            floor = result.floor / tolerance if tolerance > 0.0 else np.inf
            worst = Need(trials, seconds_of(curve, trials), *kind, trials / longest, reaches, floor, result.error)
    if worst.reaches == "yes" and not np.isfinite(worst.trials):
        worst = replace(worst, reaches="unknown")
    return _agreeing(study, curve, worst)


def _agreeing(study: Study, curve: Curve, result: Need) -> Need:
    """Return the need of an engine, which is off in every run by what its arithmetic rounds differently."""
    for name in study.varying:
        off = curve.apart * study.reference.answers[name].sd
        tolerance = study.tolerance(name)
        if off > tolerance:
            return Need(np.inf, np.inf, name, "mean", np.inf, "no", off / tolerance)
    return result


def _verdict(low: float, high: float, tolerance: float) -> Verdict:
    """Whether an error between these bounds is within a tolerance."""
    return "no" if low > tolerance else "yes" if high <= tolerance else "unknown"


def worst_error(study: Study, curve: Curve) -> WorstError:
    """Return the worst number of an answer that was given once; a number that is surely not good enough comes first."""
    order = ("yes", "unknown", "no")
    return max(_single_errors(study, curve), key=lambda each: (order.index(each.reaches), each.times))


def _single_errors(study: Study, curve: Curve) -> Iterator[WorstError]:
    """Every number; the reference's error counts for as many comparisons as there are numbers and such methods."""
    from scipy.special import ndtri

    kinds = _asked_kinds(study)
    chances = max(len(kinds) * len([each for each in study.once if each.answers]), 1)
    wide = float(-ndtri((1.0 - CONFIDENCE) / 2.0 / chances))
    for kind in kinds:
        error = curve.lengths[-1].errors[kind]
        tolerance = study.tolerance(kind[0])
        if not np.isfinite(error.value):
            yield WorstError(*kind, np.nan, error.error, np.inf, "no")
            continue
        own = wide * float(np.nan_to_num(error.error))
        reaches = _verdict(error.value - own, error.value + own, tolerance)
        yield WorstError(*kind, error.bias, error.error, error.value / tolerance, reaches)


def reach_of(study: Study, curve: Curve, runs: Runs, kind: tuple[str, str]) -> tuple[float, float, float]:
    """Return what 95 of 100 runs of one length keep within in one number, and the 95 % bounds of that, over the
    tolerance.

    Of an answer that was given once: its error, and the bounds that the reference's error leaves.
    """
    error, tolerance = runs.errors[kind], study.tolerance(kind[0])
    wide = (1.0 if curve in study.once else NORMAL_95) / tolerance
    low, high = error.interval
    return wide * error.value, wide * low, wide * high


def seconds_of(curve: Curve, trials: float) -> float:
    """Return a run of so many trials: between measured run lengths in proportion, and beyond them at the longest one's
    rate.

    Beyond them a trial costs what it cost on average in the longest run: the difference between two clocked runs is
    noise where they are short, and would be carried on to billions of trials.
    """
    timed = [runs for runs in curve.lengths if np.isfinite(runs.seconds)]
    if not timed or not np.isfinite(trials):
        return np.inf
    budgets = np.array([float(runs.budget) for runs in timed])
    seconds = np.array([runs.seconds for runs in timed])
    if trials <= budgets[-1]:
        return float(np.interp(trials, budgets, seconds))
    each = float(seconds[-1] / budgets[-1])
    return float(seconds[-1]) + each * (trials - float(budgets[-1]))


def tied(seconds: Mapping[Each, float]) -> tuple[Each, ...]:
    """Those that take the least time within a fifth or a tenth of a second, the fastest first."""
    ordered = sorted(seconds, key=lambda each: seconds[each])
    least = seconds[ordered[0]]
    return tuple(each for each in ordered if seconds[each] <= max(_TIE * least, least + NO_TIME))


@dataclass(frozen=True, slots=True, eq=False)
class Choice:
    """Methods that draw, for one accuracy.

    Attributes:
        chosen: what to use; None if no method reaches the accuracy, as for a tolerance of zero.
        needs: what each method needs.
        cheapest: the method of the least seconds, and those that tie with it, the least first.
    """

    chosen: Curve | None
    needs: Mapping[Curve, Need]
    cheapest: tuple[Curve, ...]


def choice(study: Study, accuracy: tuple[str, float, bool] | None = None) -> Choice:
    """Choose for the accuracy of a study, or for another one.

    Monte Carlo, whose trials are independent and whose errors come out of the run itself, unless that takes more than
    one and a half times what another method takes, and a tenth of a second more. Another engine's seconds count with
    those that it takes to get ready.
    """
    asked = study if accuracy is None else replace(study, accuracy=accuracy)
    needs = {curve: need(asked, curve) for curve in (*study.curves, *study.engines)}
    usable = sorted((curve for curve, result in needs.items() if result.usable), key=lambda curve: needs[curve].seconds)
    if not usable:
        return Choice(None, needs, ())
    cheapest = tied({curve: needs[curve].seconds for curve in usable})
    plain = next((curve for curve in usable if curve.method.key == MONTE_CARLO.key), usable[0])
    costs = {curve: needs[curve].seconds + ENGINE_READY * (curve in asked.engines) for curve in usable}
    return Choice(chosen_of(costs, plain), needs, cheapest)


def chosen_of(costs: Mapping[Each, float], plain: Each) -> Each:
    """Return the usual choice, unless another costs less by a factor of one and a half and by a tenth of a second.

    >>> chosen_of({"mc": 2.0, "lhs": 1.3}, "mc"), chosen_of({"mc": 0.2, "lhs": 0.11}, "mc")
    ('lhs', 'mc')
    """
    best = min(costs, key=lambda each: costs[each])
    slow = costs[plain] > max(_NO_MATTER * costs[best], costs[best] + NO_TIME)
    return best if slow else plain
