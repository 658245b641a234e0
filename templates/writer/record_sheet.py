"""Sheet `Record`: a table of a recorder or a video, pasted as it is, and what is read from it."""

from __future__ import annotations

from xlsxwriter.worksheet import Worksheet

from templates.description import Template
from templates.writer.cached import Values
from templates.writer.page import begin_sheet, fit_row, fit_to_pages, guard, repeat_header, write_formula
from templates.writer.places import HEADER_ROW, RECORD, RECORD_VALUES, Place
from templates.writer.styles import Styles

__all__ = ["draw_record"]

_PASTED, _COMPUTED, _BETWEEN = 10, 9, 3
"""Widths of columns."""
_READ = ((42, "Read from it"), (10, "Value"), (13, "Cell name"), (48, "Meaning"))
"""Width and heading of the columns of what is read."""
_TALL = 47


def draw_record(sheet: Worksheet, styles: Styles, template: Template, at: dict[str, Place], values: Values) -> None:
    """Write the sheet: columns to paste into, what each row says, and beside them what all say, a named cell each."""
    table = template.record
    assert table is not None
    read = RECORD_VALUES - 1
    widths = [_PASTED] * table.width + [_COMPUTED] * len(table.computed)
    widths += [_BETWEEN] * (read - len(widths)) + [width for width, _ in _READ]
    between = len(table.computed) + table.width
    begin_sheet(sheet, styles, template.title, table.subtitle, widths)
    if between < read:
        sheet.set_column(between, read - 1, _BETWEEN, None, {"hidden": True})
    sheet.set_row(HEADER_ROW, _TALL)
    for column in range(table.width):
        heading = table.columns[column] if column < len(table.columns) else ""
        sheet.write_string(HEADER_ROW, column, heading, styles("header"))
    for column, (heading, _, _) in enumerate(table.computed, table.width):
        sheet.write_string(HEADER_ROW, column, heading, styles("header"))
    for column, (_, heading) in enumerate(_READ, read):
        sheet.write_string(HEADER_ROW, column, heading, styles("header"))
    first = HEADER_ROW + 1
    for row in range(first, first + table.rows):
        for column in range(table.width):
            sheet.write_blank(row, column, None, styles("assumption", "General"))
        for column, (_, formula, shown) in enumerate(table.computed, table.width):
            write_formula(sheet, row, column, formula.replace("{r}", str(row + 1)), styles("step", shown), values)
    last = first + table.rows - 1
    guard(sheet, (first, table.width, last, table.width + len(table.computed) - 1), "A formula", "It reads the table.")
    for each in table.read:
        row = at[each.symbol][1]
        write_formula(sheet, row, RECORD_VALUES, each.formula, styles("step", each.number_format), values)
        for column, text in ((read, each.name), (read + 2, each.symbol), (read + 3, each.note)):
            sheet.write_string(row, column, text, styles("text"))
        fit_row(sheet, row, [(each.name, _READ[0][0]), (each.note, _READ[3][0])])
    guard(sheet, (first, RECORD_VALUES, first + len(table.read) - 1, RECORD_VALUES), "A formula", "It reads the table.")
    repeat_header(sheet, HEADER_ROW, 0)
    fit_to_pages(sheet)
    assert sheet.name == RECORD
