"""The answers of scenarios on the terminal: what each changes and accepts, then a table for each forecast."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xlmc.cli.terminal import paragraph, say

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation
    from xlmc.statistics import Estimate
    from xlmc.studies.scenario_answers import ForecastAnswer

__all__ = ["show_scenarios"]


def show_scenarios(run: Simulation) -> None:
    """Print them; nothing where they were not run."""
    from xlmc.cli.printing import table
    from xlmc.report.sheets.scenarios_sheet import POINTS, scenario_sentences
    from xlmc.report.summary import share_text
    from xlmc.results.record.in_words import changes_text
    from xlmc.studies.scenario_answers import scenario_answers

    found = scenario_answers(run)
    if not found:
        return
    rows = [
        (
            each.name,
            f"{each.run.accepted:,}",
            share_text(each.acceptance),
            _change(each.acceptance_difference, share=True),
            "" if each.scenario is None else changes_text(each.scenario),
        )
        for each in found
    ]
    heads = ("Scenario", "Accepted", "Share", POINTS, "What is changed")
    table("Scenarios", heads, rows, right=(1, 2, 3))
    for index, forecast in enumerate(found[0].forecasts):
        units = f", {forecast.forecast.units}" if forecast.forecast.units else ""
        headings = _headings(forecast)
        lines = [(each.name, *_cells(each.forecasts[index])) for each in found]
        table(f"{forecast.forecast.name}{units}", headings, lines, right=range(1, len(headings)))
    say(paragraph(" ".join(scenario_sentences(found))) + "\n")


def _headings(answer: ForecastAnswer) -> list[str]:
    from xlmc.report.sheets.scenarios_sheet import POINTS
    from xlmc.report.summary import percent

    share = percent(answer.forecast.central)
    names = ["Mean", f"{share} range from", "to"]
    found = ["Scenario", *(heading for name in names for heading in (name, "Difference"))]
    return found if answer.above is None else [*found, f"Above {answer.forecast.threshold:g}", POINTS]


def _cells(answer: ForecastAnswer) -> list[str]:
    from xlmc.report.summary import estimate_text, share_text

    found = []
    for key, value in (("mean", answer.mean), ("low", answer.low), ("high", answer.high)):
        found += [estimate_text(value), _change(answer.differences.get(key))]
    if answer.above is not None:
        found += [share_text(answer.above), _change(answer.differences.get("above"), share=True)]
    return found


def _change(found: Estimate | None, *, share: bool = False) -> str:
    """`+0.59 ± 0.03`, of shares in percentage points; empty for the workbook itself."""
    from xlmc.report.summary import estimate_text, share_text

    if found is None:
        return ""
    text = share_text(found).removesuffix(" %") if share else estimate_text(found)
    return f"+{text}" if found.value > 0 else text
