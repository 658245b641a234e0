"""Results as people read them: sheets in the workbook, and the summary that the command line prints."""

from __future__ import annotations

from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING

from xlmc.outputs.summary import SummaryRow, error_sentence, summarise, summary_text

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.document.parts import Block
    from xlmc.outputs.sheets.book import ResultSheet, Writing
    from xlmc.outputs.sheets.page import Page

__all__ = ["SummaryRow", "error_sentence", "save", "summarise", "summary_text"]

_TAB = 31
"""Characters of a sheet's name, Excel's limit."""


def save(
    simulation: RunResult, path: Path, *, command: str | None = None, rows: int | None = None, overwrite: bool = False
) -> Path:
    """Write the workbook with its result sheets, and those of the sections that have no sheet of their own.

    `xlmc.outputs.sheets.save.save` says what the arguments are, and what is raised.
    """
    from xlmc.outputs.document import further_sections
    from xlmc.outputs.sheets.save import save as save_sheets
    from xlmc.outputs.sheets.trials_sheet import TRIAL_ROWS

    result = further_sections(simulation, "sheets")
    further = {name: _sheet(heading, blocks) for name, (heading, blocks) in result.items()}
    return save_sheets(simulation, path, command=command, rows=rows or TRIAL_ROWS, overwrite=overwrite, further=further)


def _sheet(heading: str, blocks: list[Block]) -> ResultSheet:
    from xlmc.outputs.sheets.book import ResultSheet
    from xlmc.outputs.sheets.xlsx_writer import sheet_widths

    return ResultSheet(heading[:_TAB], partial(_write, heading, blocks), tuple(sheet_widths(blocks)))


def _write(heading: str, blocks: list[Block], page: Page, run: Writing) -> None:
    from xlmc.outputs.sheets.page import Page
    from xlmc.outputs.sheets.styles import Styles
    from xlmc.outputs.sheets.xlsx_writer import Charting, write_blocks

    page.title(heading, run.name)

    @cache
    def numbers() -> Page:
        data = Page(run.book.add_worksheet(f"{heading[: _TAB - 5]} data"), Styles(run.book), ())
        data.sheet.hide()
        return data

    write_blocks(page, blocks, Charting(run.book, numbers))
    page.set_up_printing(run.name)
