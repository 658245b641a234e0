"""The sheet Assumptions: what each one is and why, and beside it how the filters changed it.

Each has three lines: name, units, base case and the draws before filtering; distribution, cell and the accepted draws;
its source, and how mean and standard deviation changed. At their end a small chart shows the shapes of both. So the
sheet lays the rows of `content.assumptions` out itself.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from xlmc.analysis.results.statements.in_words import distribution_text
from xlmc.analysis.results.statements.run_in_words import status
from xlmc.montecarlo.definitions.forms import PLAIN
from xlmc.montecarlo.number_text import count_text
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.colours import DARK, LIGHT
from xlmc.outputs.document.content.assumptions import (
    assumption_change,
    assumption_remarks,
    assumption_rows,
    correlation_blocks,
    meaning_of_marks,
)
from xlmc.outputs.filter_effect import DRAWN, filter_effect_of, shapes_of
from xlmc.outputs.sheets.curves_sheet import SHARE
from xlmc.outputs.sheets.styles import straight
from xlmc.outputs.sheets.xlsx_writer import row_cells, write_blocks
from xlmc.outputs.summary import with_units

if TYPE_CHECKING:
    from xlsxwriter.chart import Chart
    from xlsxwriter.workbook import Workbook

    from xlmc.montecarlo.definitions.definitions import Assumption
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.curves_sheet import Curves, TableAt
    from xlmc.outputs.sheets.page import Page

__all__ = ["HEADER", "WIDTHS", "write_assumptions"]

HEADER = 3
"""The row of the headings, counted from 0."""

_STATISTICS = 10
"""Columns of the mean, the standard deviation and three percentiles, each with its error."""
_NAMED = 3
"""Columns that say what the assumption is: lines begin in the first, the last has its base case and its cell."""
_SHAPE = _NAMED + 2 + _STATISTICS
WIDTHS = (34.5, 9.5, 12.5, 10.5, 7, *(8, 6.1) * (_STATISTICS // 2), 13.5)
_LINES = 3
_ROW = 14.25
_GAP = 6.0
_SIZE = (98, 62)
"""The size of a small chart in pixels: within the cells of three lines."""
_READABLE = _SHAPE
"""The column that paragraphs reach to."""

_HEADS = (
    *("Assumption and its units; distribution; source", "Base case; cell", "Draws", "Trials"),
    *("Mean", "±", "Standard deviation", "±", "5 %", "±", "50 %", "±", "95 %", "±", "Before (pale), accepted (line)"),
)

_CHANGE = (
    "The third line of each assumption has its change: how far the mean moved, in standard deviations of the draws "
    "before filtering (SD), and what part of that standard deviation is left (×)."
)


def write_assumptions(page: Page, book: Workbook, simulation: RunResult, curves: Curves) -> None:
    """Write the sheet; `curves` takes the numbers that its small charts draw."""
    name = simulation.model.workbook.name
    of = f" of {count_text(simulation.trials)}" if simulation.rare is None else ""
    page.title("Assumptions", f"{name}: {count_text(simulation.accepted)}{of} trials accepted")
    page.sheet.set_row(page.row, _GAP)
    page.row = HEADER
    page.height = _ROW
    starts = [0, *range(_NAMED - 1, _NAMED - 1 + len(_HEADS) - 1)]
    looks = ["header left", *["header"] * (len(_HEADS) - 1)]
    heads = _HEADS if simulation.filters_act else (*_HEADS[:-1], "Draws")
    page.line([Shown(head, look=look) for head, look in zip(heads, looks, strict=True)], starts)
    for assumption in simulation.model.assumptions:
        page.may_begin()
        _write_assumption(page, simulation, assumption)
    end = page.row
    page.sheet.freeze_panes(HEADER + 1, 1)
    _draw_shapes(page, book, simulation, curves)
    write_blocks(page, correlation_blocks(simulation), last=_READABLE)
    page.heading("What this shows")
    sentences = [meaning_of_marks(), _CHANGE] if simulation.filters_act else []
    for sentence in (*sentences, *assumption_remarks(simulation)):
        page.wide(sentence, "paragraph", _READABLE)
    page.set_up_printing(name, repeat=HEADER, repeat_to=end)


def _draw_shapes(page: Page, book: Workbook, simulation: RunResult, curves: Curves) -> None:
    """Draw how often each assumption has each value, beside its lines."""
    drawn = []
    for index, assumption in enumerate(simulation.model.assumptions[:DRAWN]):
        shapes = shapes_of(simulation, assumption.name)
        if shapes is not None:
            drawn.append((HEADER + 1 + _LINES * index, assumption.name, shapes))
    if not drawn:
        return
    heads = [f"{name}, {which}" for _, name, _ in drawn for which in ("before", "accepted")]
    bins = np.column_stack([shares for _, _, result in drawn for shares in (result.before, result.accepted)])
    rows = [[Shown(share, SHARE) for share in row] for row in bins.tolist()]
    bottom = page.row
    table = curves.write(["Shapes of the assumptions' draws"], "Share of the draws in each bin", heads, rows)
    page.row = bottom
    for column, (row, name, _) in enumerate(drawn):
        words = f"{name}: before filtering pale, accepted as a line"
        options = {"object_position": 1, "x_offset": 3, "y_offset": 2, "description": words}
        page.sheet.insert_chart(row, _SHAPE, _shape_chart(book, table, 2 * column), options)


def _shape_chart(book: Workbook, table: TableAt, column: int) -> Chart:
    """Chart an assumption without axes, over its two rows: columns before filtering, a line for the accepted draws."""
    chart = book.add_chart({"type": "column"})
    chart.add_series(
        {
            "name": table.heading(column),
            "values": table.column(column),
            "fill": {"color": LIGHT},
            "border": {"none": True},
            "gap": 0,
        }
    )
    line = straight(book.add_chart({"type": "line"}))
    accepted = {"name": table.heading(column + 1), "values": table.column(column + 1)}
    line.add_series({**accepted, "line": {"color": DARK, "width": 1.5}})
    chart.combine(line)
    chart.set_x_axis({"visible": False})
    chart.set_y_axis({"visible": False, "min": 0, "major_gridlines": {"visible": False}})
    chart.set_legend({"none": True})
    chart.set_title({"none": True})
    chart.set_chartarea({"border": {"none": True}, "fill": {"none": True}})
    chart.set_plotarea({"layout": {"x": 0.0, "y": 0.0, "width": 1.0, "height": 1.0}})
    chart.set_size({"width": _SIZE[0], "height": _SIZE[1]})
    return chart


def _write_assumption(page: Page, simulation: RunResult, assumption: Assumption) -> None:
    """Write the lines of an assumption."""
    before, accepted, change = _statistics(simulation, assumption)
    starts = [0, *range(_NAMED - 1, _NAMED + len(before))]
    form = simulation.model.input_forms.get(assumption.name, PLAIN)
    base = Shown(cells.NONE) if assumption.base is None else cells.exact(assumption.base, form=form)
    page.line([Shown(with_units(assumption.name, assumption.units), look="name"), base, *before], starts)
    words = Shown(distribution_text(assumption), look="second")
    page.line([words, Shown(str(assumption.cell), look="second"), *accepted], starts)
    page.line([Shown(assumption.source or cells.NONE), *change], [0, *range(_NAMED, _NAMED + len(change))])


def _statistics(simulation: RunResult, assumption: Assumption) -> tuple[list[Shown], list[Shown], list[Shown]]:
    """Return the cells of the draws before filtering, of the accepted ones and of the change; or why there are none."""
    rows, effect = assumption_rows(simulation, assumption.name), filter_effect_of(simulation, assumption.name)
    second, last = _blank(_STATISTICS + 2, "second"), _blank(_STATISTICS + 2)
    if effect is None:
        why = Shown(status(simulation.model, assumption.name, assumption.frozen))
        return [why, *_blank(_STATISTICS + 1)], second, last
    first, *others = (row_cells(row) for row in rows)
    if not others:
        return first, second, last
    (shift, shift_error), (ratio, ratio_error) = (each.shown for each in assumption_change(effect))
    changes = [
        replace(shift, format=f'{shift.format}" SD"'),
        shift_error,
        replace(ratio, format=f'"× "{ratio.format}'),
        ratio_error,
    ]
    return first, others[0], [Shown("change"), cells.BLANK, *changes, *_blank(_STATISTICS - len(changes))]


def _blank(columns: int, look: str = "number") -> list[Shown]:
    return [Shown(None, look=look)] * columns
