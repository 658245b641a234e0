"""Run all methods on one workbook, and measure what each costs and how far it is from a converged reference."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import median
from time import perf_counter
from typing import Any, Final

import numpy as np

from xlmc.analysis.studies.methods.answer import STATISTICS, Answer, Extreme, Method, MethodResult, seconds_text
from xlmc.analysis.studies.methods.converged_reference import (
    FIRST,
    PROBE,
    Reference,
    fastest_engine,
    probe_of,
    reference_of,
    unfiltered_of,
)
from xlmc.analysis.studies.methods.corners import Corners
from xlmc.analysis.studies.methods.curve import Curve, Runs, in_order, runs_of
from xlmc.analysis.studies.methods.differential import FirstOrder, SecondOrder, WorstCase
from xlmc.analysis.studies.methods.importance_grid import ImportanceGrid
from xlmc.analysis.studies.methods.optimised import Optimised, widen_bounds
from xlmc.analysis.studies.methods.sampled import ENGINE_VARIANTS, MONTE_CARLO, SAMPLERS, Sampled
from xlmc.analysis.studies.methods.surrogate import Surrogate
from xlmc.analysis.studies.shown import Shown
from xlmc.analysis.studies.steps import Steps, Tell
from xlmc.errors import FormulaError, SimulationError
from xlmc.montecarlo.definitions.amounts import as_seconds, as_tolerance
from xlmc.montecarlo.definitions.forms import span_text
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.model.plain_words import duration
from xlmc.montecarlo.number_text import count_text, number_text

__all__ = ["ACCURACY", "LENGTHS", "MANY", "REPLICATES", "STEP", "Study", "ladder_of", "quick_settings", "study"]

ACCURACY: Final = "1%"
REPLICATES: Final = 24
"""This number of runs of each length gives a root mean square error to 15 %."""

STEP: Final = 4
"""The trials of each run length over those of the next shorter one."""

LENGTHS: Final = 8
"""Run lengths: the longest has 16,384 times the trials of the shortest, four decades."""

_SHORTEST: Final = 128
_FEWEST_ACCEPTED: Final = 4.0
"""Accepted trials of the shortest runs, about."""

ONCE: Final[tuple[Method, ...]] = (Corners(), Optimised(), WorstCase(), FirstOrder(), SecondOrder())
DRAWN: Final[tuple[Method, ...]] = (*SAMPLERS, ImportanceGrid(), Surrogate())

MANY: Final = 20
"""With more assumptions than these there is a limit of time, if none is given: some methods cost the square of their
number, and more."""

_LIMIT, _QUICK_LIMIT = 60.0, 30.0
"""Seconds of a study of many assumptions, and of a quick one."""

_REFERENCE_SHARE, _ONCE_SHARE, _METHOD_SHARE, _SLOW_SHARE = 0.1, 0.1, 0.2, 0.2
"""Of the limit of time: for the reference, for a method that gives one answer, for six runs of one that draws, and what
must be left for the slow engine."""

_LIMITED_LENGTHS: Final = 4
"""Run lengths where the time is limited: of many assumptions all short runs take the same time."""

_PER_LIMIT: Final = 50
"""The limit of time over the longest run by Monte Carlo."""

_REFERENCE_SECONDS: Final = 8.0
_LONGEST_RUN: Final = 2.5
"""Seconds of a run by Monte Carlo: longer ones are not measured."""

_APART: Final = 1_000_000
"""Between the seeds of the runs of one length and those of the next: runs of different lengths share no trials."""

SLOW: Final = "formulas"

_RUNS_SECONDS, _LEAST_RUNS, _LEAST_OF_SLOW = 4.0, 6, 3
"""Seconds for one method and run length, where the number of runs is not given; the fewest runs, and the fewest where
each takes longer than all should.
"""

_FEWEST_RUNS: Final = 2
"""Runs of each length, without which there is no error to tell."""

_INTERRUPTED: Final = "the study was interrupted before it"
_MORE_TIME: Final = "give a longer time with --time-limit"

_FEWEST_LENGTHS: Final = 3
"""Run lengths, without which there is no slope to tell."""

_CLOCKED: Final = 3
"""Runs of an engine of each length: only their seconds matter, because their errors are those of Monte Carlo."""

_FEW: Final = 8
"""Trials that the slow reference engine is timed by."""

_PATIENCE: Final = 1.0
"""Seconds of a run that is too long to be repeated."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Study(Shown):
    """What was measured.

    Attributes:
        model: the workbook.
        seed: of the reference; the replicates have others.
        accuracy: what is asked of the answers, as typed, the number, and whether it is a share of each number.
        reference: what errors are measured against.
        unfiltered: the same without the filters; None if they reject nothing, or where there is no such answer.
        ladder: trials of the runs of methods that draw.
        replicates: the most runs of each length.
        once: the methods that give one answer, the cheapest idea first.
        curves: the methods that draw.
        engines: the same trials as Monte Carlo's, computed by other engines.
        absent: method -> why it could not be used.
        texts: the forecasts whose answers are texts, which are left out.
        ended: why it ended before all runs were made; empty if it did not.
    """

    model: CompiledModel
    seed: int
    accuracy: tuple[str, float, bool]
    reference: Reference
    unfiltered: Reference | None
    ladder: tuple[int, ...]
    replicates: int
    once: tuple[Curve, ...]
    curves: tuple[Curve, ...]
    engines: tuple[Curve, ...]
    absent: Mapping[str, str]
    texts: tuple[str, ...] = ()
    ended: str = ""

    @property
    def every(self) -> tuple[Curve, ...]:
        return (*self.once, *self.curves, *self.engines)

    @property
    def varying(self) -> tuple[str, ...]:
        """The forecasts that vary; every method gives the others exactly."""
        return tuple(name for name, width in self.reference.widths.items() if width > 0.0)

    def converges(self, forecast: str, statistic: str) -> bool:
        """Whether a statistic of a forecast is asked for and converges: the forecast varies, its tail is not too
        heavy, and of a yes/no answer it is its share.
        """
        return forecast in self.varying and self.reference.asks(forecast, statistic)

    def amount(self, forecast: str, value: float, digits: int = 2) -> str:
        """Write an error or a width of a forecast without its own error, in so many digits, with its units."""
        form = self.reference.form(forecast)
        units = next((f" {f.units}" for f in self.model.forecasts if f.name == forecast and f.units), "")
        if form.kind is Kind.DATE:
            return span_text(value)
        return f"{form.rough(float(f'{value:.{digits}g}'))}{units}"

    def tolerance(self, forecast: str) -> float:
        """Return the error asked for, in the forecast's units."""
        _, value, relative = self.accuracy
        return value * self.reference.widths[forecast] if relative else value


