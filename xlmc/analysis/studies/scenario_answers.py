"""The answers of a workbook's scenarios beside its own, over the same random numbers.

Each assumption has its own random stream, so a scenario draws the same uniform numbers as the workbook itself, trial by
trial. What both have in common cancels in a difference, and its standard error, which comes from the differences trial
by trial, is smaller than those of the two numbers (paired, as in `comparison.paired_statistics`). Of Latin hypercubes
and Sobol points whole replicates are compared. Trials that a search for rare ones found belong to no common draw: there
the errors of two numbers add up as those of independent ones.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import hypot
from typing import TYPE_CHECKING, Final
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import DefinitionError, SimulationError, XlmcError
from xlmc.montecarlo.columns import numbers
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.simulation.simulate import BLOCK, OnProgress, run_model
from xlmc.montecarlo.simulation.simulation import RunResult
from xlmc.montecarlo.statistics import Estimate
from xlmc.montecarlo.statistics.estimate import with_error

if TYPE_CHECKING:
    from xlmc.analysis.studies.comparison.paired_statistics import Accepted, Statistic
    from xlmc.montecarlo.definitions.scenarios import Scenario

__all__ = [
    "ForecastAnswer",
    "ScenarioAnswers",
    "answers_of",
    "impossible_scenarios",
    "model_of",
    "refuse_no_scenarios",
    "run_scenario",
    "scenario_answers",
    "scenario_faults",
    "scenario_named",
]


@dataclass(frozen=True, slots=True)
class ForecastAnswer:
    """A forecast in one state of the workbook, in its units.

    Attributes:
        low, high: the ends of its central range.
        above: P(> threshold); None if it has no threshold.
        form: how its numbers are written.
        text: of answers that are texts the most frequent one of the workbook itself, whose share is the mean.
        differences: `mean`, `low`, `high`, `above` -> this less the workbook's own; empty for the workbook itself. A
            scenario may have another threshold or central range: the numbers that stand there are compared.
    """

    forecast: Forecast
    mean: Estimate
    low: Estimate
    high: Estimate
    above: Estimate | None
    differences: Mapping[str, Estimate]
    form: Form = PLAIN
    text: str | None = None

    @property
    def title(self) -> str:
        """`Speed, mph`, above its table; of a share what it is of."""
        of = None if self.text is None else f"share of “{self.text}”"
        return ", ".join(filter(None, (self.forecast.name, self.forecast.units, of)))

    @property
    def has_range(self) -> bool:
        """Whether it has a range: an answer that is a share has none."""
        return self.form.kind is not Kind.YES_NO


@dataclass(frozen=True, slots=True)
class ScenarioAnswers:
    """The answers of a scenario, or of the workbook itself.

    Attributes:
        scenario: None for the workbook itself.
        run: its run.
        acceptance: the share of accepted trials.
        acceptance_difference: less the workbook's own; None for the workbook itself.
        forecasts: in the order of the workbook.
        paired: whether differences are errors of pairs.
    """

    scenario: Scenario | None
    run: RunResult
    acceptance: Estimate
    acceptance_difference: Estimate | None
    forecasts: tuple[ForecastAnswer, ...]
    paired: bool

    @property
    def name(self) -> str:
        """The scenario's name; `as it is` for the workbook itself."""
        return "as it is" if self.scenario is None else self.scenario.name

    @property
    def warnings(self) -> list[str]:
        """Why its answers must not be used as they are."""
        return self.run.warnings_of_trials if self.scenario else self.run.warnings


@dataclass(frozen=True, slots=True)
class _AllAnswers:
    """The answers of the scenarios that are possible, and why each of the others is not, by its name."""

    answers: tuple[ScenarioAnswers, ...]
    impossible: Mapping[str, str]


_ANSWERS: Final[WeakKeyDictionary[RunResult, _AllAnswers]] = WeakKeyDictionary()
"""Terminal, sheets, page and JSON of one run want the same."""


def scenario_answers(
    run: RunResult, *, jobs: int = 1, tell: Callable[[str], None] | None = None
) -> tuple[ScenarioAnswers, ...]:
    """Return the answers of the workbook itself, then of each scenario; none where the run was made without them.

    A scenario that is not possible has none; `impossible_scenarios` says why. The others are run with the settings of
    the run: until as many trials are accepted, where the run waited for these, else for as many trials.

    Args:
        run: of the workbook itself.
        jobs: threads or processes.
        tell: called before every run with what it is for.

    Raises:
        DefinitionError: the workbook defines no scenario.
    """
    if not run.settings.scenarios:
        return ()
    from xlmc.montecarlo.definitions.scenarios import Tabulated  # few runs have scenarios

    if run not in _ANSWERS:
        _ANSWERS[run] = result = _answers(run, jobs, tell)
        run.take_tabulated(
            {
                change.number: each.run
                for each in result.answers
                if each.scenario is not None
                for change in each.scenario.changes
                if isinstance(change, Tabulated) and len(each.scenario.changes) == 1
            }
        )
    return _ANSWERS[run].answers


