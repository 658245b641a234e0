"""The sheet Pairs: forecasts two at a time, their joint probabilities, their correlation, and scatter charts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from xlmc.analysis.results.statements.pairs import Pair, pairs_of
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.number_text import count_text, counted_text
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.content.pairs import pair_blocks
from xlmc.outputs.document.parts import Chart, Line, Lines
from xlmc.outputs.sheets.charts_sheet import Drawing, place_drawings
from xlmc.outputs.sheets.curves_sheet import Curves
from xlmc.outputs.sheets.native_charts import SeriesAt, native_chart
from xlmc.outputs.sheets.styles import Reference
from xlmc.outputs.sheets.xlsx_writer import write_blocks
from xlmc.outputs.summary import with_units

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from xlsxwriter.chart import Chart as ExcelChart
    from xlsxwriter.workbook import Workbook

    from xlmc.montecarlo.definitions.definitions import Forecast
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.page import Page
    from xlmc.outputs.sheets.trials_sheet import TrialsAt

__all__ = ["POINTS", "WIDTHS", "write_pairs"]

POINTS: Final = 1_000
"""Points in a scatter chart: more would hide each other and make the file slow to open."""

WIDTHS = (*[8.14] * 14, 10.6, *[7.3] * 3)
_LAST = 17
_CHART_ROWS = 12
"""Rows of the sheet that a chart covers: a page has room for the pairs of four forecasts, and a chart of each."""
_PRINTED = 6
"""The most pairs whose charts are printed: those that have room on a page with their table."""


@dataclass(frozen=True, slots=True)
class _Points:
    """A forecast's points: the name of an axis for them, where their name and their values stand, these, and how they
    are written.
    """

    axis: str
    name: Reference
    at: Reference
    values: list[float]
    form: Form


def write_pairs(page: Page, book: Workbook, simulation: RunResult, curves: Curves, trials: TrialsAt) -> None:
    """Write the sheet; its charts draw the trials where `trials` says, or points that `curves` takes."""
    name = simulation.model.workbook.name
    page.title("Forecasts two at a time", f"{name}: {counted_text(simulation.accepted, 'accepted trial')}")
    pairs = pairs_of(simulation)
    if not pairs:
        page.row += 1
        page.wide(
            "There are no two forecasts that vary and have numbers in the same accepted trials.", "paragraph", _LAST
        )
        page.set_up_printing(name)
        return
    page.heading("Joint probability and rank correlation")
    write_blocks(page, pair_blocks(simulation, pairs), last=_LAST)
    on_paper = len(pairs) <= _PRINTED
    if not on_paper:
        page.wide("The scatter charts are not printed, unless you clear the print area.", "remark", _LAST)
    page.row += 1
    table = page.row
    place_drawings(page, _drawings(book, curves, simulation, pairs, trials), _CHART_ROWS)
    page.set_up_printing(name, printed=None if on_paper else table, columns=(0, _LAST))


def _drawings(
    book: Workbook, curves: Curves, simulation: RunResult, pairs: Sequence[Pair], trials: TrialsAt
) -> list[Drawing]:
    """Chart each pair as a scatter, from the first trials in which all forecasts of these pairs are numbers."""
    names = {forecast.name for pair in pairs for forecast in (pair.first, pair.second)}
    forecasts = [forecast for forecast in simulation.model.forecasts if forecast.name in names]
    known = _trials_with_numbers([simulation.forecasts[each.name] for each in forecasts])
    if not known.size:
        return []
    result = {each.name: _points(curves, simulation, trials, each, known) for each in forecasts}
    titles = [f"{pair.first.name} and {pair.second.name}" for pair in pairs]
    points = f"the first {count_text(known.size)} accepted trials in which all of these forecasts are numbers"
    return [
        Drawing(
            _scatter(book, title, result[pair.first.name], result[pair.second.name]),
            f"Scatter chart {number}. {title}: {points}.",
        )
        for number, (title, pair) in enumerate(zip(titles, pairs, strict=True), 1)
    ]


def _trials_with_numbers(columns: Sequence[NDArray[np.float64]]) -> NDArray[np.intp]:
    """Return the first trials in which all are numbers: a text among the points would make a chart's axis 1, 2, 3."""
    early = [column[: 20 * POINTS] for column in columns]
    return np.flatnonzero(~np.any([np.isnan(column) for column in early], axis=0))[:POINTS]


def _points(
    curves: Curves, simulation: RunResult, trials: TrialsAt, forecast: Forecast, known: NDArray[np.intp]
) -> _Points:
    """Return a forecast's values in these trials: those on the sheet Trials, or else a table of their own."""
    values = simulation.forecasts[forecast.name][known]
    axis, form = with_units(forecast.name, forecast.units), simulation.results[forecast.name].form
    if form.kind is Kind.YES_NO:
        form = PLAIN  # a trial is 0 or 1, and no share
    if known[-1] < min(known.size, trials.shown):
        index = simulation.model.forecasts.index(forecast)
        return _Points(axis, trials.heading(index), trials.column(index, known.size), values.tolist(), form)
    digits = cells.spread_format(float(values.max()) - float(values.min()), form)
    rows = [[Shown(value, digits)] for value in values.tolist()]
    table = curves.write(["Points of a scatter chart"], axis, [forecast.name], rows)
    return _Points(axis, table.heading(0), table.column(0), values.tolist(), form)


def _scatter(book: Workbook, title: str, first: _Points, second: _Points) -> ExcelChart:
    cloud = Line(title, tuple(zip(first.values, second.values, strict=True)))
    lines = Lines((), second.axis, form_across=first.form, form_upwards=second.form, cloud=cloud)
    chart = Chart(title, first.axis, lines, title)
    return native_chart(book, chart, [SeriesAt(second.name, first.at, second.at)])
