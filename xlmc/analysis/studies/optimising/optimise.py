"""The best decisions: the values of the decisions of a workbook with which a statistic is largest, or smallest.

The candidates are searched over random numbers that all of them share, and the chosen one is run once more with others,
the workbook's own: what is reported of it is what `xlmc simulate` gives of the workbook with these decisions typed in.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from statistics import NormalDist
from typing import Final, TypedDict

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.comparison.variations import names_of, with_plain_sampling
from xlmc.analysis.studies.decisions import values_text
from xlmc.analysis.studies.optimising.candidates import Ended, Space, Standing, Tried
from xlmc.analysis.studies.optimising.goal_text import Reader
from xlmc.analysis.studies.optimising.measures import Goal, Measured, Requirement
from xlmc.analysis.studies.optimising.search import search
from xlmc.analysis.studies.optimising.selection import Rival, indifference_of, judged, leader, race, rivals_of
from xlmc.analysis.studies.scenario_workbook import edited_workbook
from xlmc.analysis.studies.shown import Shown
from xlmc.errors import DefinitionError, SimulationError
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.definitions.definitions import Decision
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.definitions.scenarios import Scenario, Typed
from xlmc.montecarlo.loop.candidates import CandidateTrials, Values
from xlmc.montecarlo.loop.stopping import Interruption
from xlmc.montecarlo.model.loading import build_model, model_with_values
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.number_text import count_text, number_text
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.montecarlo.simulation.simulation import ERROR_SHARE, RunResult
from xlmc.montecarlo.statistics import Estimate
from xlmc.montecarlo.statistics.estimate import with_error

__all__ = ["ALLOW_LOST", "RUNS", "Excluded", "OptimiseArguments", "Optimised", "RequirementResult", "optimise"]

ALLOW_LOST: Final = 100.0 * ERROR_SHARE
RUNS: Final = 60.0
"""Trials that the search may take, as a multiple of those of a run."""
_FRESH_RUNS: Final = 30.0
_LEAST_TRIALS: Final = 30
_SHOWN: Final = 10
"""Rivals that are listed."""

Floats = NDArray[np.float64]
Tell = Callable[[str], None]


class OptimiseArguments(TypedDict, total=False):
    """The arguments of `optimise` beside the model."""

    maximise: str | None
    minimise: str | None
    subject_to: Sequence[str]
    decisions: Iterable[str]
    indifference: float | None
    allow_lost: float
    runs: float
    trials: int | None
    seed: int | None
    engine: str | None
    jobs: int
    tell: Tell | None


@dataclass(frozen=True, slots=True)
class RequirementResult:
    """A requirement, and how far the best decisions meet it.

    Attributes:
        estimate: the value of its left side, from the run.
        chance: the probability that it holds, whatever else another seed would show.
    """

    requirement: Requirement
    estimate: Estimate
    chance: float

    @property
    def exact(self) -> bool:
        """Whether decisions alone decide it."""
        return self.requirement.slack.exact


@dataclass(frozen=True, slots=True)
class Excluded:
    """A candidate that cannot be the best, since too many of its trials are lost to errors.

    Attributes:
        lost: the share of its trials.
        looks_better: whether the trials that are left make it better than the best by more than the indifference.
    """

    candidate: Values
    lost: float
    looks_better: bool


@dataclass(frozen=True, slots=True, repr=False)
class Optimised(Shown):
    """The best candidate that was tried, and how sure that is.

    Attributes:
        run: of the workbook with the best decisions typed in.
        goal: that was sought.
        decisions: that were chosen.
        best: their values.
        estimate: the goal with them.
        requirements: what is required, with them.
        as_it_is: the goal with the workbook's own decisions; None where the cells hold no numbers.
        indifference: a difference of the goal that does not matter.
        confidence: the probability that no other candidate that was tried, and meets the requirements as surely, is
            better by more than the indifference.
        rivals: other candidates that are nearly as good or better, over fresh trials.
        tried: how many candidates were tried.
        trials: that all of it took.
        how: the candidates were chosen.
        ended: why the search ended early; empty where it did not.
        curve: of a single decision, its values with the goal and its error; else empty.
        search_seed: the seed of the search's trials.
        lost: the share of the best one's fresh trials that errors take.
        lost_as_it_is: the same with the workbook's own decisions; 0 where they are no candidate.
        allowed: the share that they may take.
        numberless: candidates that give no number, though errors take few of their trials.
        indifferent: whether all candidates give the same goal.
        missing_texts: texts that are asked for, and that the best decisions' run does not say: forecast and text.
        excluded: the candidates of which errors take clearly more, the share, and whether the trials that are left make
            it better than the best by more than the indifference; those first, then the others.
    """

    run: RunResult
    goal: Goal
    decisions: tuple[Decision, ...]
    best: Values
    estimate: Estimate
    requirements: tuple[RequirementResult, ...]
    as_it_is: Estimate | None
    indifference: float
    confidence: float
    rivals: tuple[Rival, ...]
    tried: int
    trials: int
    how: str
    ended: str
    curve: tuple[tuple[float, float, float], ...]
    search_seed: int
    lost: float
    lost_as_it_is: float
    allowed: float
    numberless: int
    indifferent: bool
    missing_texts: tuple[tuple[str, str], ...]
    excluded: tuple[Excluded, ...]

    @property
    def is_whole(self) -> bool:
        """Whether errors take no more trials of the best than they may."""
        return self.lost <= self.allowed

    @property
    def meets(self) -> bool:
        """Whether every requirement is met, more likely than not, by trials of which errors take few enough."""
        return self.holds and not math.isnan(self.estimate.value) and self.is_whole

    @property
    def holds(self) -> bool:
        """Whether every requirement is met, more likely than not."""
        return all(each.chance > 0.5 for each in self.requirements)

    @property
    def values(self) -> dict[str, float | str | bool]:
        """Name of each decision -> its best value."""
        return {each.name: each.content(value) for each, value in zip(self.decisions, self.best, strict=True)}


def optimise(
    model: CompiledModel,
    *,
    maximise: str | None = None,
    minimise: str | None = None,
    subject_to: Sequence[str] = (),
    decisions: Iterable[str] = (),
    indifference: float | None = None,
    allow_lost: float = ALLOW_LOST,
    runs: float = RUNS,
    trials: int | None = None,
    seed: int | None = None,
    engine: str | None = None,
    jobs: int = 1,
    tell: Tell | None = None,
) -> Optimised:
    """Find the decisions with which a statistic of a forecast is largest, or smallest.

    Args:
        model: of a workbook with a table `xlmc_decisions`; it stays as it is.
        maximise: what is to be largest, such as `mean of NPV`; or else
        minimise: what is to be smallest.
        subject_to: what is required, such as `P5 of NPV >= 0`, or `A + B <= 10` of decisions.
        decisions: names of those that are chosen, joined by commas, `*` for any letters; all where there are none.
        indifference: a difference of the goal that does not matter; by default 1 % of the difference between the best
            and a middling candidate, or two errors of the goal in a run if that is more.
        allow_lost: percent of its trials that a candidate may lose to errors in cells; one that loses more cannot be
            the best, for nobody knows what the lost trials would have been.
        runs: trials that the search may take, as a multiple of those of a run.
        trials: of a run; as in `Model.simulate`, like what follows.
        seed: of the run; the search has another one.
        engine: of all runs.
        jobs: threads.
        tell: called with what is done.

    Raises:
        DefinitionError: the workbook has no decisions.
        SimulationError: what is asked for is not understood, or no combination meets what is required of decisions.
    """
    chosen = _chosen(model, decisions)
    if (maximise is None) == (minimise is None):
        raise SimulationError("What is to be largest, or smallest?", hint='Give one of them, such as "mean of NPV"')
    if not 1.0 <= runs < math.inf:
        raise SimulationError(f"A search of {number_text(runs)} runs is none", hint="Give 1 run or more")
    if indifference is not None and not 0.0 <= indifference < math.inf:
        message = f"{number_text(indifference)} is no difference of the goal"
        raise SimulationError(message, hint="Give an indifference of 0 or more, in the unit of the goal")
    if not 0.0 <= allow_lost <= 100.0:
        message = f"{number_text(allow_lost)} % of the trials cannot be lost to errors"
        raise SimulationError(message, hint="Give a percentage from 0 to 100")
    reader, allowed = Reader(model, chosen), allow_lost / 100.0
    goal = reader.goal(maximise or minimise or "", maximise=maximise is not None)
    requirements = tuple(map(reader.requirement, subject_to))
    options = RunOptions.of(trials=trials, seed=seed, engine=engine, jobs=jobs, evidence="rejection", keep_inputs=None)
    model = with_plain_sampling(model)
    settings = options.settings(model.definitions.settings)
    if settings.trials < _LEAST_TRIALS:
        message = f"{count_text(settings.trials)} trials tell nothing about which decisions are best"
        raise SimulationError(message, hint=f"Give {_LEAST_TRIALS} or more (--trials)")
    space = Space.of(chosen, requirements)
    tell = tell or (lambda _: None)
    with Interruption(wanted=True) as interruption:

        def tried(with_seed: int, most: float) -> Tried:
            computed = CandidateTrials(model, chosen, settings.engine, with_seed, reader.columns, jobs)
            return Tried(computed, goal, requirements, most * settings.trials, lambda: interruption.asked, allowed)

        search_seed = settings.seed + 1
        seeking, ended = tried(search_seed, runs), ""
        own = _own(model, chosen)
        difference, how, interruption.keeping = math.nan, "a search that ended early", True
        try:
            first = own if own is not None and _is_candidate(space, own) else None
            how = search(seeking, space, first, settings.trials, search_seed, tell)
            if seeking.columns:
                difference = _difference(seeking, indifference, settings.trials)
                race(seeking, difference, settings.trials, tell)
        except Ended:
            ended = "it was interrupted" if interruption.asked else "its trials were spent"
    if not seeking.columns:
        if ended:
            raise KeyboardInterrupt
        hint = "Loosen what is required, or give the decisions wider ranges in xlmc_decisions"
        raise SimulationError("No combination of the decisions meets what is required of them", hint=hint)
    difference = _difference(seeking, indifference, settings.trials) if math.isnan(difference) else difference
    best = leader(seeking).candidate
    rivals = rivals_of(seeking, best, difference, settings.trials)
    tell("the best once more, with fresh trials")
    fresh = replace(tried(settings.seed, _FRESH_RUNS), interrupted=lambda: False)
    as_it_is = None
    if own is not None:
        fresh.extend([own], settings.trials)
        as_it_is = _estimate(goal.measure.of(fresh.columns[own], own), settings.trials)
    compared, confidence = judged(fresh, best, rivals, difference, settings.trials)
    run = _run(model, chosen, best, options)
    columns = _columns(run, reader)
    measured = goal.measure.of(columns, best)
    return Optimised(
        run=run,
        goal=goal,
        decisions=chosen,
        best=best,
        estimate=_estimate(measured, run.accepted),
        requirements=tuple(_result(each, columns, best, run.accepted) for each in requirements),
        as_it_is=as_it_is,
        indifference=difference,
        confidence=confidence,
        rivals=tuple(compared[:_SHOWN]),
        tried=len(seeking.columns),
        trials=seeking.trials.computed + fresh.trials.computed + run.trials,
        how=how,
        ended=ended,
        curve=_curve(seeking) if len(chosen) == 1 and not chosen[0].contents else (),
        search_seed=search_seed,
        lost=fresh.standing(best, settings.trials).lost,
        lost_as_it_is=0.0 if own is None else fresh.standing(own, settings.trials).lost,
        allowed=allowed,
        **_what_is_odd(seeking, run, reader),
        excluded=_excluded(seeking, best, difference),
    )


def _chosen(model: CompiledModel, names: Iterable[str]) -> tuple[Decision, ...]:
    known = {each.name: each for each in model.definitions.decisions}
    if not known:
        hint = "Add a table named xlmc_decisions: Name, Cell, and Low, High and Step, or Values"
        raise DefinitionError("The workbook defines no decision", where=model.workbook.name, hint=hint)
    wanted = dict.fromkeys(name for text in names for name in names_of(text, [*known], "decision"))
    return tuple(known[name] for name in wanted or known)


def _own(model: CompiledModel, decisions: Sequence[Decision]) -> Values | None:
    """Return what the cells of the decisions hold; None where one of them holds no value that it may have."""
    contents = (each.value_of(model.workbook.content(each.cell).value) for each in decisions)
    known = [each for each in contents if each is not None]
    return tuple(known) if len(known) == len(decisions) else None


def _is_candidate(space: Space, values: Values) -> bool:
    numbers = [axis.number(value) for axis, value in zip(space.axes, values, strict=True)]
    return None not in numbers and space.allows(values)


_FIRST: Final = 40
"""Candidates that were tried first, which the indifference is measured by."""


def _difference(tried: Tried, asked: float | None, trials: int) -> float:
    if asked is not None:
        return asked
    n = min(map(tried.length, tried.columns))
    first = [*tried.columns] if tried.length(next(reversed(tried.columns))) == n else [*tried.columns][:_FIRST]
    return _two_digits(indifference_of(tried, first, n, trials))


def _two_digits(number: float) -> float:
    """Round up to two digits, as it is stated."""
    if not number > 0.0:
        return 0.0
    unit = 10.0 ** (math.floor(math.log10(number)) - 1)
    return float(f"{math.ceil(number / unit - 1e-9) * unit:.2g}")


def _run(model: CompiledModel, decisions: Sequence[Decision], best: Values, options: RunOptions) -> RunResult:
    """Run the workbook with the best decisions typed in, which the run then has as its file."""
    pairs = list(zip(decisions, best, strict=True))
    if model.definitions.feeding is not None:  # no file holds all of its workbooks
        typed = {each.cell: each.content(value) for each, value in pairs}
        return run_model(with_plain_sampling(model_with_values(model, typed)), options)
    changes = tuple(Typed(each.cell, each.content(value), named=each.name) for each, value in pairs)
    edited = edited_workbook(model, Scenario(values_text(decisions, best), changes))
    book = read_workbook(edited.data, model.workbook.name, model.workbook.functions)
    return run_model(with_plain_sampling(build_model(book, model.path)), options)


def _columns(run: RunResult, reader: Reader) -> Floats:
    """Return the columns that were asked for, `(columns, n)`, of all trials of a run."""
    rows = np.full((len(reader.columns), run.trials), np.nan)
    for row, (number, text) in zip(rows, reader.columns, strict=True):
        name = run.model.forecasts[number].name
        row[run.trial_index] = run.forecasts[name] if text is None else run.indicator(name, text)
    return rows


def _estimate(measured: Measured, n: int) -> Estimate:
    if measured.pulls is None:
        return Estimate(measured.value, n=n)
    return with_error(measured.value, measured.error, n - 1.0, 0.95, n)


def _result(requirement: Requirement, columns: Floats, best: Values, n: int) -> RequirementResult:
    slack = requirement.measured(columns, best)
    if math.isnan(slack.value):
        chance = 0.0
    elif slack.error:
        chance = NormalDist().cdf(slack.value / slack.error)
    else:
        chance = float(slack.value >= 0.0)
    return RequirementResult(requirement, _estimate(requirement.left.of(columns, best), n), chance)


class _Odd(TypedDict):
    numberless: int
    indifferent: bool
    missing_texts: tuple[tuple[str, str], ...]


def _what_is_odd(tried: Tried, run: RunResult, reader: Reader) -> _Odd:
    """Return what the person may not have meant, as `Optimised` describes it."""
    n = min(map(tried.length, tried.columns))
    known = [tried.standing(each, n) for each in tried.columns]
    goals = {each.goal.value for each in known}
    asked = [(run.model.forecasts[number].name, text) for number, text in reader.columns if text is not None]
    return {
        "numberless": sum(math.isnan(each.goal.value) and not each.excess for each in known),
        "indifferent": len(known) > 1 and len(goals) == 1 and not any(map(math.isnan, goals)),
        "missing_texts": tuple((name, text) for name, text in asked if text not in run.labels.get(name, ())),
    }


def _excluded(tried: Tried, best: Values, indifference: float) -> tuple[Excluded, ...]:
    """Return the candidates that lose too many trials, those first that look better than the best."""
    results = []
    for each in map(tried.standing, tried.columns):
        if each.excess and each.candidate != best:
            looks_better = all(not slack.value < 0.0 for slack in each.slacks)
            looks_better = looks_better and tried.better(best, each.candidate)[0] > indifference
            results.append(Excluded(each.candidate, each.lost, looks_better))
    return tuple(sorted(results, key=lambda each: not each.looks_better))


def _curve(tried: Tried) -> tuple[tuple[float, float, float], ...]:
    """Return the values of a single decision with the goal and its error, ascending; all over the same trials."""
    n = min(map(tried.length, tried.columns))
    known: list[Standing] = [tried.standing(each, n) for each in sorted(tried.columns)]
    return tuple(
        (each.candidate[0], tried.goal.sign * each.goal.value, each.goal.error)
        for each in known
        if math.isfinite(each.goal.value) and math.isfinite(each.goal.error) and not each.excess
    )
