"""The sheet Scenarios: the answers of each scenario beside the workbook's own, and how far they lie apart."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from xlmc.analysis.studies.scenario_answers import impossible_scenarios, scenario_answers
from xlmc.outputs.document.content.scenarios import scenario_blocks
from xlmc.outputs.sheets.xlsx_writer import write_blocks

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.page import Page

__all__ = ["WIDTHS", "write_scenarios"]

WIDTHS = (30, *[11] * 16)

_LAST: Final = 12


def write_scenarios(page: Page, simulation: RunResult) -> None:
    """Write the sheet."""
    name = simulation.model.workbook.name
    page.title("Scenarios", f"{name}, seed {simulation.settings.seed}: the workbook as it is, and with changes")
    blocks = scenario_blocks(scenario_answers(simulation), impossible_scenarios(simulation))
    write_blocks(page, blocks, last=_LAST)
    page.set_up_printing(name)
