"""The charts of a study of methods in its workbook: speed against accuracy, and a small chart for each number."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

from xlmc.analysis.studies.methods import STATISTICS, Curve, Study
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.colours import GRID, INK
from xlmc.outputs.methods.matplotlib_figure import OTHER, STYLES, Style
from xlmc.outputs.methods.speed_chart import HOW_TO_READ, Line, Picture, column_of, guides_of, picture_of, spread
from xlmc.outputs.sheets.page import Page
from xlmc.outputs.sheets.styles import FONT, straight

if TYPE_CHECKING:
    from xlsxwriter.chart_scatter import ChartScatter
    from xlsxwriter.workbook import Workbook

__all__ = ["DATA", "FIRST_ERROR", "HEADER", "write_charts"]

DATA: Final = "Chart data"

HEADER: Final = 3
"""The row of headings of a sheet of data, counted from 0."""
FIRST_ERROR: Final = 5
"""The column of the sheet Runs in which errors begin; the trials stand in the second."""

_MARKERS: Final = {
    "o": "circle",
    "s": "square",
    "^": "triangle",
    "D": "diamond",
    "P": "plus",
    "X": "x",
    "v": "long_dash",
    "<": "short_dash",
    "*": "star",
}
_MAIN: Final = (1_180, 640)
_SMALL: Final = (236, 232)
_MAIN_ROWS: Final = 29
_SMALL_ROWS: Final = 11
_POINTS: Final = "The points of the first chart stand on the sheet Chart data, those of the others on the sheet Runs."
_WIDE: Final = 17
"""The last column that the main chart covers."""

_SIGNS: Final = "bars: 95 % intervals of the errors; dotted: not run, but carried on by the law that the runs follow"
_GREY: Final = "#6B7785"
_ASKED: Final = "#B00020"
_APART: Final = 0.052
_RING: Final = 11.0
"""Pixels: the radius about the recommended run."""

_DASHES: Final = {0: "solid", 2: "dash", 4: "dash_dot"}
_GRIDLINES: Final = {"visible": True, "line": {"color": GRID, "width": 0.5}}


class _Data:
    """The sheet that the main chart is drawn from: a name, then across and upwards, a row a point."""

    def __init__(self, page: Page, name: str) -> None:
        self._page = page
        page.title_of_data("Chart data", "The points of the chart of speed against accuracy.", name, HEADER)
        page.row += 1
        page.table(("Series", "Across", "Upwards", "Down to", "Up to"), ())

    def put(self, name: str, points: Sequence[tuple[float, ...]]) -> tuple[int, int]:
        """Write points; gives their first and last row."""
        first = self._page.row
        for point in points:
            self._page.line([Shown(name, look="name"), *(Shown(each) for each in point)])
        return first, self._page.row - 1


def write_charts(
    page: Page, data: Page, made: Workbook, study: Study, curve_rows: Sequence[tuple[Curve, int, int]]
) -> None:
    """Write the charts, and the points of the first to a sheet of their own."""
    page.title("Speed against accuracy", study.model.workbook.name)
    page.row += 1
    picture = picture_of(study, "seconds")
    if picture is not None:
        for sentence in HOW_TO_READ:
            page.wide(sentence, "paragraph", _WIDE)
        page.sheet.insert_chart(
            page.row + 1, 0, _main(made, _Data(data, study.model.workbook.name), picture), {"object_position": 1}
        )
    top = page.row + 1 + _MAIN_ROWS
    titles = {FIRST_ERROR + n: f"{name}, % of the 5–95 % range" for n, name in enumerate(STATISTICS.values())}
    titles[FIRST_ERROR + len(STATISTICS)] = "Accepted share, % of it"
    for number, (column, title) in enumerate(titles.items()):
        chart = _small(made, study, title, column, curve_rows)
        if chart is not None:
            page.sheet.insert_chart(top, 0, chart, {"object_position": 1, "x_offset": number * _SMALL[0]})
    page.row = top + _SMALL_ROWS
    page.wide(_POINTS, "remark", _WIDE)
    page.set_up_printing(study.model.workbook.name)


def _main(made: Workbook, data: _Data, picture: Picture) -> ChartScatter:
    chart = straight(made.add_chart({"type": "scatter", "subtype": "straight_with_markers"}))
    left, right, bottom, top = _decades(picture.frame)
    wide, high = math.log10(right / left), math.log10(top / bottom)
    start, end = left / 10.0 ** math.ceil(0.3 * wide), right * 10.0 ** math.ceil(0.55 * wide)
    for mark in picture.marks:
        _add(chart, data, mark.words[0], [(start, mark.y), (right, mark.y)], _ASKED, width=1.25)
        for index, words in enumerate(reversed(mark.words)):
            _words(chart, data, words, (start, mark.y * 10.0 ** ((0.022 + 0.033 * index) * high)), _ASKED)
    x0 = start * 10.0**0.15
    y0, fall = guides_of(picture, bottom)
    for slope, text in ((-0.5, "slope −½: four times the work, half the error"), (-1.0, "slope −1")):
        foot = (x0 * 10.0 ** (fall / -slope), y0 / 10.0**fall)
        _add(chart, data, text, [(x0, y0), foot], _GREY, width=1.0)
        _words(chart, data, text, (x0, y0 * 10.0 ** (0.03 * high)) if slope > -1.0 else foot, _GREY)
    for line in picture.lines:
        _line(chart, data, line, right)
    if picture.chosen is not None:
        x, y, text = picture.chosen
        round_ = _RING / _MAIN[0] * math.log10(end / start), _RING / _MAIN[1] * high
        _add(chart, data, text, _ring(x, y, *round_), INK, width=2.0)
    column = column_of(picture)
    at = spread([math.log10(each.y / bottom) / high for each in column], _APART, 0.03, 0.92)
    _words(chart, data, picture.brief, (right * 10.0 ** (0.04 * wide), bottom * 10.0 ** (0.975 * high)), _GREY)
    for each, height in zip(column, at, strict=True):
        style = Style(INK, "o") if each.line is None else _style(each.line.curve)
        level = bottom * 10.0 ** (height * high)
        leader = [(each.x, each.y), (right, level), (right * 10.0 ** (0.04 * wide), level)]
        _add(chart, data, each.brief, leader, style.colour, width=0.5)
        _words(chart, data, each.brief, leader[-1], style.colour, style.marker, bold=each.line is None)
    axis = {"log_base": 10, "name_font": {**FONT, "bold": False}, "num_font": FONT, "num_format": "General"}
    chart.set_x_axis({**axis, "name": f"{picture.across} ({_SIGNS})", "min": start, "max": end, "crossing": start})
    up = {"name": picture.upwards, "min": bottom, "max": top, "crossing": bottom, "major_gridlines": _GRIDLINES}
    chart.set_y_axis({**axis, **up})
    return _finish(chart, _MAIN)


def _ring(x: float, y: float, across: float, upwards: float) -> list[tuple[float, float]]:
    """Return the points of a ring about a point; a hollow marker would be filled by some programs."""
    turns = [2.0 * math.pi * each / 24.0 for each in range(25)]
    return [(x * 10.0 ** (across * math.cos(turn)), y * 10.0 ** (upwards * math.sin(turn))) for turn in turns]


def _decades(frame: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
    left, right, bottom, top = frame
    return left, right, 10.0 ** math.floor(math.log10(bottom) + 1e-9), top


def _style(curve: Curve) -> Style:
    return STYLES.get(curve.method.key, OTHER)


def _line(chart: ChartScatter, data: _Data, line: Line, right: float) -> None:
    style, name = _style(line.curve), line.curve.method.name
    points = [(each.x, each.y, max(each.y - each.low, 0.0), max(each.high - each.y, 0.0)) for each in line.points]
    _add(chart, data, name, points, style.colour, marker=_marker(style), dash=_dash(style), bars=not line.once)
    if line.once:
        _add(chart, data, name, [points[0][:2], (right, points[0][1])], style.colour, width=0.75, dash="round_dot")
    elif line.ahead:
        _add(chart, data, f"{name}, carried on", line.ahead, style.colour, width=1.0, dash="round_dot")


def _marker(style: Style, size: int = 6) -> dict[str, Any]:
    colour = {"color": style.colour}
    return {"type": _MARKERS.get(style.marker, "circle"), "size": size, "fill": colour, "border": colour}


def _dash(style: Style) -> str:
    return "round_dot" if style.dashes[:1] == (2,) else _DASHES[len(style.dashes)]


def _add(
    chart: ChartScatter,
    data: _Data,
    name: str,
    points: Sequence[tuple[float, ...]],
    colour: str,
    *,
    width: float = 1.75,
    dash: str = "solid",
    marker: dict[str, Any] | None = None,
    bars: bool = False,
    labels: dict[str, Any] | None = None,
) -> None:
    first, last = data.put(name, points)
    line = {"color": colour, "width": width, "dash_type": dash} if len(points) > 1 else {"none": True}
    series: dict[str, Any] = {
        "name": [DATA, first, 0],
        "categories": [DATA, first, 1, last, 1],
        "values": [DATA, first, 2, last, 2],
        "line": line,
        "marker": marker or {"type": "none"},
    }
    if bars:
        down, up = (f"='{DATA}'!${letter}${first + 1}:${letter}${last + 1}" for letter in "DE")
        thin = {"color": colour, "width": 0.75}
        series["y_error_bars"] = {"type": "custom", "minus_values": down, "plus_values": up, "line": thin}
    if labels:
        series["data_labels"] = labels
    chart.add_series(series)


def _words(
    chart: ChartScatter,
    data: _Data,
    text: str,
    at: tuple[float, float],
    colour: str,
    marker: str | None = None,
    *,
    bold: bool = False,
) -> None:
    """Words right of a point."""
    font = {"size": 8, "color": colour, "bold": bold}
    labels = {"value": True, "position": "right", "custom": [{"value": text, "font": font}], "font": font}
    shown = None if marker is None else _marker(Style(colour, marker))
    _add(chart, data, text, [at], colour, marker=shown, labels=labels)


def _small(
    made: Workbook, study: Study, title: str, column: int, curve_rows: Sequence[tuple[Curve, int, int]]
) -> ChartScatter | None:
    """Draw the error of one number against the trials; other engines are left out: their errors are those of Monte
    Carlo.
    """
    chart = straight(made.add_chart({"type": "scatter", "subtype": "straight_with_markers"}))
    drawn = 0
    for curve, first, last in curve_rows:
        if curve not in study.curves or not _has(curve, column):
            continue
        style = _style(curve)
        chart.add_series({
            "name": curve.method.name,
            "categories": ["Runs", first, 1, last, 1],
            "values": ["Runs", first, column, last, column],
            "line": {"color": style.colour, "width": 1.25, "dash_type": _dash(style)},
            "marker": _marker(style, 4),
        })  # fmt: skip
        drawn += 1
    small = {"size": 7, "color": INK}
    axis = {"log_base": 10, "name_font": {**small, "bold": False}, "num_font": small, "crossing": "min"}
    chart.set_title({"name": title, "name_font": {"size": 8, "bold": True, "color": INK}, "overlay": False})
    chart.set_x_axis({**axis, "name": "trials of a run", "num_format": "#,##0"})
    chart.set_y_axis({**axis, "num_format": "General", "major_gridlines": _GRIDLINES})
    return _finish(chart, _SMALL) if drawn else None


def _has(curve: Curve, column: int) -> bool:
    """Whether there is an error above zero to draw."""
    index = column - FIRST_ERROR
    if index == len(STATISTICS):
        return any(runs.acceptance is not None and runs.acceptance.value > 0.0 for runs in curve.lengths)
    return any(runs.shares[[*STATISTICS][index]] > 0.0 for runs in curve.lengths)


def _finish(chart: ChartScatter, size: tuple[int, int]) -> ChartScatter:
    chart.set_legend({"none": True})
    chart.set_size({"width": size[0], "height": size[1]})
    chart.set_chartarea({"border": {"color": GRID}})
    return chart