def impossible_scenarios(run: RunResult) -> Mapping[str, str]:
    """Return why scenarios of a run have no answers, by their names; see `scenario_answers`."""
    return _ANSWERS[run].impossible if scenario_answers(run) else {}


def refuse_no_scenarios(model: CompiledModel) -> None:
    """Refuse a workbook without scenarios where they are asked for.

    Raises:
        DefinitionError: it has none.
    """
    if not model.definitions.scenarios:
        hint = "Add a table named xlmc_scenarios: a row for each scenario, a column for each thing that it changes"
        raise DefinitionError("The workbook defines no scenario", where=model.workbook.name, hint=hint)


def scenario_faults(model: CompiledModel) -> dict[str, XlmcError]:
    """Return why scenarios of a workbook are not possible, by their names, without running any."""
    result: dict[str, XlmcError] = {}
    for scenario in model.definitions.scenarios:
        try:
            model_of(model, scenario)
        except XlmcError as error:
            result[scenario.name] = error
    return result


def model_of(model: CompiledModel, scenario: Scenario | str) -> CompiledModel:
    """Return the model of the workbook in a scenario, given itself or by its name.

    Raises:
        SimulationError: there is no scenario of this name.
        DefinitionError, FormulaError: it is not possible.
    """
    from xlmc.montecarlo.model.applied_changes import applied

    scenario = scenario_named(model, scenario)
    try:
        result = applied(model, scenario.changes)
        if [each.name for each in result.forecasts] != [each.name for each in model.forecasts]:
            hint = "a scenario has the same forecasts as the workbook: change other cells"
            raise DefinitionError("the change alters which forecasts there are", hint=hint)
        return result
    except XlmcError as error:
        message = f"In the scenario {scenario.name!r}: {error.message}"
        where = scenario.row if error.where is None else error.where
        raise type(error)(message, where=where, hint=error.hint) from error


def scenario_named(model: CompiledModel, scenario: Scenario | str) -> Scenario:
    """Return the scenario of this name, or itself.

    Raises:
        SimulationError: there is no scenario of this name.
    """
    if not isinstance(scenario, str):
        return scenario
    known = {name_key(each.name): each for each in model.definitions.scenarios}
    if name_key(scenario) not in known:
        names = ", ".join(repr(each.name) for each in known.values())
        hint = f"there are {names}" if names else "the workbook has no table xlmc_scenarios"
        raise SimulationError(f"there is no scenario {scenario!r}", where=model.workbook.name, hint=hint)
    return known[name_key(scenario)]


def _answers(run: RunResult, jobs: int, tell: Callable[[str], None] | None) -> _AllAnswers:
    refuse_no_scenarios(run.model)
    answers, impossible = [answers_of(run, None, run)], dict[str, str]()
    for scenario in run.model.definitions.scenarios:
        if tell is not None:
            tell(scenario.name)
        try:
            result = run_scenario(model_of(run.model, scenario), run, jobs=jobs)
        except XlmcError as error:
            impossible[scenario.name] = str(error).partition("\n")[0]
        else:
            answers.append(answers_of(result, scenario, run))
    return _AllAnswers(tuple(answers), impossible)


def run_scenario(
    model: CompiledModel,
    base: RunResult,
    *,
    jobs: int = 1,
    progress: OnProgress | None = None,
    pieces: int = BLOCK,
    in_memory: int | None = None,
) -> RunResult:
    """Run the model of a scenario as the workbook itself was run; see `run_model`.

    Raises:
        SimulationError: it cannot be run.
    """
    options = replace(base.repeating, scenarios=False, jobs=jobs, keep_inputs=0, in_memory=in_memory)
    return run_model(model, options, progress=progress, pieces=pieces)


def answers_of(run: RunResult, scenario: Scenario | None, base: RunResult) -> ScenarioAnswers:
    """Return the answers of a scenario's run, and how far they are from those of the workbook itself.

    Args:
        run: of the scenario.
        scenario: None for the workbook itself.
        base: the run of the workbook itself.
    """
    paired = _share_trials(run, base)
    return ScenarioAnswers(
        scenario=scenario,
        run=run,
        acceptance=run.acceptance,
        acceptance_difference=None if scenario is None else _acceptance_difference(base, run, paired=paired),
        forecasts=tuple(_forecast(run, base, each, scenario is not None, paired) for each in run.model.forecasts),
        paired=paired,
    )


def _share_trials(first: RunResult, second: RunResult) -> bool:
    """Whether trials, or replicates, of the same number were drawn from the same uniforms."""
    plain = first.rare is None and second.rare is None
    return plain and first.plan.size == second.plan.size


