"""Bars and lines as Excel draws them, from the description that every other drawing of a chart is made from.

Excel draws cells: the description says what kind of chart it is, what stands on its axes, and how far these reach, and
`SeriesAt` where the numbers stand.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.number_text import percent_format, two_digit_exponent
from xlmc.outputs.document.cells import Shown, spread_format
from xlmc.outputs.document.colours import COLOURS, DARK, GRID, INK, LIGHT
from xlmc.outputs.document.parts import Bars, Chart, Line, Lines
from xlmc.outputs.sheets.styles import AXIS, FONT, Reference, axis_format, bounds, no_reference, straight

if TYPE_CHECKING:
    from xlsxwriter.chart import Chart as ExcelChart
    from xlsxwriter.workbook import Workbook

    from xlmc.outputs.sheets.page import Page

__all__ = ["GRIDLINES", "SeriesAt", "axis_options", "line_look", "native_chart", "titled", "write_series"]

_MARKS: Final = ("circle", "square", "diamond", "triangle", "x", "star", "plus", "short_dash")
_FILLS: Final = {"dark": DARK, "light": LIGHT}
_WHISKER: Final[dict[str, Any]] = {"color": "#52606D", "width": 1}
_LEVEL: Final = 0
"""The rotation of names that are all shown: LibreOffice leaves out every second of those that state none."""
GRIDLINES: Final[dict[str, Any]] = {
    "line": {"none": True},
    "major_gridlines": {"visible": True, "line": {"color": GRID, "width": 0.5}},
}
"""An axis whose ticks are lines behind the chart."""
_CLOUD: Final[dict[str, Any]] = {
    "line": {"none": True},
    "marker": {"type": "circle", "size": 3, "fill": {"color": DARK, "transparency": 50}, "border": {"none": True}},
}
"""How the points of a cloud look."""


@dataclass(frozen=True, slots=True)
class SeriesAt:
    """Where a line, or the bars of one look, stand on sheets.

    Attributes:
        name: the cell that names it.
        places: the names of the bars, or where the points of a line lie across.
        values: the numbers.
        errors: their standard errors; None where none are drawn.
    """

    name: Reference
    places: Reference
    values: Reference
    errors: Reference | None = None

    @property
    def whiskers(self) -> dict[str, Any]:
        """The options of its error bars, which take references as the texts of formulas."""
        from xlsxwriter.utility import xl_range_formula

        if self.errors is None:
            return {}
        cells = f"={xl_range_formula(*self.errors)}"
        return {"type": "custom", "plus_values": cells, "minus_values": cells}


def native_chart(book: Workbook, chart: Chart, at: Sequence[SeriesAt]) -> ExcelChart:
    """Make a chart of bars or of lines; whoever inserts it gives it its size.

    Args:
        book: that it belongs to.
        chart: its description.
        at: where its lines stand, the cloud first; of bars, those of each look, or of all where each bar has one piece.
    """
    match chart.data:
        case Bars():
            made = _bars(book, chart, chart.data, at)
        case Lines():
            made = _lines(book, chart, chart.data, at)
        case _:
            raise TypeError(f"no chart of cells: {chart.data}")
    return titled(made, chart.title)


def _bars(book: Workbook, chart: Chart, shown: Bars, at: Sequence[SeriesAt]) -> ExcelChart:
    """Names at the left, from the top; numbers below. XlsxWriter calls the horizontal axis x, as it lies here."""
    made = straight(book.add_chart({"type": "bar"}))
    looks = _looks(shown)
    for index, series in enumerate(at):
        options: dict[str, Any] = {"fill": {"color": _FILLS[looks[index]]}, "gap": 35, "overlap": 100}
        if len(at) == 1:
            colours = [_FILLS[bar.pieces[0][2]] if bar.pieces else DARK for bar in shown.bars]
            options |= {"points": [{"fill": {"color": colour}} for colour in colours]}
        if series.errors:
            options |= {"y_error_bars": {**series.whiskers, "line": _WHISKER}}
        cells = {"name": series.name, "categories": series.places, "values": series.values}
        made.add_series({**cells, **options, "border": {"none": True}})
    made.set_y_axis(
        {
            "reverse": True,
            "label_position": "low",
            "interval_unit": 1,
            "num_font": {**FONT, "rotation": _LEVEL},
            "line": AXIS,
            "major_tick_mark": "none",
        }
    )
    number = _axis_number(shown.form, [0.0, *shown.ends])
    made.set_x_axis({**axis_options(chart.across), **GRIDLINES, "num_format": number, "label_position": "high"})
    made.set_legend({"position": "right", "font": FONT} if shown.looks else {"none": True})
    return made


def _looks(shown: Bars) -> list[str]:
    """Return the looks of pieces in their order."""
    result = [look for look, _ in shown.looks] or [look for bar in shown.bars for _, _, look in bar.pieces]
    return [*dict.fromkeys(result)] or ["dark"]


def _lines(book: Workbook, chart: Chart, shown: Lines, at: Sequence[SeriesAt]) -> ExcelChart:
    """Draw lines over numbers: with points of different marks, or the first the thickest."""
    made = straight(book.add_chart({"type": "scatter", "subtype": "straight"}))
    for index, series in enumerate(at, len(shown.lines) - len(shown.all)):
        look = _CLOUD if index < 0 else line_look(index, marked=shown.dots)
        if series.errors:
            look = {**look, "y_error_bars": {**series.whiskers, "line": {**look["line"], "width": 0.75}}}
        made.add_series({"name": series.name, "categories": series.places, "values": series.values, **look})
    across = {"num_format": _across_number(shown), "line": AXIS, "major_gridlines": {"visible": False}}
    made.set_x_axis({**axis_options(chart.across), **across, **_limits_across(shown)})
    number = "0%" if shown.share else _axis_number(shown.form_upwards, shown.heights)
    made.set_y_axis(
        {**axis_options(shown.upwards, turned=True), "num_format": number, **_limits_upwards(shown), **GRIDLINES}
    )
    made.set_legend({"position": "right", "font": FONT} if len(at) > 1 else {"none": True})
    return made


def _across_number(shown: Lines) -> str:
    """Return the format of the numbers of a horizontal axis, of dates the one of their cells."""
    if shown.form_across.kind is Kind.DATE:
        return shown.form_across.moment_code
    return _axis_number(shown.form_across, shown.ends) if shown.all else axis_format("General")


def _limits_across(shown: Lines) -> dict[str, float]:
    """Return the limits of the horizontal axis, which otherwise begins at 0; about it LibreOffice would write 1E-17."""
    low, high = shown.ends
    return bounds(low, high) if not low < 0.0 < high or not shown.lines else {}


def _limits_upwards(shown: Lines) -> dict[str, float]:
    """Return the limits of the vertical axis: of shares no more than 1; those of other lines are the program's own."""
    if shown.share:
        return {"min": 0, "max": 1}
    heights = [point[1] for line in shown.all for point in line.points if math.isfinite(point[1])]
    if shown.form_upwards.factor != 1.0 and heights and 0.0 <= min(heights) <= max(heights) <= 1.0:
        return bounds(0.0, min(1.0, max(shown.heights)))
    return {} if shown.lines or not heights else bounds(min(heights), max(heights))


