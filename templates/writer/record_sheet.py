"""Sheet `Record`: the pre-crash table of a recorder, pasted as it is, and what is read from it."""

from __future__ import annotations

from xlsxwriter.worksheet import Worksheet

from templates.description import Template
from templates.writer.cached import Values
from templates.writer.page import begin_sheet, fit_to_pages, guard, repeat_header, write_formula
from templates.writer.places import HEADER_ROW, RECORD, VALUE_COLUMN, Place
from templates.writer.styles import Styles

__all__ = ["draw_record"]

_SUBTITLE = (
    "Paste the pre-crash table of the report here: times, speeds, brake. Blank: sheet Inputs says what was recorded."
)
_WIDTHS = (16, 16, 20, 14, 50, 14, 70)
"""Time, speed and brake; then the values, with what they are."""


def draw_record(sheet: Worksheet, styles: Styles, template: Template, at: dict[str, Place], values: Values) -> None:
    """Write the sheet: columns to paste into, and beside them what is read from them, a named cell each."""
    table = template.record
    assert table is not None
    begin_sheet(sheet, styles, template.title, _SUBTITLE, _WIDTHS)
    for column, header in enumerate((*table.columns, "Read from it", "Cell name", "Meaning")):
        sheet.write_string(HEADER_ROW, column if column < len(table.columns) else column + 1, header, styles("header"))
    sheet.write_string(HEADER_ROW, VALUE_COLUMN, "Value", styles("header"))
    for row in range(HEADER_ROW + 1, HEADER_ROW + 1 + table.rows):
        for column in range(len(table.columns)):
            sheet.write_blank(row, column, None, styles("assumption", "General"))
    for each in table.read:
        row = at[each.symbol][1]
        write_formula(sheet, row, VALUE_COLUMN, each.formula, styles("step", each.number_format), values)
        for column, text in ((4, each.name), (5, each.symbol), (6, each.note)):
            sheet.write_string(row, column, text, styles("text"))
    first, last = HEADER_ROW + 1, HEADER_ROW + len(table.read)
    guard(sheet, (first, VALUE_COLUMN, last, VALUE_COLUMN), "A formula", "This is read from the table on the left.")
    repeat_header(sheet, HEADER_ROW, 0)
    fit_to_pages(sheet)
    assert sheet.name == RECORD
