"""The sheet Sensitivity: what each forecast depends on.

The two charts of each forecast that say most come first and are printed; below them stand its other charts and the
tables of influences and of moves that all are drawn from.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from xlmc.montecarlo.definitions.forms import PLAIN
from xlmc.montecarlo.number_text import count_text, counted_text
from xlmc.outputs.document.charts import influence_charts, tornado_chart
from xlmc.outputs.document.content.sensitivity import (
    BENT,
    EXPLAINED_CHART,
    ROWS,
    SPIDER,
    TORNADO_CHART,
    base_text,
    change_format,
    influence_captions,
    influence_table,
    is_bent,
    move_captions,
    move_table,
    sensitivity_sentences,
)
from xlmc.outputs.sheets.native_charts import native_chart
from xlmc.outputs.sheets.sensitivity_charts import (
    CHART_ROWS,
    CHARTED,
    WIDTHS,
    Captioned,
    TableAt,
    place_rows,
    spider_chart,
)
from xlmc.outputs.sheets.xlsx_writer import write_blocks
from xlmc.outputs.summary import with_units

if TYPE_CHECKING:
    from xlsxwriter.chart import Chart as ExcelChart
    from xlsxwriter.workbook import Workbook

    from xlmc.analysis.studies.sensitivity import ForecastSensitivity, Sensitivities
    from xlmc.excel.workbook.workbook import Workbook as SourceBook
    from xlmc.outputs.document.parts import Table
    from xlmc.outputs.sheets.page import Page

__all__ = ["WIDTHS", "write_sensitivity"]


_LAST: Final = len(WIDTHS) - 1

_EXPLAINED, _DEPENDENCE, _RANK, _CONTRIBUTION, _FIRST, _TOTAL = 2, 5, 8, 10, 12, 14
"""The columns of the values; their errors follow them."""

_HEADING: Final = 2
"""The rows of a heading."""

_DRAWN: Final = 8
"""Bars on a chart of the sheet, where more would have no room for their names."""

_FIRST_ROWS: Final = 10
"""Rows of the sheet that the first two charts of a forecast cover: a page has room for those of four forecasts."""

_NAMES_WIDE, _BARS_WIDE, _TORNADO_WIDE = 0.43, 0.53, 0.4
"""Parts of the width of such a chart: the names of its bars, and the bars, of which a tornado has a legend beside them.

