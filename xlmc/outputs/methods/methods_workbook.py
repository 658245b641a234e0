"""The further sheets of a study of methods: every run as numbers, and Excel charts with logarithmic axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from xlmc.analysis.studies.methods import STATISTICS, Curve, Runs, Study
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.methods import methods_tables
from xlmc.outputs.methods.excel_charts import DATA, HEADER, write_charts
from xlmc.outputs.sheets.page import Page
from xlmc.outputs.sheets.styles import Styles

if TYPE_CHECKING:
    from xlmc.outputs.document.parts import Table
    from xlmc.outputs.sheets.exact_book import ExactBook

__all__ = ["add_sheets"]

_RUNS: Final = (34.0, 12.0, 8.0, 13.0, 14.0, *[14.0] * 5, 13.0, 10.0, 9.0, 11.0)
_HEADINGS: Final = (
    "Method",
    "Trials",
    "Runs",
    "Time, s",
    "Evaluations",
    *(f"{name}, % of 5–95 %" for name in STATISTICS.values()),
    "Accepted, % of it",
    "Median time, s",
    "Effective trials",
    "Failed runs",
    "Measured",
)


def add_sheets(study: Study, made: ExactBook, styles: Styles) -> None:
    """Add the sheets Charts, Runs, Forecasts and Chart data to the workbook of a study."""
    charts = Page(made.add_worksheet("Charts"), styles, ())
    runs = Page(made.add_worksheet("Runs"), styles, _RUNS)
    forecasts = Page(made.add_worksheet("Forecasts"), styles, (34.0, 10.0, 38.0, 22.0, 22.0, 22.0, 22.0))
    data = Page(made.add_worksheet(DATA), styles, (70.0, 14.0, 14.0, 14.0, 14.0))
    curve_rows = _write_runs(runs, study)
    write_charts(charts, data, made, study, curve_rows)
    _write_forecasts(forecasts, study)


def _write_runs(page: Page, study: Study) -> list[tuple[Curve, int, int]]:
    """Write a row for the runs of each length; gives each curve's first and last row."""
    below = "Root mean square errors over the runs and the forecasts; the charts are drawn from here."
    page.title_of_data("Every run length", below, study.model.workbook.name, HEADER)
    page.row += 1
    page.table(_HEADINGS, ())
    curve_rows = []
    for curve in study.every:
        if not curve.answers:
            continue
        first = page.row
        for runs in curve.lengths:
            page.line(_length_cells(study, curve, runs))
        curve_rows.append((curve, first, page.row - 1))
    page.line([Shown("The reference's own error", look="label"), *[cells.BLANK] * 4, *_floor(study)])
    return curve_rows


def _length_cells(study: Study, curve: Curve, runs: Runs) -> list[Shown]:
    drawn = curve not in study.once
    known = study.reference.acceptance.value
    accepted = None if runs.acceptance is None else 100.0 * runs.acceptance.value / known
    return [
        Shown(curve.method.name, look="name"),
        cells.count(runs.budget) if drawn else cells.BLANK,
        cells.count(max(each.n for each in runs.errors.values())),
        _number(runs.seconds),
        Shown(runs.evaluations, "#,##0"),
        *(_number(100.0 * runs.shares[each]) for each in STATISTICS),
        _number(accepted),
        _number(runs.usual),
        Shown(runs.effective, "#,##0"),
        cells.count(runs.failed),
        Shown("yes" if runs.measured else "by rate"),
    ]


def _floor(study: Study) -> list[Shown]:
    accepted = study.reference.acceptance
    share = None if accepted.error is None else 100.0 * accepted.error / accepted.value
    return [*(_number(100.0 * methods_tables.floor_of(study, each)) for each in STATISTICS), _number(share)]


def _number(value: float | None) -> Shown:
    known = value is not None and np.isfinite(value)
    return Shown(value if known else None, "0.0000")


def _write_forecasts(page: Page, study: Study) -> None:
    table = methods_tables.forecast_table(study)
    page.title("Forecast by forecast", f"{table.title}; ± is the standard error of a root mean square")
    page.row += 1
    page.table(table.heads, [[Shown(str(c), look=_look(i, table)) for i, c in enumerate(row)] for row in table.rows])
    page.set_up_printing(study.model.workbook.name)


def _look(index: int, table: Table) -> str:
    return "name" if index == 0 else "number" if index in table.at_right else "text"
