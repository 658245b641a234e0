"""Sheet `Scene`, or `Drawing`: a diagram drawn by a native chart from cells, and those cells."""

from __future__ import annotations

from typing import Any

from xlsxwriter.chart import Chart
from xlsxwriter.utility import xl_range
from xlsxwriter.workbook import Workbook
from xlsxwriter.worksheet import Worksheet

from templates.description import Curve, Diagram, Look
from templates.vehicles import names_a_vehicle
from templates.writer.cached import Values
from templates.writer.page import begin_sheet, fit_to_pages, protect, write_formula, write_label
from templates.writer.styles import Styles

__all__ = ["chart_size", "draw_scene"]

_WIDTHS = (44, 24, 24, 40)
_PLAN_SIZE, _PLOT_SIZE = (980, 680), (900, 560)
"""Width and height of a chart, in pixels."""
_PLAN_SHARE = 0.85
"""Of a plan view's height, what its square takes."""
_ROW = 20
"""Height of a row, in pixels."""
_TOP = 3
_FIRST, _SECOND, _INK = "#1F5FA8", "#C2571A", "#52606D"
_LINES: dict[Look, dict[str, Any]] = {
    Look.FIRST: {"color": _FIRST, "width": 2.25},
    Look.SECOND: {"color": _SECOND, "width": 2.25},
    Look.FIRST_PATH: {"color": _FIRST, "width": 1.5, "dash_type": "dash"},
    Look.SECOND_PATH: {"color": _SECOND, "width": 1.5, "dash_type": "dash"},
    Look.LINE: {"color": _INK, "width": 1.25},
    Look.REST: {"none": True},
    Look.POINT: {"none": True},
}
_MARKERS: dict[Look, dict[str, Any]] = {
    Look.REST: {"type": "diamond", "size": 9, "fill": {"color": _INK}, "border": {"color": _INK}},
    Look.POINT: {"type": "circle", "size": 9, "fill": {"color": "#B3261E"}, "border": {"color": "#B3261E"}},
}
_MARGIN = 1.1
"""Half-width of a plan view, in units of its farthest coordinate."""


def draw_scene(workbook: Workbook, sheet: Worksheet, styles: Styles, diagram: Diagram, values: Values) -> None:
    """Write the sheet, locked: the chart, which is printed; below it the points of every curve, in drawing order."""
    begin_sheet(sheet, styles, diagram.title, diagram.remark, _WIDTHS)
    chart = workbook.add_chart({"type": "scatter", "subtype": "straight"})
    first = _TOP + chart_size(diagram)[1] // _ROW + 3
    sheet.set_row(first - 1, 32)
    for column, header in enumerate(("Curve", diagram.x_title, diagram.y_title)):
        sheet.write_string(first - 1, column, header, styles("header"))
    row = first
    for curve in diagram.curves:
        _add_series(chart, sheet.name, curve.name, curve.look, row, len(curve.points))
        row = _draw_points(sheet, styles, curve, row, values)
    if diagram.plan:
        _draw_frame(sheet, styles, chart, first, row, values)
    _finish(chart, diagram)
    sheet.insert_chart(_TOP, 0, chart, {"object_position": 2})
    sheet.print_area(0, 0, first - 2, len(_WIDTHS) - 1)
    fit_to_pages(sheet, first - 1)
    protect(sheet)


def chart_size(diagram: Diagram) -> tuple[int, int]:
    """Width and height of its chart, in pixels."""
    return _PLAN_SIZE if diagram.plan else _PLOT_SIZE


def _draw_points(sheet: Worksheet, styles: Styles, curve: Curve, row: int, values: Values) -> int:
    for point in curve.points:
        write_label(sheet, row, 0, curve.name, styles("text"), values)
        for column, formula in enumerate(point, 1):
            write_formula(sheet, row, column, formula, styles("step", "0.00"), values)
        row += 1
    return row


def _add_series(chart: Chart, sheet: str, name: str, look: Look | None, row: int, points: int) -> None:
    """A curve of that look from so many rows of the sheet; not drawn where there is none."""
    chart.add_series(
        {
            "name": [sheet, row, 0] if names_a_vehicle(name) else name,
            "categories": [sheet, row, 1, row + points - 1, 1],
            "values": [sheet, row, 2, row + points - 1, 2],
            "line": {"none": True} if look is None else _LINES[look],
            "marker": {"type": "none"} if look is None else _MARKERS.get(look, {"type": "none"}),
        }
    )


def _draw_frame(sheet: Worksheet, styles: Styles, chart: Chart, first: int, row: int, values: Values) -> None:
    """Two unseen points that give both axes one range, the same to either side of the origin."""
    drawn = xl_range(first, 1, row - 1, 2)
    for sign in ("-", ""):
        sheet.write_string(row, 0, "Frame (not drawn; keeps both scales equal)", styles("text"))
        for column in (1, 2):
            formula = f"{sign}{_MARGIN}*MAX(MAX({drawn}),-MIN({drawn}))"
            write_formula(sheet, row, column, formula, styles("step", "0.00"), values)
        row += 1
    _add_series(chart, sheet.name, "Frame", None, row - 2, 2)


def _finish(chart: Chart, diagram: Diagram) -> None:
    """Titles, axes and legend; a plan view is square."""
    grid = {"visible": True, "line": {"color": "#E3E7EC", "width": 0.75}}
    for set_axis, title in ((chart.set_x_axis, diagram.x_title), (chart.set_y_axis, diagram.y_title)):
        set_axis(
            {
                "name": title,
                "label_position": "low",
                "major_gridlines": grid,
                "num_format": "0" if diagram.plan else "General",
            }
        )
    legend: dict[str, Any] = {"position": "right"}
    if diagram.plan:
        legend["delete_series"] = [len(diagram.curves)]
        width, height = _PLAN_SIZE
        square = {"width": _PLAN_SHARE * height / width, "height": _PLAN_SHARE}
        chart.set_plotarea({"layout": {"x": 0.08, "y": 0.04} | square})
    chart.set_legend(legend)
    chart.set_title({"none": True})
    width, height = chart_size(diagram)
    chart.set_size({"width": width, "height": height})
