"""Sheet `Evidence`: readings of what the model computes, with their errors."""

from __future__ import annotations

from xlsxwriter.worksheet import Worksheet

from templates.description import EvidenceRow, Template
from templates.vehicles import names_a_vehicle
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
from templates.writer.places import HEADER_ROW, VALUE_COLUMN, Place, reference
from templates.writer.styles import Styles

__all__ = ["draw_evidence"]

_OFF_BY = ("Plus or minus", "Std dev", "Percent", "Resolution")
_HEADERS = ("Name", "Cell", "Units", "Reading", "Error", *_OFF_BY, "Use", "Source")
_WIDTHS = (44, 16, 11, 11, 13, 13, 11, 11, 12, 9, 72)
_ERRORS = ("Uniform", "Instrument", "Normal", "Lognormal", "At least", "At most")
_SUBTITLE = (
    "What was measured of the crash itself. A row is used once it has a reading, unless Use is FALSE. "
    "Decide how far a reading may be off before you look at the answers, and use each fact once."
)
_POINTS = "This formula says which quantity was read. Change it only to name another one."


def draw_evidence(sheet: Worksheet, styles: Styles, template: Template, at: dict[str, Place], values: Values) -> None:
    """Write the sheet; `values` are what the formulas give at the base case."""
    begin_sheet(sheet, styles, template.title, _SUBTITLE, _WIDTHS)
    sheet.set_row(HEADER_ROW, 32)
    add_table(sheet, styles, "xlmc_evidence", HEADER_ROW, _HEADERS, len(template.evidence))
    quantities = {equation.symbol: equation for equation in template.equations}
    for row, reading in enumerate(template.evidence, HEADER_ROW + 1):
        quantity = quantities[reading.symbol]
        write_formula(sheet, row, 1, reference(at[reading.symbol]), styles("step", quantity.number_format), values)
        look = "text" if names_a_vehicle(reading.name) else "open text"
        write_label(sheet, row, 0, reading.name, styles(look), values, asks=True)
        _draw_reading(sheet, styles, reading, quantity.unit, row)
    first, last = HEADER_ROW + 1, HEADER_ROW + len(template.evidence)
    guard(sheet, (first, 1, last, 1), "A formula", _POINTS)
    _offer(sheet, first, last, "Error", _ERRORS)
    _offer(sheet, first, last, "Use", ("TRUE", "FALSE"))
    repeat_header(sheet, HEADER_ROW, 1)
    fit_to_pages(sheet)


def _draw_reading(sheet: Worksheet, styles: Styles, reading: EvidenceRow, unit: str, row: int) -> None:
    sheet.write_string(row, 2, unit, styles("centred"))
    numbers = (reading.reading, *(reading.off_by.get(header) for header in _OFF_BY))
    for column, value in zip((VALUE_COLUMN, 5, 6, 7, 8), numbers, strict=True):
        if value is None:
            sheet.write_blank(row, column, None, styles("number"))
        else:
            sheet.write_number(row, column, value, styles("number"))
    sheet.write_string(row, 4, reading.error, styles("open centred"))
    if reading.use:
        sheet.write_blank(row, 9, None, styles("open centred"))
    else:
        sheet.write_string(row, 9, "FALSE", styles("open centred"))
    sheet.write_string(row, 10, reading.source, styles("open text"))
    fit_row(sheet, row, [(reading.name, _WIDTHS[0]), (reading.source, _WIDTHS[10])])


def _offer(sheet: Worksheet, first: int, last: int, header: str, choices: tuple[str, ...]) -> None:
    column = _HEADERS.index(header)
    sheet.data_validation(first, column, last, column, {"validate": "list", "source": list(choices)})
