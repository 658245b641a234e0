"""The sheet Evidence results: what was read, whether it agrees with model and itself, and what each item moves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from xlmc.outputs.document.content.evidence import evidence_blocks
from xlmc.outputs.sheets.xlsx_writer import write_blocks

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.page import Page

__all__ = ["WIDTHS", "write_evidence"]

WIDTHS: Final = (30, 26, *[11] * 8, 14, 11)


def write_evidence(page: Page, simulation: RunResult) -> None:
    """Write the sheet."""
    name = simulation.model.workbook.name
    page.title("Evidence: what was measured, and whether it agrees", name)
    write_blocks(page, evidence_blocks(simulation, simulation.results, full=True), last=len(WIDTHS) - 1)
    page.set_up_printing(name)
