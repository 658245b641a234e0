"""A histogram as Excel draws it: stacked columns whose cells the sheet holds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from xlmc.report.histogram import Histogram
from xlmc.report.sheets.chart_style import Reference, across, finish, upwards
from xlmc.report.sheets.styles import DARK, LIGHT

if TYPE_CHECKING:
    from xlsxwriter.chart_column import ChartColumn
    from xlsxwriter.workbook import Workbook

__all__ = ["COUNTS", "BinsAt", "histogram_chart"]

COUNTS = (3, 4)


@dataclass(frozen=True, slots=True)
class BinsAt:
    """Where a table of bins stands; rows and columns are counted from 0.

    Attributes:
        header: the row of column headings; the bins follow it, and above it stand the chart's title and its axis's.
        last: the row of the last bin.
        left: the column of the labels and of both titles; the counts stand `COUNTS` to its right.
    """

    sheet: str
    header: int
    last: int
    left: int

    def cell(self, row: int, column: int = 0) -> Reference:
        """A reference to one cell, its column counted from `left`."""
        return [self.sheet, row, self.left + column]

    def column(self, column: int) -> Reference:
        """A reference to the bins of one column."""
        return [self.sheet, self.header + 1, self.left + column, self.last, self.left + column]


def histogram_chart(book: Workbook, at: BinsAt, bins: Histogram) -> ChartColumn:
    """The chart. Its texts are references to cells, so that none of them can be taken for a formula."""
    chart = book.add_chart({"type": "column", "subtype": "stacked"})
    for column, colour in zip(COUNTS, (DARK, LIGHT), strict=True):
        chart.add_series(
            {
                "name": at.cell(at.header, column),
                "categories": at.column(0),
                "values": at.column(column),
                "fill": {"color": colour},
                "border": {"none": True},
                "gap": 4,
            }
        )
    marks = {"interval_unit": bins.step, "interval_tick": bins.step}
    chart.set_x_axis(across(at.cell(at.header - 1), **marks))
    chart.set_y_axis(upwards("Accepted trials", min=0))
    finish(chart, at.cell(at.header - 2))
    return chart