def _forecast(run: RunResult, base: RunResult, forecast: Forecast, differs: bool, paired: bool) -> ForecastAnswer:
    result, text = run.results[forecast.name], next(iter(base.results[forecast.name].categories), None)
    if text is not None:
        result = run.saying(forecast.name, text)
    low, high = result.central()
    above = None if forecast.threshold is None else result.probability_above(forecast.threshold)
    results = {"mean": result.mean, "low": low, "high": high} | ({} if above is None else {"above": above})
    changes = _differences(run, base, forecast, results, paired=paired) if differs else {}
    form = result.form
    if base.results[forecast.name].form.kind is Kind.YES_NO and np.isin(numbers(result.column), (0.0, 1.0)).all():
        form = base.results[forecast.name].form  # a formula that is the same in all trials says no kind
    return ForecastAnswer(forecast, result.mean, low, high, above, changes, form, text)


def _differences(
    run: RunResult, base: RunResult, forecast: Forecast, result: Mapping[str, Estimate], *, paired: bool
) -> dict[str, Estimate]:
    """Return the difference of each number from the workbook's own."""
    from xlmc.analysis.studies.comparison.paired_statistics import Accepted, Pair

    own, text = base.results[forecast.name], next(iter(base.results[forecast.name].categories), None)
    columns = [each.forecasts[forecast.name] for each in (base, run)]
    if text is not None:
        own = base.saying(forecast.name, text)
        columns = [each.indicator(forecast.name, text) for each in (base, run)]
    kinds = {own.kind, own.kind if text is not None else run.results[forecast.name].kind}
    kind = own.kind if len(kinds) == 1 else Kind.NUMBER
    low, high = own.central()
    theirs = {"mean": own.mean, "low": low, "high": high}
    if own.definition.threshold is not None:
        theirs["above"] = own.probability_above(own.definition.threshold)
    both = [key for key in result if key in theirs]
    if not paired:
        return {key: _independent(theirs[key], result[key]) for key in both}
    pairs = zip((base, run), columns, strict=True)
    first, second = (Accepted.of(each.trial_index, column, kind) for each, column in pairs)
    pair = Pair(first, second, run.plan.size, max(base.plan.replicates, run.plan.replicates))
    before, after = _statistics(own.definition), _statistics(forecast)
    return {key: pair.difference(before[key](first), after[key](second)) for key in both}


def _statistics(forecast: Forecast) -> dict[str, Callable[[Accepted], Statistic]]:
    from xlmc.analysis.studies.comparison.paired_statistics import mean_of, quantile_of, share_above

    tail = (1.0 - forecast.central) / 2.0
    threshold = forecast.threshold
    return {
        "mean": mean_of,
        "low": lambda run: quantile_of(run, tail),
        "high": lambda run: quantile_of(run, 1.0 - tail),
        "above": lambda run: share_above(run, np.inf if threshold is None else threshold),
    }


def _independent(first: Estimate, second: Estimate) -> Estimate:
    value = second.value - first.value
    if first.error is None or second.error is None:
        return Estimate(value, n=min(first.n, second.n))
    n = min(first.n, second.n)
    return with_error(value, hypot(first.error, second.error), n - 1.0, 0.95, n)


def _acceptance_difference(first: RunResult, second: RunResult, *, paired: bool) -> Estimate:
    """Return the second's share of accepted trials less the first's."""
    mine, theirs = first.acceptance, second.acceptance
    if not paired or mine.error is None or theirs.error is None:
        return _independent(mine, theirs)
    size = first.plan.size or 1
    count = -(-max(first.trials, second.trials) // size)
    if first.plan.size:
        units = _pulls(second, count, size) - _pulls(first, count, size)
        square = float(np.sum(units * units)) * count / max(count - 1, 1)
    else:
        square = _square_of_trials(first, second)
    n = min(first.trials, second.trials)
    return with_error(theirs.value - mine.value, square**0.5, (count if first.plan.size else n) - 1.0, 0.95, n)


def _pulls(run: RunResult, count: int, size: int) -> NDArray[np.float64]:
    """`(count,)` how far each replicate pulls the share of accepted trials."""
    share = run.accepted / run.trials
    accepted = np.bincount(run.trial_index // size, minlength=count)
    return np.asarray((accepted - share * size) / run.trials)


def _square_of_trials(first: RunResult, second: RunResult) -> float:
    """Return the sum of the squared differences of the pulls of single trials; of the longer run the last have no
    partner.

    A trial pulls the share p of n trials by (1 - p)/n where it is accepted, and by -p/n where it is not.
    """
    shorter, longer = sorted((first, second), key=lambda run: run.trials)
    n, more = shorter.trials, longer.trials - shorter.trials
    p, q = shorter.accepted / shorter.trials, longer.accepted / longer.trials
    within = longer.trial_index[longer.trial_index < n]
    both = int(np.intersect1d(shorter.trial_index, within, assume_unique=True).size)
    a, b, m = shorter.accepted - both, within.size - both, longer.trials
    in_both = {(1, 1): both, (1, 0): a, (0, 1): b, (0, 0): n - both - a - b}
    square = sum(count * ((i - p) / n - (j - q) / m) ** 2 for (i, j), count in in_both.items())
    late = longer.accepted - within.size
    return float(square + late * ((1 - q) / m) ** 2 + (more - late) * (q / m) ** 2)
