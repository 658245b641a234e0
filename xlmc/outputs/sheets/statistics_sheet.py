"""The sheet Statistics: some forecasts side by side, their statistics and below these their percentiles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from xlmc.montecarlo.number_text import counted_text
from xlmc.outputs.document.content.statistics import statistics_sentence, statistics_tables
from xlmc.outputs.sheets.xlsx_writer import write_blocks

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.page import Page

__all__ = ["WIDTHS", "write_statistics"]

_ACROSS: Final = 6
"""Forecasts side by side: as many as can be read on a page."""

_COLUMNS = (8.3, 6.3, 8.3, 8.3)
"""Of a forecast."""

WIDTHS = (23, *_COLUMNS * _ACROSS)

_ROW = 15.0


def write_statistics(page: Page, simulation: RunResult) -> None:
    """Write the sheet."""
    name = simulation.model.workbook.name
    page.height = _ROW
    below = (
        f"{name}: {counted_text(simulation.accepted, 'accepted trial')}. From … to: the 95 % interval of each number"
    )
    page.title("Statistics of the accepted trials", below)
    results = list(simulation.results.values())
    last = len(_COLUMNS) * min(max(len(results), 1), _ACROSS)
    page.wide(statistics_sentence(simulation), "remark", last)
    for start in range(0, len(results), _ACROSS):
        page.row += 1
        if start:
            page.may_begin()
        write_blocks(page, statistics_tables(results[start : start + _ACROSS]))
    page.set_up_printing(name)
