"""Lines: the spider, a line an assumption; and the answers as a filter's limit moves, a line a forecast."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

from xlmc.report.sheets.bar_charts import AXIS, FONT, dressed
from xlmc.report.sheets.chart_style import axis_format, no_reference, straight
from xlmc.report.sheets.ranges import TableAt
from xlmc.report.sheets.styles import GRID

if TYPE_CHECKING:
    from xlsxwriter.chart_line import ChartLine
    from xlsxwriter.chart_scatter import ChartScatter
    from xlsxwriter.workbook import Workbook

__all__ = ["MOST_LINES", "limit_chart", "spider_chart"]

_COLOURS: Final = ("#2F6DA8", "#C8553D", "#4F8A5B", "#8E5EA2", "#D99A2B", "#52606D", "#3AA6A6", "#A23B5B")
_MARKS: Final = ("circle", "square", "diamond", "triangle", "x", "star", "plus", "short_dash")

MOST_LINES: Final = 6
"""More cannot be told apart in a spider."""


def spider_chart(book: Workbook, at: TableAt, title: str, axis: str, first: int, last: int) -> ChartLine:
    """The changes over the percentiles, which are the headings of the columns from `first` to `last`."""
    chart = straight(book.add_chart({"type": "line"}))
    for place in range(min(MOST_LINES, at.last - at.first + 1)):
        chart.add_series(
            {
                "name": at.cell(place, 0),
                "categories": [at.sheet, at.header, first, at.header, last],
                "values": at.row(place, first, last),
                **_line(place),
            }
        )
    chart.set_x_axis({"name": "Assumption at this percentile of its own distribution", **_axis(), "line": AXIS})
    chart.set_y_axis(
        {"name": no_reference(axis), **_axis(upwards=True), "num_format": axis_format("General"), **_GRIDLINES}
    )
    chart.set_legend({"position": "right", "font": FONT})
    return dressed(chart, title)


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
    """Lines over the limit, with standard errors, one a table.

    Args:
        book: that the chart belongs to.
        tables: one below the other; a line is named by its first cell.
        title: above the chart.
        across: what the horizontal axis shows.
        axis: what the other one shows.
        columns: of the name, of the limit, of the number, of its error.
        number: how the axis shows numbers.
        ends: the limits of that axis, as `chart_style.bounds` gives them.
    """
    chart = straight(book.add_chart({"type": "scatter", "subtype": "straight_with_markers"}))
    name, limit, value, error = columns
    for place, at in enumerate(tables):
        bars = {"type": "custom", "plus_values": at.formula(error), "minus_values": at.formula(error)}
        colour = _COLOURS[place % len(_COLOURS)]
        chart.add_series(
            {
                "name": at.cell(0, name),
                "categories": at.column(limit),
                "values": at.column(value),
                **_line(place),
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
    return dressed(chart, title)


_GRIDLINES: Final[dict[str, Any]] = {
    "line": {"none": True},
    "major_gridlines": {"visible": True, "line": {"color": GRID, "width": 0.5}},
}


def _axis(*, upwards: bool = False) -> dict[str, Any]:
    name = {**FONT, "bold": False, **({"rotation": -90} if upwards else {})}
    return {"name_font": name, "num_font": FONT, "label_position": "low"}


def _line(place: int) -> dict[str, Any]:
    colour = _COLOURS[place % len(_COLOURS)]
    mark = {"type": _MARKS[place % len(_MARKS)], "size": 5, "fill": {"color": colour}, "border": {"color": colour}}
    return {"line": {"color": colour, "width": 1.75}, "marker": mark}
