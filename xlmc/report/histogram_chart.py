"""A histogram as Excel draws it: stacked columns whose cells the sheet holds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from xlmc.report.histogram import Histogram
from xlmc.report.styles import DARK, GRID, INK, LIGHT

if TYPE_CHECKING:
    from xlsxwriter.chart_column import ChartColumn
    from xlsxwriter.workbook import Workbook

__all__ = ["COUNTS", "SIZE", "BinsAt", "histogram_chart"]

COUNTS = (3, 4)
SIZE = (560, 360)
"""In pixels."""

_AXIS: dict[str, Any] = {"color": "#8994A1", "width": 0.75}
_FONT: dict[str, Any] = {"size": 9, "color": INK}


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

    def cell(self, row: int, column: int = 0) -> list[str | int]:
        """A reference to one cell, its column counted from `left`."""
        return [self.sheet, row, self.left + column]

    def column(self, column: int) -> list[str | int]:
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
    chart.set_title({"name": at.cell(at.header - 2), "name_font": {"size": 12, "bold": True, "color": INK}})
    chart.set_x_axis(_across(at, bins))
    chart.set_y_axis(_upwards())
    chart.set_legend({"position": "bottom", "font": _FONT})
    chart.set_size({"width": SIZE[0], "height": SIZE[1]})
    chart.set_chartarea({"border": {"color": GRID}})
    return chart


def _across(at: BinsAt, bins: Histogram) -> dict[str, Any]:
    return {
        "name": at.cell(at.header - 1),
        "name_font": {**_FONT, "bold": False},
        "num_font": _FONT,
        "interval_unit": bins.step,
        "interval_tick": bins.step,
        "label_position": "low",
        "line": _AXIS,
        "major_tick_mark": "outside",
    }


def _upwards() -> dict[str, Any]:
    return {
        "name": "Accepted trials",
        "name_font": {**_FONT, "bold": False, "rotation": -90},
        "num_font": _FONT,
        "num_format": "#,##0",
        "min": 0,
        "line": {"none": True},
        "major_gridlines": {"visible": True, "line": {"color": GRID, "width": 0.5}},
    }
