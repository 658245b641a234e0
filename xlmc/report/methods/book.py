"""A study as a workbook: the words, the tables as numbers, and native charts in logarithms."""

from __future__ import annotations

import io
from datetime import datetime
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from xlmc.methods import STATISTICS, Curve, Rung, Study, recommendation
from xlmc.methods.need import worst
from xlmc.report import cells
from xlmc.report.cells import Shown
from xlmc.report.chart_style import straight
from xlmc.report.methods import tables
from xlmc.report.methods.figure import STYLES
from xlmc.report.page import Page
from xlmc.report.styles import GRID, INK, Styles

if TYPE_CHECKING:
    from xlsxwriter.chart_scatter import ChartScatter
    from xlsxwriter.workbook import Workbook

__all__ = ["book"]

_CREATED: Final = datetime(2000, 1, 1)
"""No clock: XlsxWriter would write today's date."""

_WORDS: Final = (34.0, *[19.0] * 10, 30.0)
_DATA: Final = (34.0, 12.0, 8.0, 13.0, 14.0, *[12.0] * 6, 10.0, 9.0, 11.0)
_LAST: Final = 8
_HEADINGS: Final = (
    "Method",
    "Trials",
    "Runs",
    "Time, s",
    "Evaluations",
    *(f"{name}, % of SD" for name in STATISTICS.values()),
    "Accepted, % of it",
    "Worst, over the one asked for",
    "Effective trials",
    "Failed runs",
    "Measured",
)
_FIRST_ERROR: Final = 5
_MARKERS: Final = {
    "o": "circle",
    "s": "square",
    "^": "triangle",
    "D": "diamond",
    "P": "plus",
    "X": "x",
    "v": "long_dash",
}
_SIZE: Final = (620, 400)
_DOWN, _ACROSS = 21, 10
_SCALE: Final = 60
_OTHERS: Final = ("Accepted share: error, % of it", "Worst number: error over the one asked for")


def book(study: Study) -> bytes:
    """The workbook: Methods, Charts, Runs, Forecasts."""
    from xlsxwriter import Workbook

    packed = io.BytesIO()
    with Workbook(packed, {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False}) as made:
        made.set_properties({"created": _CREATED})
        styles = Styles(made)
        words = Page(made.add_worksheet("Methods"), styles, _WORDS)
        charts = Page(made.add_worksheet("Charts"), styles, ())
        runs = Page(made.add_worksheet("Runs"), styles, _DATA)
        forecasts = Page(made.add_worksheet("Forecasts"), styles, (34.0, 10.0, 38.0, 22.0, 22.0, 22.0, 22.0))
        _write_words(words, study)
        places = _write_runs(runs, study)
        _write_charts(charts, made, study, places)
        _write_forecasts(forecasts, study)
    return packed.getvalue()


def _write_words(page: Page, study: Study) -> None:
    name = study.model.workbook.name
    page.title("Methods of uncertainty analysis", name)
    page.row += 1
    for said in recommendation(study):
        page.wide(said.replace("`", ""), "paragraph", _LAST)
    for table in (tables.error_table(study), tables.bounds_table(study), tables.reference_table(study)):
        if table.rows:
            page.heading(table.title)
            _texts(page, table)
    page.heading("What each method says of itself, and cannot do")
    for method, said in tables.cannot_lines(study):
        page.spread([cells.text(method, "name"), cells.text(said)], [0, 1], _LAST)
    page.printed(name)


def _texts(page: Page, table: tables.Table) -> None:
    rows = [
        [
            cells.text(cell, "name" if place == 0 else "text" if place < table.right else "number")
            for place, cell in enumerate(row)
        ]
        for row in table.rows
    ]
    page.table(table.headings, rows)


def _write_runs(page: Page, study: Study) -> list[tuple[Curve, int, int]]:
    """Write the rungs; gives each curve's first and last row."""
    page.title(
        "Every run length", "Root mean square errors over the runs and the forecasts; the charts are drawn from here"
    )
    page.row += 1
    page.table(_HEADINGS, ())
    places = []
    for curve in study.every:
        if not curve.answers:
            continue
        first = page.row
        for rung in curve.rungs:
            page.line(_rung_cells(study, curve, rung))
        places.append((curve, first, page.row - 1))
    page.line([cells.text("The reference's own error", "label"), *[cells.BLANK] * 4, *_floor(study)])
    page.printed(study.model.workbook.name)
    return places


