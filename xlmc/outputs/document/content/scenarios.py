"""Scenarios: the answers of each beside the workbook's own, and how far they lie apart."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

from xlmc.analysis.studies.scenario_answers import impossible_scenarios, scenario_answers
from xlmc.montecarlo.number_text import count_text, percent
from xlmc.montecarlo.simulation.simulation import FEW
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import NONE
from xlmc.outputs.document.measured import Measured
from xlmc.outputs.document.parts import Block, Content, Paragraph, Table

if TYPE_CHECKING:
    from xlmc.analysis.studies.scenario_answers import ForecastAnswer, ScenarioAnswers
    from xlmc.outputs.document.material import Material

__all__ = ["answer_heads", "answer_rows", "scenario_blocks", "section"]

_POINTS: Final = "Difference, points"
"""The heading of a difference of two shares, in percentage points."""


def scenario_blocks(
    answers: Sequence[ScenarioAnswers], impossible: Mapping[str, str], names: Collection[str] | None = None
) -> Iterator[Block]:
    """Yield what each scenario changes and how much is accepted; then its answers, a table a forecast.

    Args:
        answers: of the workbook itself, then of each scenario; empty where none was run.
        impossible: why a scenario has no answers, by its name.
        names: of the forecasts to show; None for all.
    """
    if not answers:
        return
    for each in answers[1:]:
        for warning in each.warnings:
            yield Paragraph(f"Do not use the answers of {each.name!r} as they are: {warning}", "warning")
    rows: list[tuple[Content, ...]] = [_accepted(each) for each in answers]
    rows += [(name, "", Measured(None), Measured(None), f"Not possible: {why}") for name, why in impossible.items()]
    yield Table(
        "",
        ("Scenario", "Accepted", "Share", _POINTS, "What is changed"),
        tuple(rows),
        widths=(1.7, 1.0, 1.6, 1.5, 3.6),
        caption="Scenarios: what is changed, and how many trials are accepted.",
        spans=(1, 1, 1, 1, 7),
    )
    for index, answer in enumerate(answers[0].forecasts):
        if names is None or answer.forecast.name in names:
            heads = answer_heads(answers, index)
            widths = (1.8, *[1.4] * (len(heads) - 1))
            yield Table("", heads, tuple(answer_rows(answers, index)), widths=widths, caption=f"{answer.title}.")
    for sentence in _sentences(answers):
        yield Paragraph(sentence, "small")


def _accepted(each: ScenarioAnswers) -> tuple[Content, ...]:
    return (
        each.name,
        cells.count(each.run.accepted),
        Measured(each.acceptance, "share"),
        Measured(each.acceptance_difference, "points"),
        _changes(each),
    )


def _changes(each: ScenarioAnswers) -> str:
    if each.scenario is None:
        return NONE
    from xlmc.analysis.results.statements.scenarios_in_words import changes_text  # few runs have scenarios

    note = f" ({each.scenario.note})" if each.scenario.note else ""
    return f"{changes_text(each.scenario, each.run.model.definitions)}{note}"


def answer_heads(answers: Sequence[ScenarioAnswers], index: int) -> tuple[str, ...]:
    """Return the headings of the table of the forecast at `index`."""
    states = [each.forecasts[index] for each in answers]
    above = _above_head(states)
    heads = ["Scenario", *(heading for pair in _pairs(states) for heading in pair)]
    return (*heads, *([above, _POINTS] if above else []))


def answer_rows(answers: Sequence[ScenarioAnswers], index: int) -> Iterator[tuple[Content, ...]]:
    """Yield a row for the workbook itself and for each scenario, of the forecast at `index`."""
    states = [each.forecasts[index] for each in answers]
    ranges, above = _has_ranges(states), bool(_above_head(states))
    for each, answer in zip(answers, states, strict=True):
        row: list[Content] = [each.name]
        numbers = (("mean", answer.mean), ("low", answer.low), ("high", answer.high))
        for key, value in numbers if ranges else numbers[:1]:
            change = answer.differences.get(key)
            if answer.has_range:
                row += [Measured(value, form=answer.form, look="answer"), Measured(change, "change", answer.form)]
            elif key == "mean":
                row += [Measured(value, "share", look="answer"), Measured(change, "points", look="answer")]
            else:
                row += [Measured(None)] * 2
        if above:
            row += [Measured(answer.above, "share"), Measured(answer.differences.get("above"), "points")]
        yield tuple(row)


def _pairs(states: Sequence[ForecastAnswer]) -> list[tuple[str, str]]:
    """Return the headings of each number of a forecast in all states, and of its difference: of its mean and central
    range, for which states may ask differently, or of the one share that an answer of no number has.
    """
    if not _has_ranges(states):
        return [("Probability" if states[0].text is None else "Share", _POINTS)]
    shares = {percent(each.forecast.central) for each in states}
    names = ["Mean", f"{shares.pop()} range from" if len(shares) == 1 else "Central range from", "to"]
    return [(name, "Difference") for name in names]


def _has_ranges(states: Sequence[ForecastAnswer]) -> bool:
    """Whether the answers of a forecast are numbers in any state."""
    return any(each.has_range for each in states)


def _above_head(states: Sequence[ForecastAnswer]) -> str:
    """Return the heading of its probability above a threshold; empty if no state has one."""
    limits = {each.forecast.threshold for each in states if each.forecast.threshold is not None}
    if not limits:
        return ""
    return f"Above {states[0].form.number(limits.pop())}" if len(limits) == 1 else "Above threshold"


def _sentences(answers: Sequence[ScenarioAnswers]) -> Iterator[str]:
    """Yield the sentences that say what the differences and their errors are."""
    yield "Each scenario is a run of its own, with other contents in some cells. “As it is” is the workbook itself."
    few = [f"{each.name!r} ({count_text(each.run.accepted)})" for each in answers if 0 < each.run.accepted < FEW]
    if few:
        yield f"Few trials were accepted: {', '.join(few)}. Errors of means and differences can be too small there."
    yield from _different_options(answers)
    yield "Differences are those to the workbook as it is: a positive one means that the scenario gives more."
    if all(each.paired for each in answers):
        yield (
            "All runs draw the same random numbers: each assumption has its own stream. What they have in common "
            "cancels in a difference, so that its ± is mostly smaller than those of the two numbers."
        )
    else:
        yield (
            "Where accepted trials are rare, the runs share none of them: the ± of a difference adds up those of both "
            "numbers, as the root of the sum of their squares."
        )


def _different_options(answers: Sequence[ScenarioAnswers]) -> Iterator[str]:
    """Yield which thresholds and central ranges scenarios change."""
    for index, own in enumerate(answers[0].forecasts):
        name, states = own.forecast.name, [(each.name, each.forecasts[index].forecast) for each in answers]
        if len({each.threshold for _, each in states}) > 1:
            limits = [
                (state, "none" if each.threshold is None else own.form.number(each.threshold)) for state, each in states
            ]
            messages = [f"{state!r} {limit}" for state, limit in limits]
            yield f"Thresholds of {name!r}: {', '.join(messages)}."
        if len({each.central for _, each in states}) > 1:
            messages = [f"{state!r} {percent(each.central)}" for state, each in states]
            yield f"Central ranges of {name!r}: {', '.join(messages)}."


def section(material: Material) -> Iterator[Block]:
    """Yield the answers of scenarios."""
    answers = scenario_answers(material.simulation)
    return scenario_blocks(answers, impossible_scenarios(material.simulation), material.forecasts)
