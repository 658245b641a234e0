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

_ON_A_PAGE, _SCALE = 4, 60
"""Figures, and the percentage at which so many fit."""

_CHART_ROWS = 16
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
    breaks = []
    for start in range(0, len(figures), _ACROSS):
        if start and start % _ON_A_PAGE == 0:
            breaks.append(page.row)
        _write_row(page, book, figures[start : start + _ACROSS], places[start : start + _ACROSS])
    page.printed(name, scale=_SCALE, breaks=breaks)


def _write_row(page: Page, book: Workbook, figures: Sequence[Figure], places: Sequence[BinsAt]) -> None:
    starts, captions = [], []
    for column, (figure, place) in enumerate(zip(figures, places, strict=True)):
        left = column * _COLUMNS
        options = {"object_position": 1, "description": figure.caption}
        page.sheet.insert_chart(page.row, left, histogram_chart(book, place, figure.bins), options)
        starts += [left, left + _COLUMNS - 1]
        captions += [cells.text(figure.caption, "caption"), cells.text("", "caption")]
    page.row += _CHART_ROWS
    page.spread(captions, starts, starts[-1])
    page.row += 1
