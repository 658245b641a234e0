"""The sheet Filter limits: how the answers move as each limit of each filter moves.

The charts of all limits come first and are printed; below them each limit has its tables.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from xlmc.montecarlo.definitions.forms import PLAIN
from xlmc.montecarlo.number_text import count_text
from xlmc.outputs.document.charts import (
    acceptance_chart,
    limit_chart,
    limit_chart_of_ranges,
    moved_most,
)
from xlmc.outputs.document.content.limits import (
    NOT_MOVED,
    acceptance_table,
    answers_table,
    limit_heading,
    limit_sentences,
    limit_text,
    moved_caption,
    nothing_moves,
    slopes_table,
)
from xlmc.outputs.sheets.native_charts import native_chart
from xlmc.outputs.sheets.sensitivity_charts import (
    CHART_ROWS,
    CHARTED,
    WIDTHS,
    Captioned,
    TableAt,
    place_rows,
)
from xlmc.outputs.sheets.xlsx_writer import write_blocks

if TYPE_CHECKING:
    from xlsxwriter.workbook import Workbook

    from xlmc.analysis.studies.sensitivity import (
        FilterLimit,
        ForecastSensitivity,
        Sensitivities,
    )
    from xlmc.outputs.sheets.page import Page

__all__ = ["WIDTHS", "write_limits"]

_LAST: Final = len(WIDTHS) - 1
_PRINTED: Final = (
    "Only the changes of the means are printed. The shares of trials accepted, the slopes and the numbers of all "
    "charts are below, and are not printed unless you clear the print area."
)
_FIRST_ROWS: Final = 12
"""Rows of the sheet that each of the first charts covers: a page has room for eight."""
_MOVED: Final = (
    "Charts: how far each forecast's mean moves from that with the limit as it is; whiskers are standard errors of the "
    "change. Other filters and limits stay."
)
_LINES_AT: Final = {"x": 0.14, "y": 0.14, "width": 0.46, "height": 0.56}
"""Where the lines of such a chart stand, in parts of it: LibreOffice would leave them what long names do not take."""
_LIMIT, _CHANGE, _OF_RANGE = 1, 4, 10
"""Columns of the long table."""


def write_limits(page: Page, book: Workbook, sensitivities: Sensitivities, name: str) -> None:
    """Write the sheet; its first charts draw the tables that stand below them, so room is left for them."""
    page.title("Filter limits: how the answers move as each limit moves", name)
    for sentence in (*limit_sentences(sensitivities), f"{_MOVED} {_PRINTED}"):
        page.wide(sentence, "remark", CHARTED)
    forecasts = {each.forecast: each for each in sensitivities.forecasts}
    page.row += 1
    for limit in sensitivities.filter_limits:
        if limit.points and nothing_moves(limit):
            page.wide(_brief(limit), "remark", CHARTED)
    drawn = [limit for limit in sensitivities.filter_limits if limit.points and not nothing_moves(limit)]
    top = page.row
    for _ in range(0, len(drawn), 2):
        page.may_begin()
        page.row += _FIRST_ROWS + 1
    printed = page.row
    charts: list[Captioned] = []
    for limit in sensitivities.filter_limits:
        charts += _write_limit(page, book, limit, forecasts)
    page.row = top
    place_rows(page, charts, _FIRST_ROWS, [_brief(limit) for limit in drawn])
    page.set_up_printing(name, printed=printed, columns=(0, CHARTED))


def _write_limit(
    page: Page, book: Workbook, limit: FilterLimit, forecasts: Mapping[str, ForecastSensitivity]
) -> list[Captioned]:
    """Write a limit's tables, and the chart of the shares above them; that of the changes is returned, for the top."""
    page.heading(limit_heading(limit))
    if not limit.points:
        page.wide(NOT_MOVED, "paragraph", _LAST)
        return []
    top, points = page.row, len(limit.points)
    page.row += CHART_ROWS + 1
    header = page.row
    acceptance = TableAt(page.name, header, header + 1, header + points)
    write_blocks(page, [acceptance_table(limit), slopes_table(limit)])
    page.row += 1
    header = page.row
    firsts = range(header + 1, header + 1 + points * len(limit.slopes), points)
    tables = [TableAt(page.name, header, first, first + points - 1) for first in firsts]
    write_blocks(page, [answers_table(limit, forecasts)])
    bottom, page.row = page.row, top
    place_rows(page, [_acceptance_chart(book, limit, acceptance)])
    page.row = bottom
    return [_moved_chart(book, limit, tables, forecasts)] if tables and not nothing_moves(limit) else []


def _moved_chart(
    book: Workbook, limit: FilterLimit, tables: list[TableAt], forecasts: Mapping[str, ForecastSensitivity]
) -> Captioned:
    indexes = moved_most(limit, forecasts)
    shown = [forecasts[limit.slopes[index].forecast] for index in indexes]
    alike = len({(each.change_units, each.form.affixes) for each in shown}) == 1
    if alike and shown[0].form.factor == 1.0:
        form = shown[0].change_form if any(shown[0].form.affixes) else PLAIN
        chart, value = limit_chart(limit, indexes, shown[0].change_units, form), _CHANGE
    else:
        chart, value = limit_chart_of_ranges(limit, forecasts, indexes), _OF_RANGE
    made = native_chart(book, chart, [tables[index].line(0, (_LIMIT, value, value + 1)) for index in indexes])
    made.set_plotarea({"layout": _LINES_AT})
    return made, moved_caption(limit)


def _acceptance_chart(book: Workbook, limit: FilterLimit, at: TableAt) -> Captioned:
    return native_chart(book, acceptance_chart(limit), [at.line(0, (1, 3, 4))]), _share_caption(limit)


def _brief(limit: FilterLimit) -> str:
    """Return the caption of the same chart where the sheet says once what all of them show."""
    return f"{limit.filter}: as it is, {limit_text(limit)}.{nothing_moves(limit)}"


def _share_caption(limit: FilterLimit) -> str:
    return (
        f"The share of all trials that are accepted with each limit, from {count_text(limit.trials)} "
        "trials; what a looser limit "
        f"adds comes from {count_text(limit.loosened_trials)}."
    )