def study(
    model: CompiledModel,
    *,
    accuracy: str = ACCURACY,
    reference_trials: int | None = None,
    trials: int | None = None,
    replicates: int | None = None,
    patience: float | None = None,
    time_limit: str | float | None = None,
    seed: int | None = None,
    tell: Tell | None = None,
    plan: Tell | None = None,
) -> Study:
    """Measure every method on a workbook.

    As soon as a first short run says how fast the workbook is, a first Ctrl-C ends it with what was run by then
    (`Study.ended`): that run is the reference where no longer one was made, and the three shortest lengths are run
    twice by Monte Carlo if they were not.

    Args:
        model: the workbook.
        accuracy: of mean, standard deviation and both ends of the central range, that 95 of 100 runs keep: `1%` of
            each forecast's 5–95 % range, or a number in the forecasts' units.
        reference_trials: by default a power of two of them, up to 33,554,432, that takes about eight seconds.
        trials: of the longest runs; by default 16,384 times those of the shortest, or what takes two seconds.
        replicates: runs of each length, 2 or more; by default 24, or as many as take a method four seconds, 6 at least.
        patience: seconds after which one method is not run again at one length, after six runs at least, or three where
            each takes longer than that; by default four, or as long as it takes where `replicates` is given.
        time_limit: of the whole study, about: `60s`, `5m`, or seconds. Methods that take too much of it are left out,
            and named. By default a minute with more than 20 assumptions, if no number of trials or runs is given.
        seed: of the reference; by default the workbook's.
        tell: called with what is being measured, how many steps are left, and how long they may take.
        plan: called with what will be measured, and how long that takes at most.

    Raises:
        SimulationError: an argument is out of its range, or the reference accepts too few trials.
    """
    wanted = (accuracy.strip(), *as_tolerance(accuracy))
    texts = tuple(model.forecasts[number].name for number in model.categories)
    model = _without_texts(model)
    own = model.definitions.settings.seed if seed is None else seed
    _check(own, replicates, trials, reference_trials, model)
    limit = None if time_limit is None else as_seconds(time_limit)
    if limit is None and len(model.live) > MANY and not (reference_trials or trials or replicates):
        limit = _LIMIT
    with Steps(tell, plan=plan) as steps:
        return _measured(model, wanted, texts, own, reference_trials, trials, replicates, patience, limit, steps)


