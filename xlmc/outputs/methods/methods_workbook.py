"""A study of methods as a workbook: the words, the tables as numbers, and Excel charts with logarithmic axes."""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.analysis.studies.methods import STATISTICS, Curve, Runs, Study, recommendation
from xlmc.outputs.methods import methods_tables
from xlmc.outputs.methods.excel_charts import DATA, write_charts
from xlmc.outputs.methods.methods_page import ENDS
from xlmc.outputs.sheets import cells
from xlmc.outputs.sheets.cells import Shown
from xlmc.outputs.sheets.page import Page
from xlmc.outputs.sheets.styles import CREATED, Styles

__all__ = ["book"]

_WORDS: Final = (34.0, *[19.0] * 10, 30.0)
_RUNS: Final = (34.0, 12.0, 8.0, 13.0, 14.0, *[14.0] * 5, 13.0, 10.0, 9.0, 11.0)
_LAST: Final = 8
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


def book(study: Study) -> dict[str, bytes]:
    """Make the parts of the workbook: Methods, Charts, Runs, Forecasts, Chart data."""
    from xlmc.outputs.sheets.exact_book import ExactBook

    with ExactBook() as made:
        made.set_properties({"created": CREATED})
        styles = Styles(made)
        words = Page(made.add_worksheet("Methods"), styles, _WORDS)
        charts = Page(made.add_worksheet("Charts"), styles, ())
        runs = Page(made.add_worksheet("Runs"), styles, _RUNS)
        forecasts = Page(made.add_worksheet("Forecasts"), styles, (34.0, 10.0, 38.0, 22.0, 22.0, 22.0, 22.0))
        data = Page(made.add_worksheet(DATA), styles, (70.0, 14.0, 14.0, 14.0, 14.0))
        _write_words(words, study)
        curve_rows = _write_runs(runs, study)
        write_charts(charts, data, made, study, curve_rows)
        _write_forecasts(forecasts, study)
    parts: dict[str, bytes] = made.parts
    return parts


def _write_words(page: Page, study: Study) -> None:
    name = study.model.workbook.name
    page.title("Methods of uncertainty analysis", name)
    page.row += 1
    for sentence in recommendation(study):
        page.wide(sentence.replace("`", ""), "paragraph", _LAST)
    for table in (
        methods_tables.error_table(study),
        methods_tables.bounds_table(study),
        methods_tables.reference_table(study),
    ):
        if table.rows:
            page.heading(table.title)
            _texts(page, table)
    page.heading("What each method says of itself, and cannot do")
    for method, sentence in methods_tables.cannot_lines(study):
        page.line([Shown(method, look="name"), Shown(sentence)], [0, 1], _LAST)
    ends = methods_tables.ends_lines(study)
    if ends:
        page.heading(ENDS)
    for bound, point in ends:
        page.line([Shown(bound, look="name"), Shown(point)], [0, 1], _LAST)
    page.set_up_printing(name)


def _texts(page: Page, table: methods_tables.Table) -> None:
    rows = [
        [
            Shown(cell, look="name" if index == 0 else "text" if index < table.right else "number")
            for index, cell in enumerate(row)
        ]
        for row in table.rows
    ]
    page.table(table.headings, rows)


def _write_runs(page: Page, study: Study) -> list[tuple[Curve, int, int]]:
    """Write a row for the runs of each length; gives each curve's first and last row."""
    page.title(
        "Every run length", "Root mean square errors over the runs and the forecasts; the charts are drawn from here"
    )
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
    page.set_up_printing(study.model.workbook.name)
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
        cells.exact(runs.evaluations, "#,##0"),
        *(_number(100.0 * runs.shares[each]) for each in STATISTICS),
        _number(accepted),
        _number(runs.usual),
        cells.exact(runs.effective, "#,##0"),
        cells.count(runs.failed),
        Shown("yes" if runs.measured else "by rate"),
    ]


def _floor(study: Study) -> list[Shown]:
    accepted = study.reference.acceptance
    share = None if accepted.error is None else 100.0 * accepted.error / accepted.value
    return [*(_number(100.0 * methods_tables.floor_of(study, each)) for each in STATISTICS), _number(share)]


def _number(value: float | None) -> Shown:
    known = value is not None and np.isfinite(value)
    return cells.exact(value if known else None, "0.0000")


def _write_forecasts(page: Page, study: Study) -> None:
    table = methods_tables.forecast_table(study)
    page.title("Forecast by forecast", f"{table.title}; ± is the standard error of a root mean square")
    page.row += 1
    _texts(page, table)
    page.set_up_printing(study.model.workbook.name)
