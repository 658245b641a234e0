"""The sheet Charts: histograms, cumulative charts, overlay and trend charts.

Histograms come first, like the paper's Figures 12 to 15, then what compares forecasts: these are printed. Then come the
cumulative charts.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from xlmc.montecarlo.number_text import counted_text, percent
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.histogram import Figure, varying
from xlmc.outputs.sheets.bins_sheet import BinsAt, histogram_chart
from xlmc.outputs.sheets.curve_charts import MOST, cumulative_charts, group_by_units, overlay_chart, trend_chart
from xlmc.outputs.sheets.curves_sheet import Curves
from xlmc.outputs.sheets.page import ROW
from xlmc.outputs.summary import first_forecasts

if TYPE_CHECKING:
    from xlsxwriter.chart import Chart
    from xlsxwriter.workbook import Workbook

    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.page import Page

__all__ = ["WIDTHS", "Drawing", "place_drawings", "write_charts"]

_COLUMNS = 18
"""Columns of the sheet, of which drawings side by side take as many each."""

_PRINTED = "The cumulative charts stand behind the others and are not printed, unless you clear the print area."

_SMALL = "Bars inside the central range of each forecast are dark; each bar is labelled at its lower end."

CHART_ROWS = 16
"""Rows of the sheet that a chart covers: a page has room for three such charts with their captions."""

_MANY, _SMALL_ROWS = 6, 10
"""More histograms than these stand three side by side, each covering so many rows: a page has room for twelve."""

_GAP = 8
"""Points below a caption."""

_OFFSET = 3
"""Pixels above a chart, so that its frame is not drawn on the page before."""

_GAP_ACROSS = 10
"""Pixels between charts side by side."""

_FIRST = 3
WIDTHS = (8.14,) * _COLUMNS
_PIXELS = 62
"""Of a column."""


@dataclass(frozen=True, slots=True)
class Drawing:
    """A chart and what it shows in words."""

    chart: Chart
    caption: str


def write_charts(
    page: Page,
    book: Workbook,
    simulation: RunResult,
    figures: Sequence[Figure],
    bins: Sequence[BinsAt],
    curves: Curves,
) -> None:
    """Write the sheet with the charts; `bins` says where their bins stand, `curves` takes the other numbers."""
    name = simulation.model.workbook.name
    page.title(
        "Forecast charts of the accepted trials", f"{name}: {counted_text(simulation.accepted, 'accepted trial')}"
    )
    left_out = len(simulation.model.forecasts) - len(simulation.detailed)
    page.wide(_PRINTED, "remark", len(WIDTHS) - 1)
    page.row = _FIRST
    if left_out:
        page.wide(first_forecasts("Charts are drawn of", len(simulation.detailed), left_out), "remark", len(WIDTHS) - 1)
    if not figures:
        page.put(page.row, 0, Shown("No forecast has a number in an accepted trial: nothing to draw.", look="alarm"))
    small = len(figures) > _MANY
    drawings = [
        Drawing(histogram_chart(book, at, figure.bins, figure.answer.units if small else None), figure.caption)
        for figure, at in zip(figures, bins, strict=True)
    ]
    comparisons = _comparison_drawings(book, curves, simulation, figures)
    if small:
        page.wide(_SMALL, "remark", len(WIDTHS) - 1)
        place_drawings(page, drawings, _SMALL_ROWS, across=3)
        place_drawings(page, list(comparisons))
    else:
        place_drawings(page, [*drawings, *comparisons])
    printed = page.row
    place_drawings(page, list(_cumulative_drawings(book, curves, simulation, figures)))
    page.set_up_printing(name, printed=printed, columns=(0, len(WIDTHS) - 1))


def place_drawings(page: Page, drawings: Sequence[Drawing], rows: int = CHART_ROWS, across: int = 2) -> None:
    """Put charts with their captions on the sheet.

    Args:
        page: the sheet.
        drawings: the charts.
        rows: how many rows of the sheet each is high.
        across: how many stand side by side.
    """
    for start in range(0, len(drawings), across):
        page.may_begin()
        _place_row(page, drawings[start : start + across], rows, _COLUMNS // across)


def _place_row(page: Page, drawings: Sequence[Drawing], rows: int, columns: int) -> None:
    """Put charts side by side that cover so many rows and columns each."""
    size = {"width": columns * _PIXELS - _GAP_ACROSS, "height": int(rows * ROW / 0.75) - 2 * _OFFSET}
    starts, captions = [], []
    for column, drawing in enumerate(drawings):
        left = column * columns
        options = {"object_position": 1, "y_offset": _OFFSET, "description": drawing.caption}
        drawing.chart.set_size(size)
        page.sheet.insert_chart(page.row, left, drawing.chart, options)
        starts += [left, left + columns - 1]
        captions += [Shown(drawing.caption, look="caption"), Shown("", look="caption")]
    page.row += rows
    page.line(captions, starts, starts[-1])
    page.sheet.set_row(page.row, _GAP)
    page.row += 1


def _comparison_drawings(
    book: Workbook, curves: Curves, simulation: RunResult, figures: Sequence[Figure]
) -> Iterator[Drawing]:
    number = len(figures)
    for group in group_by_units(varying(figures)):
        units, few = group[0].answer.units, f" (at most {MOST} in a chart)" if len(group) == MOST else ""
        caption = f"Figure {number + 1}. Overlay chart: the forecasts in {units} as frequency curves{few}."
        yield Drawing(overlay_chart(book, curves, group), caption)
        ranges = "a box for the central range, a line from the 5th to the 95th percentile"
        caption = f"Figure {number + 2}. Trend chart of the same forecasts: {ranges}."
        yield Drawing(trend_chart(book, curves, simulation, group), caption)
        number += 2


def _cumulative_drawings(
    book: Workbook, curves: Curves, simulation: RunResult, figures: Sequence[Figure]
) -> Iterator[Drawing]:
    varied = varying(figures)
    first = len(figures) + 2 * len(group_by_units(varied))
    for index, figure in enumerate(varied):
        charts = cumulative_charts(book, curves, simulation, figure)
        share, number = percent(figure.answer.share), first + 2 * index
        for offset, (chart, words) in enumerate(zip(charts, ("at most", "above"), strict=True), 1):
            caption = f"Figure {number + offset}. {figure.name}: share of the accepted trials {words} each value; "
            yield Drawing(chart, f"{caption}the central {share} range is dark.")
