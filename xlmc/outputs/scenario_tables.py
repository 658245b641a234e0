"""The answers of scenarios in tables of text: for the terminal and the document to hand over."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.statements.in_words import changes_text
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.statistics import format_estimate
from xlmc.montecarlo.statistics.number_text import count_text
from xlmc.outputs.sheets.scenarios_sheet import POINTS, above_head, answer_pairs, has_ranges
from xlmc.outputs.summary import share_text

if TYPE_CHECKING:
    from xlmc.analysis.studies.scenario_answers import ForecastAnswer, ScenarioAnswers
    from xlmc.montecarlo.statistics import Estimate

__all__ = ["SCENARIO_HEADS", "answer_heads", "answer_rows", "change_text", "scenario_rows"]

SCENARIO_HEADS: Final = ("Scenario", "Accepted", "Share", POINTS, "What is changed")


def scenario_rows(found: Sequence[ScenarioAnswers], impossible: Mapping[str, str]) -> list[tuple[str, ...]]:
    """Yield a row for the workbook itself and for each scenario, under `SCENARIO_HEADS`.

    Args:
        found: of the workbook itself, then of the scenarios.
        impossible: why a scenario has no answers, by its name.
    """
    rows = [
        (
            each.name,
            count_text(each.run.accepted),
            share_text(each.acceptance),
            change_text(each.acceptance_difference, share=True),
            "" if each.scenario is None else changes_text(each.scenario),
        )
        for each in found
    ]
    return [*rows, *((name, "", "", "", f"Not possible: {why}") for name, why in impossible.items())]


def answer_heads(found: Sequence[ScenarioAnswers], index: int) -> list[str]:
    """Return the headings of the table of the forecast at `index`."""
    states = [each.forecasts[index] for each in found]
    above = above_head(states)
    heads = ["Scenario", *(heading for pair in answer_pairs(states) for heading in pair)]
    return [*heads, above, POINTS] if above else heads


def answer_rows(found: Sequence[ScenarioAnswers], index: int) -> list[tuple[str, ...]]:
    """Yield a row for the workbook itself and for each scenario, of the forecast at `index`, under its
    `answer_heads`.
    """
    states = [each.forecasts[index] for each in found]
    ranges, above = has_ranges(states), bool(above_head(states))
    return [(each.name, *_cells(each.forecasts[index], ranges, above)) for each in found]


def _cells(answer: ForecastAnswer, ranges: bool, above: bool) -> list[str]:
    found = []
    form = answer.form
    numbers = (("mean", answer.mean), ("low", answer.low), ("high", answer.high))
    for key, value in numbers if ranges else numbers[:1]:
        change = answer.differences.get(key)
        if key == "mean" and not answer.has_range:
            found += [share_text(value), change_text(change, share=True)]
        elif not answer.has_range:
            found += ["", ""]
        elif form.kind is Kind.DATE or change is None:
            sign = "+" if change is not None and change.value > 0 else ""
            found += [form.estimate(value), "" if change is None else f"{sign}{form.spread(change)}"]
        else:
            found += [form.estimate(value), f"{'+' if change.value > 0 else ''}{form.estimate(change)}"]
    if above:
        share = "" if answer.above is None else share_text(answer.above)
        found += [share, change_text(answer.differences.get("above"), share=True)]
    return found


def change_text(found: Estimate | None, *, share: bool = False) -> str:
    """`+0.59 ± 0.03`, of shares in percentage points; empty for the workbook itself."""
    if found is None or math.isnan(found.value):
        return ""
    scale = 100.0 if share else 1.0
    text = format_estimate(scale * found.value, None if found.error is None else scale * found.error)
    return f"+{text}" if found.value > 0 else text
