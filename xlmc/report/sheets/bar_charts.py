"""Bars from left to right, an assumption each, the largest on top: influences and tornado."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from xlmc.report.sheets.chart_style import axis_format, no_reference
from xlmc.report.sheets.ranges import TableAt
from xlmc.report.sheets.styles import DARK, GRID, INK, LIGHT

if TYPE_CHECKING:
    from xlsxwriter.chart_bar import ChartBar
    from xlsxwriter.workbook import Workbook

__all__ = ["AXIS", "FONT", "ROWS", "bar_chart", "dressed", "tornado_chart"]

ROWS = 13
SIZE = (620, 23 * ROWS)
"""In pixels."""

AXIS: dict[str, Any] = {"color": "#8994A1", "width": 0.75}
FONT: dict[str, Any] = {"size": 9, "color": INK}
_WHISKER: dict[str, Any] = {"color": "#52606D", "width": 1}


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
    return dressed(chart, title)


def tornado_chart(book: Workbook, at: TableAt, title: str, axis: str, low: int, high: int) -> ChartBar:
    """Two columns of a table, the changes at either end, from a common line at 0."""
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
    _axes(chart, axis, "General")
    chart.set_legend({"position": "right", "font": FONT})
    return dressed(chart, title)


def _axes(chart: ChartBar, axis: str, number: str) -> None:
    """Names on the left, from the top; numbers below. XlsxWriter calls the horizontal axis x, as it lies here."""
    chart.set_y_axis(
        {
            "reverse": True,
            "label_position": "low",
            "interval_unit": 1,
            "num_font": FONT,
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


def dressed(chart: Any, title: str) -> Any:
    """The chart with its title, in its size."""
    chart.set_title(
        {"name": no_reference(title), "name_font": {"size": 12, "bold": True, "color": INK}, "overlay": False}
    )
    chart.set_size({"width": SIZE[0], "height": SIZE[1]})
    chart.set_chartarea({"border": {"color": GRID}})
    return chart
