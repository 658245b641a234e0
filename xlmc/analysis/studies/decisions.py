"""A table of decisions: the answers for every combination of values, over the same random numbers.

A combination is a scenario: the values are typed into the cells of the decisions, and the workbook is run as it was run
itself. So differences between combinations are differences of pairs of trials, and their errors are small.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final, TypedDict

from xlmc.analysis.studies.comparison.variations import names_of
from xlmc.analysis.studies.scenario_answers import ForecastAnswer, ScenarioAnswers, answers_of, model_of, run_scenario
from xlmc.analysis.studies.shown import Shown
from xlmc.analysis.studies.steps import Steps
from xlmc.errors import DefinitionError, SimulationError, XlmcError
from xlmc.montecarlo.definitions.definitions import Decision
from xlmc.montecarlo.definitions.scenarios import Scenario, Typed
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.number_text import count_text
from xlmc.montecarlo.simulation.simulate import simulate
from xlmc.montecarlo.simulation.simulation import RunResult
from xlmc.montecarlo.statistics import Estimate

__all__ = [
    "MOST_COMBINATIONS",
    "MOST_DECISIONS",
    "Best",
    "Combination",
    "DecideArguments",
    "Decided",
    "decide",
    "of_forecast",
    "values_text",
]

MOST_DECISIONS: Final = 3
MOST_COMBINATIONS: Final = 1_000
_SURE: Final = 3.0
"""Errors by which two means must differ for the one to be called the larger, as in `xlmc compare`."""

Tell = Callable[[str], None]


class DecideArguments(TypedDict, total=False):
    """The arguments of `decide` beside the model and the names."""

    trials: int | None
    seed: int | None
    sampling: str | None
    engine: str | None
    jobs: int
    tell: Tell | None


@dataclass(frozen=True, slots=True)
class Combination:
    """One value of each decision, and the answers with them.

    Attributes:
        values: in the order of the decisions.
        answers: with differences to the workbook as it is.
    """

    values: tuple[float, ...]
    answers: ScenarioAnswers


@dataclass(frozen=True, slots=True)
class Best:
    """The combination with the largest, or the smallest, mean of a forecast.

    Attributes:
        mean: of the forecast.
        next: the combination after it; None where there is no other.
        ahead: by how much its mean lies beyond that of the next, from pairs of trials; None likewise.
    """

    combination: Combination
    mean: Estimate
    next: Combination | None
    ahead: Estimate | None

    @property
    def is_sure(self) -> bool:
        """Whether the means of the two differ by three errors or more, or nothing else was tried."""
        if self.ahead is None:
            return True
        return self.ahead.error is not None and abs(self.ahead.value) > 0.0 and not self._is_in_doubt(self.ahead)

    @staticmethod
    def _is_in_doubt(ahead: Estimate) -> bool:
        return abs(ahead.value) < _SURE * (ahead.error or 0.0)


@dataclass(frozen=True, slots=True, repr=False)
class Decided(Shown):
    """The answers for all combinations.

    Attributes:
        run: the workbook as it is.
        base: its answers.
        decisions: those that were varied.
        combinations: of their values, the first decision's changing slowest.
        impossible: values -> why the workbook cannot be run with them.
        ended: why it ended before all combinations were run; empty if it did not.
    """

    run: RunResult
    base: ScenarioAnswers
    decisions: tuple[Decision, ...]
    combinations: tuple[Combination, ...]
    impossible: dict[tuple[float, ...], str]
    ended: str = ""

    def does_matter(self, forecast: str) -> bool:
        """Whether a number of a forecast's answer, which tables show, is not that of the workbook as it is with every
        combination.
        """
        states = (self.base, *(each.answers for each in self.combinations))
        result = {_numbers(of_forecast(each, forecast)) for each in states}
        return len(result) > 1

    def losing(self, forecast: str) -> list[Combination]:
        """Return the combinations with which errors take so many trials from a forecast that its mean says little."""
        return [each for each in self.combinations if each.answers.run.loses_too_many(forecast)]

    def best(self, forecast: str, *, least: bool = False) -> Best | None:
        """Return the combination with the largest mean of a forecast, or the least; None if none has a number.

        Those that lose too many trials to errors are not asked (`losing`).
        """
        known = [
            (each, _mean(each, forecast)) for each in self.combinations if not each.answers.run.loses_too_many(forecast)
        ]
        known = [(each, mean) for each, mean in known if not math.isnan(mean.value)]
        ordered = sorted(known, key=lambda pair: pair[1].value, reverse=not least)
        if not ordered:
            return None
        (first, mean), *rest = ordered
        if not rest:
            return Best(first, mean, None, None)
        second = rest[0][0]
        apart = answers_of(first.answers.run, first.answers.scenario, second.answers.run)
        answer = next(each for each in apart.forecasts if each.forecast.name == forecast)
        return Best(first, mean, second, answer.differences["mean"])


def _mean(combination: Combination, forecast: str) -> Estimate:
    return of_forecast(combination.answers, forecast).mean


def _numbers(answer: ForecastAnswer) -> tuple[str, ...]:
    """Return the numbers of an answer as texts, of which no number is one, too."""
    above = () if answer.above is None else (answer.above,)
    return tuple(repr(each.value) for each in (answer.mean, answer.low, answer.high, *above))


def of_forecast(answers: ScenarioAnswers, forecast: str) -> ForecastAnswer:
    """Return the answers of a forecast."""
    return next(each for each in answers.forecasts if each.forecast.name == forecast)


def decide(
    model: CompiledModel,
    names: Iterable[str] = (),
    *,
    trials: int | None = None,
    seed: int | None = None,
    sampling: str | None = None,
    engine: str | None = None,
    jobs: int = 1,
    tell: Tell | None = None,
) -> Decided:
    """Run every combination of the values of one to three decisions, over the same random numbers.

    Args:
        model: of a workbook with a table `xlmc_decisions`; it stays as it is.
        names: of decisions, joined by commas, `*` for any letters; all where there are none.
        trials: of each run; as in `Model.simulate`, like what follows.
        seed: of each run.
        sampling: of each run.
        engine: of each run.
        jobs: of each run.
        tell: called before every run with what it is for.

    Raises:
        DefinitionError: the workbook has no decisions.
        SimulationError: there is no decision of a name, or there are too many decisions or combinations.
    """
    decisions = _chosen(model, names)
    count = math.prod(len(each.values) for each in decisions)
    if count > MOST_COMBINATIONS:
        message = (
            f"The decisions have {count_text(count)} combinations, and a table at most {count_text(MOST_COMBINATIONS)}"
        )
        raise SimulationError(message, hint="Give larger steps in xlmc_decisions, or fewer decisions")
    combinations: list[Combination] = []
    impossible: dict[tuple[float, ...], str] = {}
    with Steps(tell) as steps:
        steps.expect(count + 1)
        steps.begin("the workbook as it is")
        run = simulate(model, trials=trials, seed=seed, sampling=sampling, engine=engine, jobs=jobs)
        steps.can_end()
        for values in steps.each(product(*(each.values for each in decisions))):
            scenario = _scenario(decisions, values)
            steps.begin(scenario.name)
            try:
                answers = answers_of(run_scenario(model_of(model, scenario), run, jobs=jobs), scenario, run)
            except XlmcError as error:
                impossible[values] = str(error).partition("\n")[0]
            else:
                combinations.append(Combination(values, answers))
        ended = steps.why_ended
    return Decided(run, answers_of(run, None, run), decisions, tuple(combinations), impossible, ended)


def _chosen(model: CompiledModel, names: Iterable[str]) -> tuple[Decision, ...]:
    known = {each.name: each for each in model.definitions.decisions}
    if not known:
        hint = "Add a table named xlmc_decisions: Name, Cell, and Low, High and Step, or Values"
        raise DefinitionError("The workbook defines no decision", where=model.workbook.name, hint=hint)
    wanted = dict.fromkeys(name for text in names for name in names_of(text, [*known], "decision"))
    chosen = tuple(known[name] for name in wanted or known)
    if len(chosen) > MOST_DECISIONS:
        message = f"{len(chosen)} decisions were asked for, and a table has {MOST_DECISIONS} at most"
        raise SimulationError(message, hint=f"Name up to {MOST_DECISIONS} of {', '.join(map(repr, known))}")
    return chosen


def values_text(decisions: Sequence[Decision], values: Sequence[float]) -> str:
    """Write values of decisions: `Order = 40, Colour = red`."""
    return ", ".join(f"{each.name} = {each.shown(value)}" for each, value in zip(decisions, values, strict=True))


def _scenario(decisions: Sequence[Decision], values: Sequence[float]) -> Scenario:
    pairs = list(zip(decisions, values, strict=True))
    changes = tuple(Typed(each.cell, each.content(value), named=each.name) for each, value in pairs)
    return Scenario(values_text(decisions, values), changes)