def _measured(
    model: CompiledModel,
    wanted: tuple[str, float, bool],
    texts: tuple[str, ...],
    own: int,
    reference_trials: int | None,
    trials: int | None,
    replicates: int | None,
    patience: float | None,
    limit: float | None,
    steps: Steps,
) -> Study:
    began = perf_counter()
    steps.latest = began + (limit or np.inf)
    engine, most = "numpy", replicates or REPLICATES
    steps.begin("how fast the workbook is")
    probe = probe_of(model, engine, own, FIRST)
    if probe.reference is not None:
        steps.can_end()
    with steps.left_at_once():
        engine = fastest_engine(model)
        probe_of(model, engine, own, FIRST)
        probe = probe_of(model, engine, own, PROBE)
    if probe.reference is not None:
        steps.can_end()
    size = reference_trials or probe.trials_in(min(_REFERENCE_SECONDS, _REFERENCE_SHARE * (limit or np.inf)))
    if patience is None:
        patience = _RUNS_SECONDS if replicates is None else np.inf
    reference = probe.reference
    if not steps.ended:
        steps.say_plan(*_plan(model, size, most, patience, limit))
        with steps.left_at_once():
            steps.begin(f"the reference, {count_text(size)} trials")
            reference = reference_of(model, size, probe.sampling, engine, own)
    assert reference is not None  # or else Ctrl-C ended it all
    unfiltered = None
    if not steps.ended:
        with steps.left_at_once():
            unfiltered = unfiltered_of(model, reference)
    longest = _LONGEST_RUN if limit is None else min(_LONGEST_RUN, limit / _PER_LIMIT)
    ladder = ladder_of(model, trials, own, reference.acceptance.value, longest, steps)
    if limit is not None and trials is None:
        ladder = ladder[-_LIMITED_LENGTHS:]
    left = None if limit is None else max(limit - (perf_counter() - began), 0.0)
    measuring = _Measuring(model, reference, ladder, most, patience, own, steps, limit, left)
    steps.can_end()
    once = measuring.once(ONCE)
    result = measuring.run_drawn(DRAWN, [each for each in ENGINE_VARIANTS if each.engine != SLOW])
    curves = tuple(curve for curve in result if curve.method in DRAWN)
    engines = tuple(curve for curve in result if curve.method not in DRAWN)
    with steps.left_at_once():
        once = tuple(measuring.widen(curve) if curve.ends and not steps.ended else curve for curve in once)
    for variant in steps.each(ENGINE_VARIANTS):
        if variant.engine == SLOW:
            engines += measuring.time_slow(variant, next(curve for curve in curves if curve.method is MONTE_CARLO))
    return Study(
        model, own, wanted, reference, unfiltered, measuring.ladder, most, once, curves, engines, measuring.absent,
        texts, steps.why_ended,
    )  # fmt: skip


def _plan(model: CompiledModel, size: int, most: int, patience: float, limit: float | None) -> tuple[str, float]:
    """Say what will be measured, and how many seconds that may take."""
    count = len(ONCE) + len(DRAWN) + len(ENGINE_VARIANTS)
    what = (
        f"Measures {count} methods on {count_text(len(model.live))} assumptions and {count_text(len(model.forecasts))} "
        f"forecasts: a reference of {count_text(size)} trials, then up to {most} runs of each method that draws and of "
        f"each of up to {LENGTHS} lengths"
    )
    if limit is None:
        return what, 2.0 * _REFERENCE_SECONDS + min(patience, most) * LENGTHS * len(DRAWN)
    return f"{what}; a method that takes too long is left out, but for a larger --time-limit", limit


