"""The sheet Results: the answer first, then how many trials it rests on and what the filters did."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xlmc.montecarlo.number_text import counted_text
from xlmc.outputs.document.content.answers import answer_tables, opening_sentences
from xlmc.outputs.document.content.checks import check_blocks
from xlmc.outputs.document.content.filters import count_blocks, filter_blocks
from xlmc.outputs.document.content.notices import notice_blocks
from xlmc.outputs.document.parts import Block, Heading, Paragraph
from xlmc.outputs.sheets.xlsx_writer import write_blocks

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.page import Page

__all__ = ["WIDTHS", "write_results"]

WIDTHS = (37, 12, *[9.5] * 10)
_LAST = 11
_ROW = 15.0


def write_results(page: Page, simulation: RunResult) -> None:
    """Write the sheet."""
    book = simulation.model.workbook.name
    settings = simulation.settings
    page.height = _ROW
    page.title(
        "Results of the simulation", f"{book}, seed {settings.seed}, {counted_text(simulation.evaluated, 'trial')}"
    )
    blocks: list[Block] = [Paragraph(sentence, "warning") for sentence in opening_sentences(simulation)]
    blocks += answer_tables(simulation)
    blocks += count_blocks(simulation)
    blocks += check_blocks(simulation)
    blocks += filter_blocks(simulation, full=True)
    if notices := [*notice_blocks(simulation)]:
        blocks += [Heading("Notices", 2), *notices]
    write_blocks(page, blocks, last=_LAST)
    page.set_up_printing(book)
