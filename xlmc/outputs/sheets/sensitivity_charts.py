"""How charts stand on the sheets Sensitivity and Filter limits, where their numbers do, and the spider."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.content.sensitivity import MOST_LINES
from xlmc.outputs.sheets.native_charts import GRIDLINES, SeriesAt, axis_options, line_look, titled
from xlmc.outputs.sheets.page import ROW
from xlmc.outputs.sheets.styles import AXIS, FONT, axis_format, straight

if TYPE_CHECKING:
    from xlsxwriter.chart_line import ChartLine
    from xlsxwriter.workbook import Workbook

    from xlmc.outputs.sheets.page import Page

__all__ = [
    "CHARTED",
    "CHART_ROWS",
    "RIGHT",
    "WIDTHS",
    "Captioned",
    "TableAt",
    "place_rows",
    "spider_chart",
]


WIDTHS: Final = (38, 10, 10, 9, 9, 11, 9, 9, 11, 9, 13, *[9] * 5)
"""The columns of both sheets."""

RIGHT: Final = 5
"""The column of the right-hand chart."""

CHARTED: Final = 12
"""The last column that charts and their captions take: what is printed."""

CHART_ROWS: Final = 13
"""Rows of a sheet that a chart covers."""

Captioned: TypeAlias = tuple[Any, str]
"""A chart, and what it is and is not in words."""

_WIDTH: Final = 550
"""Pixels of a chart: what the columns before `RIGHT` have."""


@dataclass(frozen=True, slots=True)
class TableAt:
    """A table on a sheet; rows and columns are counted from 0.

    Attributes:
        header: the row of column headings.
        first, last: the rows to draw.
    """

    sheet: str
    header: int
    first: int
    last: int

    def heading(self, column: int) -> list[str | int]:
        """Return a reference to a column's heading."""
        return [self.sheet, self.header, column]

    def column(self, column: int) -> list[str | int]:
        """Return a reference to the numbers of a column."""
        return [self.sheet, self.first, column, self.last, column]

    def row(self, index: int, first: int, last: int) -> list[str | int]:
        """Return a reference to the columns `first` to `last` of a row, which is counted from the first."""
        return [self.sheet, self.first + index, first, self.first + index, last]

    def cell(self, index: int, column: int) -> list[str | int]:
        """Return a reference to one cell, its row counted from the first."""
        return [self.sheet, self.first + index, column]

    def series(self, value: int, error: int | None = None) -> SeriesAt:
        """Return a column of numbers as bars, which the first column names, with the errors of another one."""
        errors = None if error is None else self.column(error)
        return SeriesAt(self.heading(value), self.column(0), self.column(value), errors)

    def line(self, name: int, columns: tuple[int, int, int]) -> SeriesAt:
        """Return a line, which the first cell of a column names: columns of places, of numbers and of their errors."""
        return SeriesAt(self.cell(0, name), *map(self.column, columns))


def place_rows(
    page: Page, charts: Sequence[Captioned], rows: int = CHART_ROWS, captions: Sequence[str] | None = None
) -> None:
    """Put charts on a sheet, two side by side with their captions below, and go to the row behind them.

    Args:
        page: the sheet.
        charts: what to put there.
        rows: how many rows of the sheet each is high.
        captions: what stands below them, where that is not what describes them.
    """
    captions = [caption for _, caption in charts] if captions is None else captions
    for start in range(0, len(charts), 2):
        pair, columns = charts[start : start + 2], (0, RIGHT)
        for (chart, caption), column in zip(pair, columns, strict=False):
            chart.set_size({"width": _WIDTH, "height": int(rows * ROW / 0.75)})
            page.sheet.insert_chart(page.row, column, chart, {"object_position": 1, "description": caption})
        page.row += rows
        left, right = (Shown(text, look="caption") for text in (*captions[start : start + 2], "")[:2])
        gap = Shown("", look="caption")
        page.line([left, gap, right, gap], [0, RIGHT - 1, RIGHT, CHARTED], CHARTED)


def spider_chart(
    book: Workbook, at: TableAt, title: str, axis: str, first: int, last: int, number: str = "General"
) -> ChartLine:
    """Chart the changes over the percentiles, which are the headings of the columns from `first` to `last`."""
    chart = straight(book.add_chart({"type": "line"}))
    for index in range(min(MOST_LINES, at.last - at.first + 1)):
        chart.add_series(
            {
                "name": at.cell(index, 0),
                "categories": [at.sheet, at.header, first, at.header, last],
                "values": at.row(index, first, last),
                **line_look(index, marked=True),
            }
        )
    chart.set_x_axis({**axis_options("Assumption at this percentile of its own distribution"), "line": AXIS})
    chart.set_y_axis({**axis_options(axis, turned=True), "num_format": axis_format(number), **GRIDLINES})
    chart.set_legend({"position": "right", "font": FONT})
    return titled(chart, title)
