"""The sheet Scenarios: the answers of each scenario beside the workbook's own, and how far they lie apart."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.statements.in_words import changes_text
from xlmc.analysis.studies.scenario_answers import (
    ForecastAnswer,
    ScenarioAnswers,
    impossible_scenarios,
    scenario_answers,
)
from xlmc.montecarlo.simulation.simulation import FEW
from xlmc.montecarlo.statistics import Estimate
from xlmc.montecarlo.statistics.number_text import count_text
from xlmc.outputs.sheets import cells
from xlmc.outputs.sheets.cells import BLANK, Shown
from xlmc.outputs.summary import percent

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.forms import Form
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.page import Page

__all__ = [
    "POINTS",
    "WIDTHS",
    "above_head",
    "answer_pairs",
    "has_ranges",
    "scenario_sentences",
    "scenario_warnings",
    "write_scenario_tables",
    "write_scenarios",
]

WIDTHS = (30, *[11] * 16)

POINTS: Final = "Difference, points"
"""The heading of a difference of two shares, in percentage points."""

_LAST: Final = 12
_CHANGES: Final = 6
"""The column that what a scenario changes begins in; it reaches to the last one."""


def write_scenarios(page: Page, simulation: RunResult) -> None:
    """Write the sheet."""
    name = simulation.model.workbook.name
    found = scenario_answers(simulation)
    page.title("Scenarios", f"{name}, seed {simulation.settings.seed}: the workbook as it is, and with changes")
    write_scenario_tables(page, found, impossible_scenarios(simulation))
    page.set_up_printing(name)


def write_scenario_tables(page: Page, found: Sequence[ScenarioAnswers], impossible: Mapping[str, str]) -> None:
    """Write what each scenario changes and how much is accepted; then its answers, a table a forecast.

    Args:
        page: where to.
        found: of the workbook itself, then of each scenario.
        impossible: why a scenario has no answers, by its name.
    """
    for warning in scenario_warnings(found):
        page.wide(warning, "warning", _LAST)
    page.heading("What is changed, and how many trials are accepted")
    heads = ("Scenario", "Accepted", "Share", "±", POINTS, "±", "What is changed")
    starts = range(_CHANGES + 1)
    page.line([Shown(head, look="header left" if head == heads[0] else "header") for head in heads], starts, _LAST)
    for each in found:
        page.line([*_accepted(each), Shown(_changes(each))], starts, _LAST)
    for name, why in impossible.items():
        page.line([Shown(name, look="name"), *[BLANK] * (_CHANGES - 1), Shown(f"Not possible: {why}")], starts, _LAST)
    for index, forecast in enumerate(found[0].forecasts):
        page.heading(forecast.title)
        states = [each.forecasts[index] for each in found]
        above = above_head(states)
        answers = [head for pair in answer_pairs(states) for name in pair for head in (name, "±")]
        shares = [above, "±", POINTS, "±"] if above else []
        page.table(
            ["Scenario", *answers, *shares],
            [_answers(each.name, each.forecasts[index], has_ranges(states), bool(above)) for each in found],
        )
    page.row += 1
    for sentence in scenario_sentences(found):
        page.wide(sentence, "remark", _LAST)


def scenario_warnings(found: Sequence[ScenarioAnswers]) -> list[str]:
    """Why answers of scenarios must not be used."""
    names = ((each.name, warning) for each in found[1:] for warning in each.warnings)
    return [f"Do not use the answers of {name!r} as they are: {warning}" for name, warning in names]


def scenario_sentences(found: Sequence[ScenarioAnswers]) -> Iterator[str]:
    """Yield the sentences that say what the differences and their errors are."""
    few = [f"{each.name!r} ({count_text(each.run.accepted)})" for each in found if 0 < each.run.accepted < FEW]
    if few:
        yield f"Few trials were accepted: {', '.join(few)}. Errors of means and differences can be too small there."
    yield from _different_wishes(found)
    yield "Differences are those to the workbook as it is: a positive one means that the scenario gives more."
    if all(each.paired for each in found):
        yield (
            "All runs draw the same random numbers: each assumption has its own stream. What they have in common "
            "cancels in a difference, so that its ± is mostly smaller than those of the two numbers."
        )
    else:
        yield (
            "Where accepted trials are rare, the runs share none of them: the ± of a difference adds up those of both "
            "numbers, as the root of the sum of their squares."
        )


def _changes(each: ScenarioAnswers) -> str:
    if each.scenario is None:
        return "–"
    note = f" ({each.scenario.note})" if each.scenario.note else ""
    return f"{changes_text(each.scenario)}{note}"


def _accepted(each: ScenarioAnswers) -> list[Shown]:
    change = [BLANK, BLANK] if each.acceptance_difference is None else cells.share(each.acceptance_difference)
    return [Shown(each.name, look="name"), cells.count(each.run.accepted), *cells.share(each.acceptance), *change]


def answer_pairs(states: Sequence[ForecastAnswer]) -> list[tuple[str, str]]:
    """Return the headings of each number of a forecast in all states, and of its difference: of its mean and central
    range, for which states may ask differently, or of the one share that an answer of no number has.
    """
    if not has_ranges(states):
        return [("Probability" if states[0].text is None else "Share", POINTS)]
    shares = {percent(each.forecast.central) for each in states}
    names = ["Mean", f"{shares.pop()} range from" if len(shares) == 1 else "Central range from", "to"]
    return [(name, "Difference") for name in names]


def has_ranges(states: Sequence[ForecastAnswer]) -> bool:
    """Whether the answers of a forecast are numbers in any state."""
    return any(each.has_range for each in states)


def above_head(states: Sequence[ForecastAnswer]) -> str:
    """Return the heading of its probability above a threshold; empty if no state has one."""
    thresholds = {each.forecast.threshold for each in states if each.forecast.threshold is not None}
    form = states[0].form
    return (
        ""
        if not thresholds
        else f"Above {form.number(thresholds.pop())}"
        if len(thresholds) == 1
        else "Above threshold"
    )


def _different_wishes(found: Sequence[ScenarioAnswers]) -> Iterator[str]:
    """Which thresholds and central ranges scenarios change."""
    for index, own in enumerate(found[0].forecasts):
        name, states = own.forecast.name, [(each.name, each.forecasts[index].forecast) for each in found]
        if len({each.threshold for _, each in states}) > 1:
            limits = [
                (state, "none" if each.threshold is None else own.form.number(each.threshold)) for state, each in states
            ]
            said = [f"{state!r} {limit}" for state, limit in limits]
            yield f"Thresholds of {name!r}: {', '.join(said)}."
        if len({each.central for _, each in states}) > 1:
            said = [f"{state!r} {percent(each.central)}" for state, each in states]
            yield f"Central ranges of {name!r}: {', '.join(said)}."


def _answers(name: str, answer: ForecastAnswer, ranges: bool, above: bool) -> list[Shown]:
    found = [Shown(name, look="name")]
    numbers = (("mean", answer.mean), ("low", answer.low), ("high", answer.high))
    for key, value in numbers if ranges else numbers[:1]:
        change = answer.differences.get(key)
        if not answer.has_range:
            both = [value, change] if key == "mean" else [None, None]
            found += [
                cell for each in both for cell in ([BLANK, BLANK] if each is None else cells.share(each, "answer"))
            ]
            continue
        found += [*cells.estimate(value, "answer", form=answer.form), *_difference(change, answer.form)]
    for share in (answer.above, answer.differences.get("above")) if above else ():
        found += [BLANK, BLANK] if share is None else cells.share(share)
    return found


def _difference(found: Estimate | None, form: Form) -> list[Shown]:
    return [BLANK, BLANK] if found is None else cells.estimate(found, form=form, spread=True)