def line_look(index: int, *, marked: bool) -> dict[str, Any]:
    """Return how a line looks: one of several alike, with marks, or one of those that are compared with the first."""
    if not marked:
        return {
            "line": {"color": COLOURS[index % len(COLOURS)], "width": 1.5 if index else 2.25},
            "marker": {"type": "none"},
        }
    colour = COLOURS[1:][index % (len(COLOURS) - 1)]
    mark = {"type": _MARKS[index % len(_MARKS)], "size": 5, "fill": {"color": colour}, "border": {"color": colour}}
    return {"line": {"color": colour, "width": 1.75}, "marker": mark}


def axis_options(name: str, *, turned: bool = False) -> dict[str, Any]:
    """Return how an axis looks, the upright one turned."""
    font = {**FONT, "bold": False, **({"rotation": -90} if turned else {})}
    return {"name": no_reference(name), "name_font": font, "num_font": FONT, "label_position": "low"}


def _axis_number(form: Form, reach: Sequence[float]) -> str:
    """Return the format of the numbers of an axis that reaches over some, in digits that tell its ticks apart."""
    span = max(reach) - min(reach) if reach else 0.0
    if form == PLAIN or not span:
        return axis_format("General")
    if form.factor == 1.0:
        return axis_format(spread_format(span, form))
    return axis_format(percent_format(1 - two_digit_exponent(form.factor * span)))


