"""Sheet `Stiffness`: rows of crash tests, what each gives, what all give, and how they scatter."""

from __future__ import annotations

from xlsxwriter.worksheet import Worksheet

from templates.description import Equation, Input, Template
from templates.writer.cached import Values
from templates.writer.page import (
    add_table,
    begin_sheet,
    fit_row,
    fit_to_pages,
    guard,
    repeat_header,
    write_formula,
    write_label,
)
from templates.writer.places import HEADER_ROW, TESTS, VALUE_COLUMN, Place, rows_of_tests
from templates.writer.styles import Styles

__all__ = ["draw_tests"]

_WIDTHS = (44, 13, 16, 13, 11, 14, 11, 9, 12, 10, 13, *(15 for _ in range(10)))
_PARAMETERS = ("Midpoint", "Scale", "Degrees of freedom")
_SCATTER = ("Name", "Symbol", "Cell name", "Value", "Units", "Distribution", *_PARAMETERS, "Frozen", "Source")
_READ = ("Read from them", "", "Cell name", "Value", "Units", "Meaning")
_TALL = 47


def draw_tests(sheet: Worksheet, styles: Styles, template: Template, at: dict[str, Place], values: Values) -> None:
    """Write the sheet; `values` are what the formulas give at the base case."""
    tests = template.tests
    assert tests is not None
    begin_sheet(sheet, styles, template.title, tests.subtitle, _WIDTHS)
    headings = [heading for heading, *_ in (*tests.columns, *tests.computed)]
    _draw_heads(sheet, styles, HEADER_ROW, headings)
    first, entered = HEADER_ROW + 1, len(tests.columns)
    for row in range(first, first + tests.rows):
        for column, (_, shown) in enumerate(tests.columns):
            sheet.write_blank(row, column, None, styles("fixed" if column else "open text", shown))
        for column, (_, formula, shown) in enumerate(tests.computed, entered):
            write_formula(sheet, row, column, formula.replace("{r}", str(row + 1)), styles("step", shown), values)
    last = first + tests.rows - 1
    guard(sheet, (first, entered, last, entered + len(tests.computed) - 1), "A formula", "It follows from the test.")
    sheet.data_validation(first, 1, last, 1, {"validate": "list", "source": [1, 2], "error_message": "Type 1 or 2."})
    read, scatter = rows_of_tests(tests)
    _draw_heads(sheet, styles, read - 1, _READ)
    for row, each in enumerate(tests.read, read):
        _draw_read(sheet, styles, each, row, values)
    guard(sheet, (read, VALUE_COLUMN, read + len(tests.read) - 1, VALUE_COLUMN), "A formula", "Read from the tests.")
    sheet.write_string(scatter - 3, 0, "Scatter of the tests, drawn once there are two of them", styles("heading"))
    sheet.set_row(scatter - 1, _TALL)
    add_table(sheet, styles, "xlmc_assumptions_more", scatter - 1, _SCATTER, len(tests.scatter))
    for given in tests.scatter:
        _draw_scatter(sheet, styles, given, at[given.symbol][1], values)
    repeat_header(sheet, HEADER_ROW, 1)
    fit_to_pages(sheet)
    assert sheet.name == TESTS


def _draw_heads(sheet: Worksheet, styles: Styles, row: int, headings: tuple[str, ...] | list[str]) -> None:
    sheet.set_row(row, _TALL)
    for column, heading in enumerate(headings):
        sheet.write_string(row, column, heading, styles("header"))


def _draw_read(sheet: Worksheet, styles: Styles, each: Equation, row: int, values: Values) -> None:
    write_label(sheet, row, 0, each.name, styles("text"), values, asks=True)
    sheet.write_string(row, 2, each.symbol, styles("centred"))
    write_formula(sheet, row, VALUE_COLUMN, each.formula, styles("step", each.number_format), values)
    sheet.write_string(row, 4, each.unit, styles("centred"))
    sheet.write_string(row, 5, each.note, styles("remark"))
    fit_row(sheet, row, [(each.name, _WIDTHS[0])])


def _draw_scatter(sheet: Worksheet, styles: Styles, given: Input, row: int, values: Values) -> None:
    write_label(sheet, row, 0, given.name, styles("text"), values, asks=True)
    assert given.base is not None
    sheet.write_number(row, VALUE_COLUMN, given.base, styles("assumption", given.number_format))
    for column, text in ((1, given.notation), (2, given.symbol), (4, given.unit), (5, given.distribution)):
        sheet.write_string(row, column, text, styles("centred"))
    for column, heading in enumerate(_PARAMETERS, 6):
        value = given.parameters[heading]
        if isinstance(value, str):
            write_formula(sheet, row, column, value.removeprefix("="), styles("step", "0"), values)
        else:
            sheet.write_number(row, column, value, styles("number", "0"))
    assert isinstance(given.frozen, str)
    write_formula(sheet, row, 9, given.frozen.removeprefix("="), styles("step"), values)
    for column in (8, 9):
        guard(sheet, (row, column, row, column), "A formula", "It follows from the number of tests.")
    sheet.write_string(row, 10, given.source, styles("remark"))
    fit_row(sheet, row, [(given.name, _WIDTHS[0])])
