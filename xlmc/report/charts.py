"""The sheet Charts: one histogram a forecast, like the paper's Figures 12 to 15, and at their right what they draw."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from xlmc.report import cells
from xlmc.report.cells import Shown
from xlmc.report.histogram import Histogram, histogram
from xlmc.report.histogram_chart import BinsAt, histogram_chart
from xlmc.report.summary import SummaryRow, estimate_text, percent, summarise

if TYPE_CHECKING:
    from xlsxwriter.workbook import Workbook

    from xlmc.report.page import Page
    from xlmc.simulation import Simulation

__all__ = ["DATA", "WIDTHS", "write_charts"]

_ACROSS = 2
_COLUMNS, _ROWS, _CHART_ROWS = 9, 19, 16
"""Of the sheet: columns and rows that a figure takes, and rows of its chart alone."""

WIDTHS = (8.43,) * (_ACROSS * _COLUMNS)
DATA = _ACROSS * _COLUMNS + 2
"""The column the first table of bins begins in."""

_FIRST = 3
_HEADER = 2
_TABLE = 6


def write_charts(page: Page, book: Workbook, simulation: Simulation) -> None:
    """Write the sheet."""
    name = simulation.model.workbook.name
    page.title("Histograms of the accepted trials", f"{name}: {simulation.accepted:,} accepted trials")
    drawn = [(row, _bins(simulation, row)) for row in summarise(simulation)]
    figures = [(row, bins) for row, bins in drawn if bins is not None]
    if not figures:
        page.put(_FIRST, 0, cells.text("No accepted trial, so nothing to draw.", "warning line"))
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
    page.row = top + _CHART_ROWS
    page.wide(caption(number + 1, row, bins), "caption", left + _COLUMNS - 2, left)


def caption(figure: int, row: SummaryRow, bins: Histogram) -> str:
    """What the figure shows, in words."""
    units = f" {row.units}" if row.units else ""
    text = (
        f"Figure {figure}. {row.name}: mean {estimate_text(row.mean)}{units}; the central {percent(row.share)} of "
        f"{row.trials:,} accepted trials lie from {estimate_text(row.low)} to {estimate_text(row.high)}{units}."
    )
    if bins.below or bins.above:
        text += f" Not drawn: {bins.below:,} trials below and {bins.above:,} above."
    return text


def _write_bins(page: Page, number: int, row: SummaryRow, bins: Histogram) -> BinsAt:
    """Write the counts that a chart refers to."""
    left = DATA + number * (_TABLE + 1)
    page.sheet.set_column(left, left + _TABLE - 1, 11)
    page.put(0, left, Shown(row.name, look="heading"))
    page.put(1, left, Shown(_axis(row, bins), look="subtitle"))
    page.row = _HEADER
    headers = ["Label", "From", "to below", f"Inside the {percent(row.share)} range", "Outside", "Trials"]
    page.table(headers, _rows(bins), left)
    last = page.row - 1
    _write_rest(page, left, bins)
    return BinsAt(title=(0, left), axis=(1, left), header=_HEADER, first=_HEADER + 1, last=last, left=left)


def _rows(bins: Histogram) -> Iterator[list[Shown]]:
    columns = zip(bins.labels, bins.edges, bins.upper_edges, bins.inside, bins.outside, strict=True)
    for label, low, high, inside, outside in columns:
        edges = [Shown(float(edge), bins.edge_format) for edge in (low, high)]
        yield [cells.text(label), *edges, *(cells.count(int(count)) for count in (inside, outside, inside + outside))]


def _write_rest(page: Page, left: int, bins: Histogram) -> None:
    total = int(np.sum(bins.inside) + np.sum(bins.outside)) + bins.below + bins.above
    for label, count in (("Below", bins.below), ("Above", bins.above), ("All", total)):
        page.line([cells.text(label, "label"), *[cells.BLANK] * 4, cells.count(count)], left)


def _axis(row: SummaryRow, bins: Histogram) -> str:
    width = f"{bins.width:.{bins.decimals}f}"
    wide = f"bars {width} wide, each labelled at its lower end"
    return f"{row.units} ({wide})" if row.units else wide[0].upper() + wide[1:]