def _rung_cells(study: Study, curve: Curve, rung: Rung) -> list[Shown]:
    drawn = curve not in study.once
    known = study.reference.acceptance.value
    accepted = None if rung.acceptance is None else 100.0 * rung.acceptance.value / known
    return [
        cells.text(curve.method.name, "name"),
        cells.count(rung.budget) if drawn else cells.BLANK,
        cells.count(max(each.n for each in rung.errors.values())),
        _number(rung.seconds),
        cells.exact(rung.evaluations, "#,##0"),
        *(_number(100.0 * rung.shares[each]) for each in STATISTICS),
        _number(accepted),
        _number(worst(study, curve, rung)),
        cells.exact(rung.effective, "#,##0"),
        cells.count(rung.failed),
        cells.text("yes" if rung.measured else "by rate"),
    ]


def _floor(study: Study) -> list[Shown]:
    accepted = study.reference.acceptance
    share = None if accepted.error is None else 100.0 * accepted.error / accepted.value
    return [*(_number(100.0 * tables.floor_of(study, each)) for each in STATISTICS), _number(share)]


def _number(value: float | None) -> Shown:
    known = value is not None and np.isfinite(value)
    return cells.exact(value if known else None, "0.0000")


def _write_charts(page: Page, made: Workbook, study: Study, places: list[tuple[Curve, int, int]]) -> None:
    page.title("Error against time", f"{study.model.workbook.name}: both axes in logarithms; slopes against the trials")
    titles = (*(f"{name}: error, % of SD" for name in STATISTICS.values()), *_OTHERS)
    for number, title in enumerate(titles):
        chart = _chart(made, study, title, _FIRST_ERROR + number, places)
        if chart is not None:
            page.sheet.insert_chart(3 + number // 2 * _DOWN, number % 2 * _ACROSS, chart, {"object_position": 1})
    page.printed(study.model.workbook.name, scale=_SCALE, breaks=[2 + 2 * _DOWN])


def _chart(
    made: Workbook, study: Study, title: str, column: int, places: list[tuple[Curve, int, int]]
) -> ChartScatter | None:
    """Error against seconds; engines that a day would not be enough for would hide the rest, and are left out."""
    chart = straight(made.add_chart({"type": "scatter", "subtype": "straight_with_markers"}))
    drawn = 0
    for curve, first, last in places:
        found = [_value(study, curve, rung, column) for rung in curve.rungs]
        if not all(rung.measured for rung in curve.rungs) or not any(each > 0.0 for each in found):
            continue
        colour, marker = STYLES.get(curve.method.key, ("#444444", "o"))
        fill: dict[str, Any] = {"color": colour}
        chart.add_series({
            "name": _series_name(curve),
            "categories": ["Runs", first, 3, last, 3],
            "values": ["Runs", first, column, last, column],
            "line": {"color": colour, "width": 1.5},
            "marker": {"type": _MARKERS.get(marker, "circle"), "size": 6, "fill": fill, "border": fill},
        })  # fmt: skip
        drawn += 1
    font = {"size": 9, "color": INK}
    axis = {
        "log_base": 10,
        "name_font": {**font, "bold": False},
        "num_font": font,
        "crossing": "min",
        "num_format": "General",
    }
    grid = {"visible": True, "line": {"color": GRID, "width": 0.5}}
    chart.set_title({"name": title, "name_font": {"size": 12, "bold": True, "color": INK}, "overlay": False})
    chart.set_x_axis({**axis, "name": "time of a run, s", "major_gridlines": grid})
    chart.set_y_axis({**axis, "name": title.partition(": ")[2], "major_gridlines": grid})
    chart.set_legend({"position": "right", "font": font})
    chart.set_size({"width": _SIZE[0], "height": _SIZE[1]})
    chart.set_chartarea({"border": {"color": GRID}})
    return chart if drawn else None


def _value(study: Study, curve: Curve, rung: Rung, column: int) -> float:
    if column == _FIRST_ERROR + len(STATISTICS):
        return 0.0 if rung.acceptance is None else rung.acceptance.value
    if column > _FIRST_ERROR + len(STATISTICS):
        value = worst(study, curve, rung)
        return value if np.isfinite(value) else 0.0
    value = rung.shares[[*STATISTICS][column - _FIRST_ERROR]]
    return value if np.isfinite(value) else 0.0


def _series_name(curve: Curve) -> str:
    slope = curve.slope("mean", "budget")
    return f"{curve.method.name} ({tables.slope_text(slope)})" if np.isfinite(slope) else curve.method.name


def _write_forecasts(page: Page, study: Study) -> None:
    table = tables.forecast_table(study)
    page.title("Forecast by forecast", f"{table.title}; ± is the standard error of a root mean square")
    page.row += 1
    _texts(page, table)
    page.printed(study.model.workbook.name)
