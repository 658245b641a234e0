"""The charts of the sheets Sensitivity and Filter limits: bars, one for each assumption, and lines.

Bars run from left to right, the largest on top: influences and tornado. Lines: the spider, one for each assumption, and
how the answers move with a filter's limit, one for each forecast.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.colours import DARK, GRID, INK, LIGHT
from xlmc.outputs.document.content.sensitivity import MOST_LINES
from xlmc.outputs.sheets.page import ROW
from xlmc.outputs.sheets.styles import AXIS, FONT, axis_format, no_reference, straight

if TYPE_CHECKING:
    from xlsxwriter.chart_bar import ChartBar
    from xlsxwriter.chart_line import ChartLine
    from xlsxwriter.chart_scatter import ChartScatter
    from xlsxwriter.workbook import Workbook

    from xlmc.outputs.sheets.page import Page

__all__ = [
    "CHARTED",
    "CHART_ROWS",
    "RIGHT",
    "WIDTHS",
    "Captioned",
    "TableAt",
    "bar_chart",
    "limit_chart",
    "place_rows",
    "spider_chart",
    "tornado_chart",
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

_COLOURS: Final = ("#2F6DA8", "#C8553D", "#4F8A5B", "#8E5EA2", "#D99A2B", "#52606D", "#3AA6A6", "#A23B5B")

_MARKS: Final = ("circle", "square", "diamond", "triangle", "x", "star", "plus", "short_dash")

_WHISKER: dict[str, Any] = {"color": "#52606D", "width": 1}

_LEVEL: Final = 0
"""The rotation of names that are all shown: LibreOffice leaves out every second of those that state none."""

_GRIDLINES: Final[dict[str, Any]] = {
    "line": {"none": True},
    "major_gridlines": {"visible": True, "line": {"color": GRID, "width": 0.5}},
}


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

    def formula(self, column: int) -> str:
        """Return a reference to the numbers of a column as the text of a formula, which error bars take."""
        from xlsxwriter.utility import xl_range_formula

        return f"={xl_range_formula(self.sheet, self.first, column, self.last, column)}"


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


def bar_chart(
    book: Workbook, at: TableAt, title: str, axis: str, value: int, error: int, pale: Sequence[bool], number: str = "0%"
) -> ChartBar:
    """One column of a table with its standard errors.

    Args:
        book: that the chart belongs to.
        at: the table; its first column names the bars.
        title: above the chart.
        axis: below the bars.
        value: the column of the numbers.
        error: that of their errors.
        pale: whether a bar says no more than noise.
        number: how the axis shows numbers.
    """
    chart = book.add_chart({"type": "bar"})
    errors = {"type": "custom", "plus_values": at.formula(error), "minus_values": at.formula(error), "line": _WHISKER}
    chart.add_series(
        {
            "name": no_reference(title),
            "categories": at.column(0),
            "values": at.column(value),
            "fill": {"color": DARK},
            "border": {"none": True},
            "gap": 35,
            "points": [{"fill": {"color": LIGHT}} if each else {"fill": {"color": DARK}} for each in pale],
            "y_error_bars": errors,
        }
    )
    _axes(chart, axis, number)
    chart.set_legend({"none": True})
    return _finish(chart, title)


def tornado_chart(
    book: Workbook, at: TableAt, title: str, axis: str, low: int, high: int, number: str = "General"
) -> ChartBar:
    """Two columns of a table, the changes at either end, from a common line at 0; the axis shows them in a format."""
    chart = book.add_chart({"type": "bar"})
    for column, colour in ((low, LIGHT), (high, DARK)):
        chart.add_series(
            {
                "name": at.heading(column),
                "categories": at.column(0),
                "values": at.column(column),
                "fill": {"color": colour},
                "border": {"none": True},
                "gap": 35,
                "overlap": 100,
            }
        )
    _axes(chart, axis, number)
    chart.set_legend({"position": "right", "font": FONT})
    return _finish(chart, title)


def _axes(chart: ChartBar, axis: str, number: str) -> None:
    """Names on the left, from the top; numbers below. XlsxWriter calls the horizontal axis x, as it lies here."""
    chart.set_y_axis(
        {
            "reverse": True,
            "label_position": "low",
            "interval_unit": 1,
            "num_font": {**FONT, "rotation": _LEVEL},
            "line": AXIS,
            "major_tick_mark": "none",
        }
    )
    chart.set_x_axis(
        {
            "name": no_reference(axis),
            "name_font": {**FONT, "bold": False},
            "num_font": FONT,
            "num_format": axis_format(number),
            "label_position": "high",
            "line": {"none": True},
            "major_gridlines": {"visible": True, "line": {"color": GRID, "width": 0.5}},
        }
    )


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
                **_line(index),
            }
        )
    chart.set_x_axis({"name": "Assumption at this percentile of its own distribution", **_axis(), "line": AXIS})
    chart.set_y_axis(
        {"name": no_reference(axis), **_axis(upwards=True), "num_format": axis_format(number), **_GRIDLINES}
    )
    chart.set_legend({"position": "right", "font": FONT})
    return _finish(chart, title)


def limit_chart(
    book: Workbook,
    tables: Sequence[TableAt],
    title: str,
    across: str,
    axis: str,
    columns: tuple[int, int, int, int],
    number: str,
    *,
    ends: Mapping[str, float] | None = None,
) -> ChartScatter:
    """Lines over the limit, with standard errors, one for each table.

    Args:
        book: that the chart belongs to.
        tables: one below the other; a line is named by its first cell.
        title: above the chart.
        across: what the horizontal axis shows.
        axis: what the other one shows.
        columns: of the name, of the limit, of the number, of its error.
        number: how the axis shows numbers.
        ends: the limits of that axis, as `styles.bounds` gives them.
    """
    chart = straight(book.add_chart({"type": "scatter", "subtype": "straight_with_markers"}))
    name, limit, value, error = columns
    for index, at in enumerate(tables):
        bars = {"type": "custom", "plus_values": at.formula(error), "minus_values": at.formula(error)}
        colour = _COLOURS[index % len(_COLOURS)]
        chart.add_series(
            {
                "name": at.cell(0, name),
                "categories": at.column(limit),
                "values": at.column(value),
                **_line(index),
                "y_error_bars": {**bars, "line": {"color": colour, "width": 0.75}},
            }
        )
    plain = {"visible": False}
    form = axis_format("General")
    chart.set_x_axis(
        {"name": no_reference(across), **_axis(), "num_format": form, "line": AXIS, "major_gridlines": plain}
    )
    up = {"num_format": axis_format(number), **(ends or {}), **_GRIDLINES}
    chart.set_y_axis({"name": no_reference(axis), **_axis(upwards=True), **up})
    chart.set_legend({"position": "right", "font": FONT} if len(tables) > 1 else {"none": True})
    return _finish(chart, title)


def _axis(*, upwards: bool = False) -> dict[str, Any]:
    name = {**FONT, "bold": False, **({"rotation": -90} if upwards else {})}
    return {"name_font": name, "num_font": FONT, "label_position": "low"}


def _line(index: int) -> dict[str, Any]:
    colour = _COLOURS[index % len(_COLOURS)]
    mark = {"type": _MARKS[index % len(_MARKS)], "size": 5, "fill": {"color": colour}, "border": {"color": colour}}
    return {"line": {"color": colour, "width": 1.75}, "marker": mark}


def _finish(chart: Any, title: str) -> Any:
    """Return the chart with its title; `place_rows` gives it its size."""
    chart.set_title(
        {"name": no_reference(title), "name_font": {"size": 12, "bold": True, "color": INK}, "overlay": False}
    )
    chart.set_chartarea({"border": {"color": GRID}})
    return chart
