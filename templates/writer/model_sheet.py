"""Sheet `Model`: the equations, one to a row, each with its value, unit, printed form and source."""

from __future__ import annotations

from collections.abc import Mapping

from xlsxwriter.format import Format
from xlsxwriter.utility import xl_rowcol_to_cell
from xlsxwriter.worksheet import Worksheet

from templates.description import Equation, Role, Template
from templates.notation import printed
from templates.writer.cached import Values
from templates.writer.page import begin_sheet, fit_row, fit_to_pages, protect, repeat_header, write_formula, write_label
from templates.writer.places import HEADER_ROW, VALUE_COLUMN, Place
from templates.writer.styles import Styles

__all__ = ["draw_model"]

_HEADERS = ("Quantity", "Symbol", "Cell name", "Value", "Units", "Equation", "Source", "Note")
_WIDTHS = (48, 14, 16, 11, 9, 57, 24, 67)
_TEXT_COLUMNS = (0, 5, 6, 7)
_LOOK = {Role.STEP: "step", Role.ANSWER: "answer", Role.CHECK: "check"}
_SUBTITLE = (
    "Each value is a named cell. The Equation column prints its formula as {whose} would; "
    "a prime marks an equation rewritten to keep its digits."
)


def draw_model(sheet: Worksheet, styles: Styles, template: Template, at: dict[str, Place], values: Values) -> None:
    """Write the sheet, locked; `values` are what the formulas give at the base case."""
    subtitle = _SUBTITLE.format(whose="a book" if template.group else "the paper")
    begin_sheet(sheet, styles, template.title, subtitle, _WIDTHS)
    for column, header in enumerate(_HEADERS):
        sheet.write_string(HEADER_ROW, column, header, styles("header"))
    notation = {each.symbol: each.symbol for each in template.read}
    notation |= {quantity.symbol: quantity.notation for quantity in (*template.inputs, *template.equations)}
    forecasts = {row.symbol for row in template.forecasts}
    for section in template.sections:
        _draw_band(sheet, styles, section.title, at[section.equations[0].symbol][1] - 1)
        for equation in section.equations:
            look = "answer" if equation.symbol in forecasts else _LOOK[equation.role]
            style = styles(look, equation.number_format)
            _draw_equation(sheet, styles, equation, at[equation.symbol][1], style, values)
            _draw_words(sheet, styles, equation, at[equation.symbol][1], notation, values)
    repeat_header(sheet, HEADER_ROW, 1)
    fit_to_pages(sheet)
    protect(sheet)


def _draw_band(sheet: Worksheet, styles: Styles, title: str, row: int) -> None:
    sheet.set_row(row, 20)
    sheet.write_string(row, 0, title, styles("band"))
    for column in range(1, len(_HEADERS)):
        sheet.write_blank(row, column, None, styles("band"))


def _draw_equation(
    sheet: Worksheet, styles: Styles, equation: Equation, row: int, style: Format, values: Values
) -> None:
    write_formula(sheet, row, VALUE_COLUMN, equation.formula, style, values)
    if equation.role is Role.CHECK:
        cell = xl_rowcol_to_cell(row, VALUE_COLUMN)
        rule = {"type": "formula", "criteria": f"=NOT(IFERROR({cell},FALSE))", "format": styles("wrong")}
        sheet.conditional_format(row, VALUE_COLUMN, row, VALUE_COLUMN, rule)


def _draw_words(
    sheet: Worksheet, styles: Styles, equation: Equation, row: int, notation: Mapping[str, str], values: Values
) -> None:
    texts = equation.name, printed(equation.formula, notation), equation.reference, equation.note
    for column, text in zip(_TEXT_COLUMNS, texts, strict=True):
        write_label(sheet, row, column, text, styles("text"), values)
    fit_row(sheet, row, [(text, _WIDTHS[column]) for column, text in zip(_TEXT_COLUMNS, texts, strict=True)])
    sheet.write_string(row, 1, equation.notation, styles("centred"))
    sheet.write_string(row, 2, equation.symbol, styles("centred"))
    sheet.write_string(row, 4, equation.unit, styles("centred"))