Without them LibreOffice wraps long names, and then leaves out every other one.
"""

_PRINTED: Final = 9
"""Forecasts whose first charts are printed: two pages."""

_CHANGES: Final = 5
"""The column of the first of the five changes."""


def write_sensitivity(page: Page, book: Workbook, sensitivities: Sensitivities, source: SourceBook) -> None:
    """Write the sheet: two charts of each forecast, which are printed; below all of them its others and its tables.

    The charts draw the tables that stand below them, so room is left for them.
    """
    page.title(
        "Sensitivity: what the answers depend on",
        f"{source.name}: {counted_text(sensitivities.accepted, 'accepted trial')}",
    )
    bent = f" {BENT}" if any(map(is_bent, sensitivities.forecasts)) else ""
    printed_only = _printed_sentence(len(sensitivities.forecasts))
    for sentence in (
        *sensitivity_sentences(sensitivities, source),
        EXPLAINED_CHART,
        f"{TORNADO_CHART}{bent}",
        printed_only,
    ):
        page.wide(sentence, "remark", CHARTED)
    tops = []
    for forecast in sensitivities.forecasts:
        tops.append(page.row)
        _write_heading(page, forecast)
        page.row += _FIRST_ROWS + 1 if _is_drawn(forecast) else 0
    printed = [*tops, page.row][min(len(tops), _PRINTED)]
    for top, forecast in zip(tops, sensitivities.forecasts, strict=True):
        if not _is_drawn(forecast):
            continue
        charts = _write_details(page, book, forecast, sensitivities)
        bottom, page.row = page.row, top + _HEADING
        place_rows(page, charts, _FIRST_ROWS, _brief(forecast))
        page.row = bottom
    page.set_up_printing(source.name, printed=printed, columns=(0, CHARTED))


def _printed_sentence(forecasts: int) -> str:
    which = "each forecast" if forecasts <= _PRINTED else f"each of the first {_PRINTED} forecasts"
    return (
        f"Only the first two charts of {which} are printed. The other charts and the numbers of all are below, and "
        "are not printed unless you clear the print area."
    )


def _write_heading(page: Page, forecast: ForecastSensitivity) -> None:
    page.heading(with_units(forecast.forecast, forecast.units))
    if not _is_drawn(forecast):
        page.wide("No assumption is drawn: there is nothing that it could depend on.", "paragraph", _LAST)


def _is_drawn(forecast: ForecastSensitivity) -> bool:
    return bool(forecast.influences or forecast.bars)


def _write_details(
    page: Page, book: Workbook, forecast: ForecastSensitivity, sensitivities: Sensitivities
) -> Sequence[Captioned]:
    """Write the further charts and the tables of a forecast; the first two charts are returned, for the top."""
    page.heading(f"{forecast.forecast}: all numbers")
    top, sobol = page.row, sensitivities.sobol_trials > 0
    count = (4 if forecast.influences else 0) + (2 if forecast.bars else 0)
    page.row += (count // 2 - 1) * (CHART_ROWS + 1)
    influences: Sequence[Captioned] = ()
    moves: Sequence[Captioned] = ()
    if forecast.influences:
        at = _write_table(page, influence_table(forecast, sobol))
        bars = _influence_charts(book, at, forecast, sobol)
        influences = list(zip(bars, influence_captions(forecast, sensitivities.sobol_trials), strict=True))
        _write_rest(page, len(forecast.influences))
    else:
        page.wide(_nothing(forecast), "paragraph", _LAST)
    if forecast.bars:
        page.row += 1
        at = _write_table(page, move_table(forecast))
        moves = list(zip(_move_charts(book, at, forecast), move_captions(forecast), strict=True))
    for drawn, width in ((influences[:1], _BARS_WIDE), (moves[:1], _TORNADO_WIDE)):
        for chart, _ in drawn:
            chart.set_plotarea({"layout": {"x": _NAMES_WIDE, "y": 0.13, "width": width, "height": 0.6}})
    charts = [*influences[:1], *moves[:1], *influences[1:], *moves[1:]]
    bottom, page.row = page.row, top
    place_rows(page, charts[2:])
    page.row = bottom
    return charts[:2]


def _brief(forecast: ForecastSensitivity) -> list[str] | None:
    """Return the captions of its first two charts, if the top of the sheet explains them; otherwise None."""
    if not forecast.bars:
        return None
    tornado = f"Tornado about the base case{base_text(forecast)}."
    return ["Variance explained.", tornado] if forecast.influences else [tornado, SPIDER]


def _nothing(forecast: ForecastSensitivity) -> str:
    return (
        f"It is a number in {counted_text(forecast.trials, 'accepted trial')}: too few to say what "
        "influences it, or it is the same "
        "in all of them, or the draws of the accepted trials were not kept."
    )


def _write_table(page: Page, table: Table) -> TableAt:
    """Write a table; where its rows to draw stand is returned."""
    header = page.row
    write_blocks(page, [table])
    return TableAt(page.name, header, header + 1, header + min(len(table.rows), _DRAWN))


def _write_rest(page: Page, count: int) -> None:
    if count > ROWS:
        page.wide(f"and {count_text(count - ROWS)} more that explain less.", "remark", _LAST)


def _influence_charts(book: Workbook, at: TableAt, sensitivity: ForecastSensitivity, sobol: bool) -> list[ExcelChart]:
    columns = (_EXPLAINED, _TOTAL if sobol else _DEPENDENCE, _RANK, _CONTRIBUTION)
    charts = influence_charts(sensitivity, _DRAWN, sobol=sobol)
    return [
        native_chart(book, chart, [at.series(column, column + 1)])
        for chart, column in zip(charts, columns, strict=True)
    ]


def _move_charts(book: Workbook, at: TableAt, sensitivity: ForecastSensitivity) -> list[ExcelChart]:
    tornado, first, last = tornado_chart(sensitivity, _DRAWN), _CHANGES, _CHANGES + 4
    number = "General" if sensitivity.form == PLAIN else change_format(sensitivity)
    return [
        native_chart(book, tornado, [at.series(first), at.series(last)]),
        spider_chart(book, at, "Spider", tornado.across, first, last, number),
    ]
