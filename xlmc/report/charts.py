"""The sheet Charts: one histogram a forecast, like the paper's Figures 12 to 15, and at their right what they draw."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from xlmc.report import cells
from xlmc.report.cells import Shown
from xlmc.report.histogram import Histogram, histogram
from xlmc.report.histogram_chart import BinsAt, histogram_chart
from xlmc.report.summary import SummaryRow, percent, summarise, supported_text

if TYPE_CHECKING:
    from xlsxwriter.workbook import Workbook

    from xlmc.report.page import Page
    from xlmc.simulation import Simulation

__all__ = ["DATA", "WIDTHS", "write_charts"]

_ACROSS = 2
_COLUMNS, _ROWS = 9, 19
"""Of the sheet, that a chart takes with its caption."""

WIDTHS = (8.43,) * (_ACROSS * _COLUMNS)
DATA = _ACROSS * _COLUMNS + 2
"""The column the first table of bins begins in."""

_FIRST = 3
_TABLE = 5


def write_charts(page: Page, book: Workbook, simulation: Simulation) -> None:
    """Write the sheet."""
    name = simulation.model.workbook.name
    page.title("Histograms of the accepted trials", f"{name}: {simulation.accepted:,} accepted trials")
    drawn = [(row, _bins(simulation, row)) for row in summarise(simulation)]
    figures = [(row, bins) for row, bins in drawn if bins is not None]
    if not figures:
        page.row = _FIRST
        page.line([cells.text("No trial was accepted, so there is nothing to draw.", "warning line")])
    for number, (row, bins) in enumerate(figures):
        _write_figure(page, book, number, row, bins)
    page.sheet.print_area(0, 0, max(page.row, _FIRST + _ROWS * -(-len(figures) // _ACROSS)), DATA - 2)
    page.printed(name)


def _bins(simulation: Simulation, row: SummaryRow) -> Histogram | None:
    return histogram(simulation.results[row.name].values, row.low.value, row.high.value)


def _write_figure(page: Page, book: Workbook, number: int, row: SummaryRow, bins: Histogram) -> None:
    at = _write_bins(page, number, row, bins)
    top, left = _FIRST + number // _ACROSS * _ROWS, number % _ACROSS * _COLUMNS
    page.sheet.insert_chart(
        top,
        left,
        histogram_chart(book, page.sheet.get_name(), at, bins),
        {"object_position": 1, "description": caption(number + 1, row, bins)},
    )
    page.row = top + _ROWS - 3
    page.wide(caption(number + 1, row, bins), "caption", left + _COLUMNS - 2, left)


def caption(figure: int, row: SummaryRow, bins: Histogram) -> str:
    """What the figure shows, in numbers of no more digits than their errors support."""
    units = f" {row.units}" if row.units else ""
    text = (
        f"Figure {figure}. {row.name}: mean {supported_text(row.mean)}{units}; the central {percent(row.share)} of "
        f"{row.trials:,} accepted trials lie from {supported_text(row.low)} to {supported_text(row.high)}{units}."
    )
    if bins.below or bins.above:
        text += f" Not drawn: {bins.below:,} trials below and {bins.above:,} above."
    return text


def _write_bins(page: Page, number: int, row: SummaryRow, bins: Histogram) -> BinsAt:
    """Write the counts that a chart refers to."""
    left = DATA + number * (_TABLE + 1)
    page.sheet.set_column(left, left + _TABLE - 1, 11)
    page.row = 0
    page.line([Shown(row.name, look="heading")], left)
    page.line([Shown(_axis(row, bins), look="subtitle")], left)
    share = percent(row.share)
    page.line([_header(text) for text in ("From", "to below", f"Inside the {share} range", "Outside", "Trials")], left)
    page.sheet.set_row(2, 32)
    number_format = "0" + ("." + "0" * bins.decimals if bins.decimals else "")
    for low, high, inside, outside in zip(bins.edges, bins.upper_edges, bins.inside, bins.outside, strict=True):
        counts = [cells.count(int(count)) for count in (inside, outside, inside + outside)]
        page.line([Shown(float(low), number_format), Shown(float(high), number_format), *counts], left)
    first = _FIRST
    _write_rest(page, left, bins)
    return BinsAt(title=(0, left), axis=(1, left), header=2, first=first, last=first + bins.edges.size - 1, left=left)


def _write_rest(page: Page, left: int, bins: Histogram) -> None:
    total = int(np.sum(bins.inside) + np.sum(bins.outside)) + bins.below + bins.above
    for label, count in (("Below", bins.below), ("Above", bins.above), ("All", total)):
        page.line([cells.text(label, "label"), *[cells.BLANK] * 3, cells.count(count)], left)


def _axis(row: SummaryRow, bins: Histogram) -> str:
    width = f"{bins.width:.{bins.decimals}f}"
    wide = f"bars {width} wide, each labelled at its lower end"
    return f"{row.units} ({wide})" if row.units else wide[0].upper() + wide[1:]


def _header(text: str) -> Shown:
    return Shown(text, look="header")
