"""Sheet `Guide`: how to use the workbook, when not to, published data, departures from the source."""

from __future__ import annotations

from xlsxwriter.worksheet import Worksheet

from templates.description import GuideSection, Template
from templates.writer.cached import Values
from templates.writer.page import begin_sheet, fit_row, fit_to_pages, protect, write_label
from templates.writer.styles import Styles, legend

__all__ = ["draw_guide"]

_WIDTHS = (46, 130)
_GAP = 6.0


def draw_guide(sheet: Worksheet, styles: Styles, template: Template, values: Values) -> None:
    """Write the sheet: section titles in the margin, text beside them; `values` are what its formulas give."""
    begin_sheet(sheet, styles, template.title, "Guide", _WIDTHS)
    row = _draw_legend(sheet, styles, template, 3)
    for section in template.guide:
        sheet.set_row(row - 1, _GAP)
        row = _draw_section(sheet, styles, section, row, values)
    fit_to_pages(sheet, upright=True)
    protect(sheet)


def _draw_legend(sheet: Worksheet, styles: Styles, template: Template, row: int) -> int:
    """Write what the colours mean from `row` on; the first free row, after a blank one, is returned."""
    sheet.write_string(row, 0, "Colours", styles("margin"))
    for number, (look, colour, meaning) in enumerate(legend(template.checks), row + 1):
        sheet.write_string(number, 0, colour, styles(look, centred=True))
        sheet.write_string(number, 1, meaning, styles("text"))
    return row + len(legend(template.checks)) + 2


def _draw_section(sheet: Worksheet, styles: Styles, section: GuideSection, row: int, values: Values) -> int:
    sheet.write_string(row, 0, section.title, styles("margin"))
    for number, paragraph in enumerate(section.paragraphs):
        write_label(sheet, row, 1, paragraph, styles("paragraph"), values)
        fit_row(sheet, row, [(paragraph, _WIDTHS[1]), ("" if number else section.title, _WIDTHS[0] - 4)])
        row += 1
    for number, texts in enumerate(section.rows):
        for column, text in enumerate(texts):
            write_label(sheet, row, column, text, styles("text" if number else "header"), values)
        fit_row(sheet, row, list(zip(texts, _WIDTHS, strict=True)))
        row += 1
    return row + 1