def _without_texts(model: CompiledModel) -> CompiledModel:
    """Return the model without forecasts whose answers are texts: no method is a way to compute their mean.

    Raises:
        SimulationError: it has no other forecasts.
    """
    if not model.categories:
        return model
    kept = tuple(each for number, each in enumerate(model.forecasts) if number not in model.categories)
    if not kept:
        message = "all answers of the workbook are texts, and methods are compared by numbers"
        raise SimulationError(message, where=model.forecasts[0].cell, hint="Add a forecast that is a number")
    names = {each.name for each in kept}
    own = tuple(each for each in model.forecast_filters if {*each.only_for} <= names)
    return model.changed(model.workbook, replace(model.definitions, forecasts=kept, forecast_filters=own))


def quick_settings(model: CompiledModel, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arguments that `--quick` gives to `study` beside the given ones: few and short runs, or of many
    assumptions as many as half a minute allows.
    """
    if len(model.live) > MANY and not given:
        return {"time_limit": _QUICK_LIMIT}
    usual = {"reference_trials": 1 << 20, "trials": 1 << 17, **given}
    return usual if "replicates" in given else {**usual, "replicates": 8, "patience": 0.5}


def ladder_of(
    model: CompiledModel, most: int | None, seed: int, acceptance: float, longest: float, steps: Steps
) -> tuple[int, ...]:
    """Trials of the runs, the fewest first: three lengths at least.

    The shortest have about four accepted trials, or 128 trials. Where `most` is not given, the longest have 16,384
    times as many, or as many as Monte Carlo computes in `longest` seconds.
    """
    shortest = max(_SHORTEST, 1 << math.ceil(math.log2(_FEWEST_ACCEPTED / max(acceptance, 1e-9))))
    if most is not None:
        lengths = [most // STEP**k for k in range(LENGTHS) if k < 3 or most // STEP**k >= shortest]
        return tuple(dict.fromkeys(max(each, 16) for each in reversed(lengths)))
    result = [shortest, shortest * STEP, shortest * STEP**2]
    with steps.left_at_once():
        while len(result) < LENGTHS and not steps.ended:
            seconds = min(MONTE_CARLO.run(model, result[-1], seed).seconds for _ in range(2))
            if seconds * STEP > longest:
                break
            result.append(result[-1] * STEP)
    return tuple(result)


def _check(seed: int, replicates: int | None, trials: int | None, reference: int | None, model: CompiledModel) -> None:
    if not model.forecasts:
        raise SimulationError("the workbook has no forecast", hint="add one to the table xlmc_forecasts")
    if not model.live:
        message = "no assumption that the forecasts or filters need is drawn, so that every method gives the same"
        raise SimulationError(message, hint="give the table xlmc_assumptions a range that a forecast depends on")
    if model.chances:
        named = ", ".join(repr(each.name) for each in model.filters if each.evidence and each.evidence.bell)
        message = f"the methods that draw no trials cannot use evidence with a normal or lognormal error: {named}"
        raise SimulationError(message, hint="switch it off under Use in xlmc_evidence, or give it a uniform error")
    if model.forecast_filters:
        named = ", ".join(repr(each.name) for each in model.forecast_filters)
        message = f"the methods that draw no trials cannot use filters of some forecasts only: {named}"
        raise SimulationError(message, hint="take their forecasts out of a copy of the workbook, or empty Only for")
    if seed < 0:
        raise SimulationError(f"the seed {seed} is negative", hint="give a whole number from 0 up")
    if replicates is not None and replicates < 2:
        raise SimulationError(f"{replicates} replicates were asked for", hint="give 2 or more; 24 are usual")
    for what, given, least in (("trials", trials, 1_024), ("reference trials", reference, 1_024)):
        if given is not None and given < least:
            raise SimulationError(
                f"{count_text(given)} {what} were asked for", hint=f"give {count_text(least)} or more"
            )


class _Measuring:
    """The runs of one study.

    Attributes:
        ladder: trials of the runs; fewer where the study is ended before the longer ones were run twice.
        absent: method -> why it could not be used.
    """

    def __init__(
        self,
        model: CompiledModel,
        reference: Reference,
        ladder: tuple[int, ...],
        replicates: int,
        patience: float,
        seed: int,
        steps: Steps,
        limit: float | None,
        left: float | None,
    ) -> None:
        self._model, self._reference, self.ladder = model, reference, ladder
        self._limit = np.inf if limit is None else limit
        self._deadline = np.inf if left is None else perf_counter() + left
        self._replicates, self._patience = replicates, patience
        self._seed, self._steps = seed, steps
        self._extremes: dict[str, dict[str, Extreme]] = {}
        self.absent: dict[str, str] = {}

    @property
    def _left(self) -> float:
        """Seconds that are left of the limit."""
        return max(self._deadline - perf_counter(), 0.0)

    @property
    def _over(self) -> bool:
        """Whether no run is to begin that can be done without: Ctrl-C was pressed, or the time is over."""
        return self._steps.ended or not self._left > 0.0

    def once(self, methods: Sequence[Method]) -> tuple[Curve, ...]:
        """Run the methods that give one answer; twice, so that the second run shows what they cost."""
        curves = []
        for method in methods:
            if self._over:
                self.absent[method.name] = self._why_not
                continue
            self._steps.begin(method.name)
            limited = replace(method, seconds=_ONCE_SHARE * self._limit) if isinstance(method, Optimised) else method
            first = self._try(limited, self.ladder[-1])
            if first is None:
                continue
            again = first
            with self._steps.left_at_once():
                again = method.run(self._model, self.ladder[-1], self._seed) if first.seconds < _PATIENCE else first
            result = replace(again, seconds=min(first.seconds, again.seconds))
            runs = runs_of(result.evaluations, [result], self._reference)
            ranges = {name: (a.least, a.most) for name, a in result.answers.items() if np.isfinite(a.least)}
            setup = max(0.0, first.seconds - again.seconds)
            curves.append(Curve(method, (runs,), setup, result.remarks, ranges, ends=result.ends))
        return tuple(curves)

    @property
    def _why_not(self) -> str:
        return _INTERRUPTED if self._steps.ended else f"the {self._allowed} did not suffice for it; {_MORE_TIME}"

    @property
    def _allowed(self) -> str:
        return f"{duration(self._limit)} of the study"

    def widen(self, curve: Curve) -> Curve:
        """Bounds by optimisation, no narrower than what any run has drawn."""
        extremes = [*self._reference.extremes, *(each for ends in self._extremes.values() for each in ends.values())]
        wider, ends = widen_bounds(self._model, self._seed, curve.ranges, extremes)
        if not ends:
            return curve
        ranges = {
            name: (float(np.fmin(least, a.least)), float(np.fmax(most, a.most)))
            for name, (least, most) in curve.ranges.items()
            for a in (wider.get(name, Answer()),)
        }
        names = ", ".join(f"{end} {name}" for name, end in ends)
        remark = f"searched again from drawn trials that lie farther out: {names}"
        return replace(curve, ranges=ranges, ends={**curve.ends, **ends}, remarks=(*curve.remarks, remark))

    def run_drawn(self, methods: Sequence[Method], engines: Sequence[Sampled]) -> tuple[Curve, ...]:
        """Run the methods that draw, and the engines, which compute again the trials of the first of these.

        They take turns, run length after run length, so that other work of the machine slows all of them alike.
        """
        firsts, able = self._firsts((*methods, *engines))
        results: dict[tuple[str, int], list[MethodResult]] = {(m.key, b): [] for m in able for b in self.ladder}
        if np.isfinite(self._limit):
            self._patience = min(self._patience, self._left / len(results))
        self._steps.expect(self._replicates + 1)  # and the slow engine
        for replicate in range(self._replicates):
            if self._over and replicate >= _FEWEST_RUNS:
                break
            self._steps.begin(
                f"runs of {count_text(self.ladder[0])} to {count_text(self.ladder[-1])} trials, "
                f"{replicate + 1} of {self._replicates}"
            )
            with self._steps.left_at_once():
                self._run_all(able, engines, results, replicate)
        self._complete(results)
        self._keep_complete(able, results)
        able = [method for method in able if (method.key, self.ladder[0]) in results]
        result = {m.key: self._curve(m, firsts[m.key], results) for m in able if m not in engines}
        same = [self._engine_curve(e, firsts[e.key], results, result[MONTE_CARLO.key]) for e in engines if e in able]
        return (*result.values(), *same)

    def _firsts(self, methods: Sequence[Method]) -> tuple[dict[str, MethodResult | None], list[Method]]:
        """Run each method for the first time: key -> what that gave, and the methods that are to be run on.

        Of these is Monte Carlo in any case.
        """
        firsts: dict[str, MethodResult | None] = {}
        able: list[Method] = []
        for method in methods:
            if self._over and method is not MONTE_CARLO:
                self.absent[method.name] = self._why_not
                continue
            self._steps.begin(f"{method.name}, a first run")
            first = firsts[method.key] = self._try(method, self.ladder[0])
            usual = first
            if first is not None and 1.0 < self._slowness(first) < _FEWEST_RUNS * _FEWEST_LENGTHS / 2.0:
                usual = self._try(method, self.ladder[0])  # the first may have compiled or learned something
            if first is not None and usual is not None and self._slowness(usual) > 1.0 and method is not MONTE_CARLO:
                self.absent[method.name] = (
                    f"one run of {count_text(self.ladder[0])} trials took {seconds_text(usual.seconds)}, too much of "
                    f"the {self._allowed}; {_MORE_TIME}"
                )
            elif first is not None or method is MONTE_CARLO:
                self.absent.pop(method.name, None)
                able.append(method)
        return firsts, able

    def _slowness(self, result: MethodResult) -> float:
        """Return how many times what the limit has for a method the runs that are needed would take."""
        return result.seconds * _FEWEST_RUNS * _FEWEST_LENGTHS / (_METHOD_SHARE * self._limit)

    def _run_all(
        self,
        able: Sequence[Method],
        engines: Sequence[Method],
        results: Mapping[tuple[str, int], list[MethodResult]],
        replicate: int,
    ) -> None:
        """Run every method once at every length, as far as there is time."""
        for number, budget in enumerate(self.ladder):
            for method in able:
                if self._over:
                    return
                known = results[method.key, budget]
                if not self._enough(known, method in engines):
                    known.append(self._run(method, budget, self._seed_of(number, replicate)))

    def _seed_of(self, number: int, replicate: int) -> int:
        """Return the seed of one run of the length of this number."""
        return self._seed + 1 + number * _APART + replicate

    def _complete(self, results: Mapping[tuple[str, int], list[MethodResult]]) -> None:
        """Run Monte Carlo as often as any answer needs, if it was not."""
        for number, budget in enumerate(self.ladder[:_FEWEST_LENGTHS]):
            known = results[MONTE_CARLO.key, budget]
            while len(known) < _FEWEST_RUNS:
                known.append(self._run(MONTE_CARLO, budget, self._seed_of(number, len(known))))

    def _keep_complete(self, able: Sequence[Method], results: dict[tuple[str, int], list[MethodResult]]) -> None:
        """Leave out the methods that were not run twice at the three shortest lengths, then the lengths that not every
        other method was run at.
        """

        def ran(method: Method) -> int:
            return next((n for n, b in enumerate(self.ladder) if len(results[method.key, b]) < _FEWEST_RUNS), LENGTHS)

        for method in able:
            if ran(method) < _FEWEST_LENGTHS:
                self.absent[method.name] = self._why_not
                for budget in self.ladder:
                    del results[method.key, budget]
        kept = [method for method in able if (method.key, self.ladder[0]) in results]
        self.ladder = self.ladder[: min(map(ran, kept))]

    def _enough(self, known: Sequence[MethodResult], engine: bool) -> bool:
        """Whether there are enough runs of one method and length: as many as wanted, or as their time allows."""
        if engine and len(known) >= _CLOCKED:
            return True
        spent = sum(result.seconds for result in known)
        least = _LEAST_RUNS if spent <= len(known) * self._patience else _LEAST_OF_SLOW
        if np.isfinite(self._limit):
            least = _FEWEST_RUNS
        return len(known) >= least and spent > self._patience

    def _run(self, method: Method, budget: int, seed: int) -> MethodResult:
        """One run of a method; one that fails because it has too few accepted trials counts as failed."""
        try:
            result = method.run(self._model, budget, seed)
            for each in result.extremes:
                self._remember(each)
            return replace(result, extremes=())
        except SimulationError as error:
            nothing = {forecast.name: Answer() for forecast in self._model.forecasts}
            return MethodResult(np.nan, budget, nothing, remarks=(str(error),))

    def _remember(self, each: Extreme) -> None:
        """Return the outermost trial of all runs, for each end of each forecast."""
        ends = self._extremes.setdefault(each.forecast, {})
        sign = 1.0 if each.end == "least" else -1.0
        if each.end not in ends or sign * each.value < sign * ends[each.end].value:
            ends[each.end] = each

    def _curve(
        self, method: Method, first: MethodResult | None, results: Mapping[tuple[str, int], list[MethodResult]]
    ) -> Curve:
        lengths = in_order([runs_of(budget, results[method.key, budget], self._reference) for budget in self.ladder])
        remarks = results[method.key, self.ladder[-1]][-1].remarks
        return Curve(method, lengths, _setup(first, lengths[0]), remarks, {})

    def _engine_curve(
        self,
        engine: Sampled,
        first: MethodResult | None,
        results: Mapping[tuple[str, int], list[MethodResult]],
        plain: Curve,
    ) -> Curve:
        """Return the errors of the trials, which are those of `plain`, with the seconds of an engine."""
        lengths = []
        for runs in plain.lengths:
            timed = [result.seconds for result in results[engine.key, runs.budget]]
            lengths.append(replace(runs, seconds=min(timed), usual=median(timed)))
        ordered = in_order(lengths)
        apart = max(
            self._apart(results[engine.key, budget], results[MONTE_CARLO.key, budget]) for budget in self.ladder
        )
        remark = f"answers at the same trials differ from those of numpy by {number_text(apart, 1)} SD at the most"
        return Curve(engine, ordered, _setup(first, ordered[0]), (remark,), {}, apart)

    def time_slow(self, engine: Sampled, numpy: Curve) -> tuple[Curve, ...]:
        """Time an engine that is too slow for runs of any length: its time is worked out from a few trials."""
        if np.isfinite(self._limit) and self._left < _SLOW_SHARE * self._limit:
            self.absent[engine.name] = self._why_not
            return ()
        self._steps.begin(engine.name)
        first = self._try(engine, _FEW)
        if first is None:
            return ()
        again = first.seconds
        with self._steps.left_at_once():
            again = engine.run(self._model, _FEW, self._seed).seconds
        each = again / _FEW
        lengths = tuple(
            replace(r, seconds=each * r.budget, usual=each * r.budget, measured=False) for r in numpy.lengths
        )  # fmt: skip
        remark = f"the same trials as {numpy.method.name}; time worked out from {_FEW} of them"
        return (Curve(engine, lengths, max(0.0, first.seconds - again), (remark,), {}),)

    def _try(self, method: Method, budget: int) -> MethodResult | None:
        """Run a method for the first time; None, and why, where it cannot be used, or was interrupted."""
        try:
            with self._steps.left_at_once():
                return method.run(self._model, budget, self._seed)
        except (SimulationError, FormulaError) as error:
            self.absent[method.name] = str(error)
        else:
            self.absent[method.name] = _INTERRUPTED
        return None

    def _apart(self, results: Sequence[MethodResult], numpy: Sequence[MethodResult]) -> float:
        """How far an engine's answers are from those of `numpy` at the same trials, in standard deviations."""
        apart = [
            abs(getattr(answer, statistic) - getattr(other.answers[name], statistic)) / self._reference.answers[name].sd
            for one, other in zip(results, numpy, strict=False)
            for name, answer in one.answers.items()
            for statistic in STATISTICS
            if self._reference.widths[name] > 0.0
        ]
        return max((each for each in apart if np.isfinite(each)), default=0.0)


def _setup(first: MethodResult | None, runs: Runs) -> float:
    """Seconds of a first run beyond those of the next ones."""
    return 0.0 if first is None else float(np.nan_to_num(max(0.0, first.seconds - runs.seconds)))