def titled(made: Any, title: str) -> Any:
    """Return the chart with its title; nothing stands above it where that is empty."""
    name = {"name": no_reference(title), "name_font": {"size": 12, "bold": True, "color": INK}, "overlay": False}
    made.set_title(name if title else {"none": True})
    made.set_chartarea({"border": {"color": GRID}})
    return made


def write_series(page: Page, chart: Chart) -> list[SeriesAt]:
    """Write what a chart shows onto a sheet, in columns beside those that are there."""
    if isinstance(chart.data, Bars):
        return _write_bars(page, chart.across, chart.data)
    assert isinstance(chart.data, Lines)
    return [_write_line(page, chart.data, line) for line in chart.data.all]


def _write_bars(page: Page, across: str, shown: Bars) -> list[SeriesAt]:
    """Write the ends of all pieces, which begin at 0; where each bar has one, with the error that its whisker shows."""
    looks = _looks(shown) if any(len(bar.pieces) > 1 for bar in shown.bars) else [""]
    rows: list[list[str | float | None]] = []
    for bar in shown.bars:
        result = {look if looks[0] else "": end for _, end, look in bar.pieces}
        rows.append([bar.name, *(result.get(look, 0.0) for look in looks)])
    whiskers = [bar.whisker for bar in shown.bars]
    has_errors = len(looks) == 1 and any(whiskers)
    if has_errors:
        for row, whisker in zip(rows, whiskers, strict=True):
            row.append(0.5 * (whisker[1] - whisker[0]) if whisker else None)
    meanings = dict(shown.looks)
    heads = [across, *(meanings.get(look, "Value") for look in looks), *["±"] * has_errors]
    number = "General" if shown.form == PLAIN else spread_format(max(map(abs, shown.ends), default=0.0), shown.form)
    first, *others = _write_columns(page, heads, rows, ["", *[number] * (len(heads) - 1)])
    errors = others[-1][1] if has_errors else None
    return [SeriesAt(head, first[1], cells, errors) for head, cells in others[: len(looks)]]


def _write_line(page: Page, shown: Lines, line: Line) -> SeriesAt:
    places, values = [point[0] for point in line.points], [point[1] for point in line.points]
    errors = [point[2] if len(point) > 2 else None for point in line.points]
    has_errors = any(errors)
    known = [value for value in values if math.isfinite(value)]
    plain = shown.form_upwards == PLAIN or not known
    number = "0.00%" if shown.share else "General"
    if not (shown.share or plain):
        number = spread_format(max(known) - min(known), shown.form_upwards)
    formats = [spread_format(max(places) - min(places), shown.form_across), number, *[number] * has_errors]
    heads = [line.name, shown.upwards, *["±"] * has_errors]
    columns = zip(places, values, errors, strict=True)
    result = _write_columns(page, heads, [row[: len(heads)] for row in columns], formats)
    return SeriesAt(result[0][0], result[0][1], result[1][1], result[2][1] if has_errors else None)


def _write_columns(
    page: Page, heads: Sequence[str], rows: Sequence[Sequence[str | float | None]], formats: Sequence[str]
) -> list[tuple[Reference, Reference]]:
    """Write columns beside those that are there; gives the heading and the cells of each."""
    end = page.sheet.dim_colmax
    left = 0 if end is None or page.row == 0 else end + 2
    page.row = 1
    page.sheet.set_column(left, left + len(heads) - 1, 16)
    for column, head in enumerate(heads, left):
        page.put(0, column, Shown(head, look="header left"))
    for row, cells in enumerate(rows, 1):
        for column, (cell, form) in enumerate(zip(cells, formats, strict=True), left):
            page.put(row, column, Shown(cell) if isinstance(cell, str) else Shown(cell, form))
    columns = range(left, left + len(heads))
    return [([page.name, 0, column], [page.name, 1, column, len(rows), column]) for column in columns]
