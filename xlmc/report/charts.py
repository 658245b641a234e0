"""The sheet Charts: one histogram a forecast, like the paper's Figures 12 to 15."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from xlmc.report import cells
from xlmc.report.figure import Figure
from xlmc.report.histogram_chart import BinsAt, histogram_chart

if TYPE_CHECKING:
    from xlsxwriter.workbook import Workbook

    from xlmc.report.page import Page
    from xlmc.simulation import Simulation

__all__ = ["WIDTHS", "write_charts"]

_ACROSS, _COLUMNS = 2, 9
"""Figures side by side, and the columns of the sheet that each takes."""

_CHART_ROWS, _GAP = 16, 2
_FIRST = 3
WIDTHS = (8.43,) * (_ACROSS * _COLUMNS)


def write_charts(
    page: Page, book: Workbook, simulation: Simulation, figures: Sequence[Figure], places: Sequence[BinsAt]
) -> None:
    """Write the sheet with the charts; `places` are those of the figures' bins."""
    name = simulation.model.workbook.name
    page.title("Histograms of the accepted trials", f"{name}: {simulation.accepted:,} accepted trials")
    page.row = _FIRST
    if not figures:
        page.put(page.row, 0, cells.text("No forecast has a number in an accepted trial: nothing to draw.", "alarm"))
    for start in range(0, len(figures), _ACROSS):
        _write_row(page, book, figures[start : start + _ACROSS], places[start : start + _ACROSS])
    page.printed(name)


def _write_row(page: Page, book: Workbook, figures: Sequence[Figure], places: Sequence[BinsAt]) -> None:
    for column, (figure, place) in enumerate(zip(figures, places, strict=True)):
        options = {"object_position": 1, "description": figure.caption}
        page.sheet.insert_chart(page.row, column * _COLUMNS, histogram_chart(book, place, figure.bins), options)
    page.row += _CHART_ROWS
    starts = [column * _COLUMNS for column in range(len(figures))]
    page.spread([cells.text(figure.caption, "caption") for figure in figures], starts, starts[-1] + _COLUMNS - 1)
    page.row += _GAP
