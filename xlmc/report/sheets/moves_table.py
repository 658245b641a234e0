"""Tornado and spider of one forecast: the table, and both charts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from xlmc.report import number_format
from xlmc.report.sheets import cells
from xlmc.report.sheets.bar_charts import tornado_chart
from xlmc.report.sheets.cells import Shown
from xlmc.report.sheets.influence_table import BARS, ROWS
from xlmc.report.sheets.line_charts import MOST_LINES, spider_chart
from xlmc.report.sheets.ranges import TableAt

if TYPE_CHECKING:
    from xlsxwriter.workbook import Workbook

    from xlmc.report.sheets.page import Page
    from xlmc.studies.sensitivity import Bar, ForecastSensitivity

__all__ = ["move_captions", "move_charts", "write_moves"]

_CHANGES: Final = 5
"""The column of the first of the five changes."""


def write_moves(page: Page, found: ForecastSensitivity) -> TableAt:
    """Write the table; where its rows to draw stand is returned."""
    headers = ["Assumption, moved alone", "Units", "Base value", "10 % point", "90 % point"]
    headers += [
        "at 10 %",
        "at 25 %",
        "at 50 %",
        "at 75 %",
        "at 90 %",
        "Only rises or falls",
        "Cases rejected by filters",
    ]
    header, shown = page.row, found.bars[:ROWS]
    page.table(headers, [_row(bar, found.base or 0.0, found.bars[0].span) for bar in shown])
    return TableAt(page.sheet.get_name(), header, header + 1, header + min(len(shown), BARS))


def _row(bar: Bar, base: float, widest: float) -> list[Shown]:
    digits = number_format.exact(bar.inputs[-1] - bar.inputs[0])
    changes = [None if answer is None else answer - base for answer in bar.answers]
    rises = "–" if bar.monotonic is None else "yes" if bar.monotonic else "no"
    return [
        cells.text(bar.assumption, "name"),
        cells.text(bar.units),
        *(Shown(value, digits) for value in (bar.base, bar.inputs[0], bar.inputs[-1])),
        *(Shown(change, number_format.exact(widest)) for change in changes),
        Shown(rises, look="moved" if bar.monotonic is False else "number"),
        Shown(f"{sum(bar.rejected)} of {len(bar.rejected)}", look="number"),
    ]


def move_charts(book: Workbook, at: TableAt, found: ForecastSensitivity) -> list[Any]:
    """Tornado and spider."""
    units = f" ({found.units})" if found.units else ""
    axis = f"Change of the forecast from its base case{units}"
    first, last = _CHANGES, _CHANGES + 4
    return [
        tornado_chart(book, at, "Tornado", axis, first, last),
        spider_chart(book, at, "Spider", f"Change from the base case{units}", first, last),
    ]


def move_captions(found: ForecastSensitivity) -> list[str]:
    """One a chart: what it is and what it is not."""
    at = "" if found.base is None else f" of {found.base:.6g} {found.units}".rstrip()
    bent = any(bar.monotonic is False for bar in found.bars[:BARS])
    tornado = (
        f"Tornado: how far the forecast moves from its base case{at} when one assumption goes to its 10 % or 90 % "
        "point and all others stay at their base values. No trial is behind it: no probability, no filter, no "
        "correlation."
    )
    if bent:
        tornado += " Where the table says that it does not only rise or fall, the bar hides what lies between."
    lines = min(MOST_LINES, len(found.bars))
    spider = (
        f"Spider: the same over five points of each assumption's own distribution before filtering, for the {lines} "
        "that move it most; a bent line is an effect that a correlation describes badly. Steep is not likely: it shows "
        "how the model answers, not what is probable."
    )
    return [tornado, spider]
