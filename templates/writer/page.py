"""What all sheets share: title, columns, page set-up, tables."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil

from xlsxwriter.format import Format
from xlsxwriter.worksheet import Worksheet

from templates.vehicles import label_formula, names_a_vehicle, shown_label
from templates.writer.cached import Values
from templates.writer.styles import Styles
from xlmc.outputs.sheets.text_lines import line_count

__all__ = [
    "add_table",
    "begin_sheet",
    "fit_row",
    "fit_to_pages",
    "guard",
    "protect",
    "repeat_header",
    "write_formula",
    "write_label",
]

_LINE = 14.5
"""Height of a line of text, in points."""
_POINTS = 0.75
"""In a pixel."""
_LANDSCAPE, _UPRIGHT = (748.0, 547.0), (568.0, 727.0)
"""Width and height of a letter page within the margins, in points."""
_SMALLEST = 0.49
"""The least scale, where that spares a page: letters of 11 points are then 5.4 points high."""
_CERTAIN = 0.96
"""The part of a cell that letters are taken to fill: programs break a line somewhat sooner on paper."""
_INDENT = 1.5
"""The digits that an indent takes."""
_ROOMY = ("Twelve chars",) * 9
"""Names of vehicles for which a row has room."""
_FOLLOWS = "This label follows the name of the {of} at the top of sheet Inputs. Type over it only to change this one."


def begin_sheet(sheet: Worksheet, styles: Styles, title: str, subtitle: str, widths: Sequence[float]) -> None:
    """Title and subtitle in A1 and A2, column widths, head and foot of the printed page."""
    sheet.hide_gridlines(2)
    for column, width in enumerate(widths):
        sheet.set_column(column, column, width)
    sheet.set_row(0, 24)
    sheet.write_string(0, 0, title, styles("title"))
    sheet.write_string(1, 0, subtitle, styles("subtitle"))
    sheet.set_paper(1)
    sheet.set_margins(left=0.3, right=0.3, top=0.45, bottom=0.45)
    sheet.set_header(f"&L{title.replace('&', '&&')}&R&A", {"margin": 0.2})
    sheet.set_footer("&L&F&CPage &P of &N&R&D", {"margin": 0.2})


def fit_to_pages(sheet: Worksheet, rows: int | None = None, *, upright: bool = False) -> None:
    """Print a sheet, once it is written, on as few pages as leave its letters readable.

    The number of pages is said outright, so that it does not depend on the fonts of the computer that prints.

    Args:
        sheet: as it is written.
        rows: how many are printed; by default all.
        upright: whether its pages are higher than wide.
    """
    width = _POINTS * sum(sheet._size_col(column) for column in range(sheet.dim_colmax + 1))
    height = _POINTS * sum(sheet._size_row(row) for row in range(rows or sheet.dim_rowmax + 1))
    across, down = _UPRIGHT if upright else _LANDSCAPE
    if not upright:
        sheet.set_landscape()
    sheet.fit_to_pages(1, ceil(height * min(_SMALLEST, across / width) / down))


def fit_row(sheet: Worksheet, row: int, texts: Sequence[tuple[str, float]]) -> None:
    """Make the row as high as its wrapped texts need; each comes with the width of its column.

    LibreOffice does not do so by itself when it opens the file. There is room for vehicles with longer names.
    """
    lines = max(line_count(shown_label(text, _ROOMY), _CERTAIN * width - _INDENT) for text, width in texts)
    sheet.set_row(row, _LINE * max(lines, 1) + 1)


def repeat_header(sheet: Worksheet, row: int, frozen_columns: int) -> None:
    """Keep everything down to `row` in sight when scrolling, and print that row on every page."""
    sheet.freeze_panes(row + 1, frozen_columns)
    sheet.repeat_rows(row)


def add_table(sheet: Worksheet, styles: Styles, name: str, top: int, headers: Sequence[str], rows: int) -> None:
    """Declare an Excel table of that many rows under its header row `top`; its cells are written by the caller.

    No built-in style and no filter buttons: the cells carry their own look, which LibreOffice shows too.
    """
    columns = [{"header": header, "header_format": styles("header")} for header in headers]
    place = (top, 0, top + rows, len(headers) - 1)
    sheet.add_table(*place, {"name": name, "columns": columns, "style": None, "autofilter": False})


def write_formula(sheet: Worksheet, row: int, column: int, formula: str, style: Format, values: Values) -> None:
    """Write a formula, given without `=`, with its cached value."""
    sheet.write_formula(row, column, f"={formula}", style, values.get((sheet.name, row, column), 0))


def write_label(
    sheet: Worksheet, row: int, column: int, text: str, style: Format, values: Values, *, asks: bool = False
) -> None:
    """Write a text; one that names a vehicle as a formula, with its cached value.

    Args:
        sheet: to write to.
        row: of the cell.
        column: of the cell.
        text: with the vehicles marked.
        style: of the cell.
        values: what formulas give.
        asks: ask before someone types over the formula, on a sheet that is not locked.
    """
    if not names_a_vehicle(text):
        sheet.write_string(row, column, text, style)
        return
    write_formula(sheet, row, column, label_formula(text), style, values)
    if asks:
        of = "phase" if "«phase" in text else "vehicle"
        guard(sheet, (row, column, row, column), "A formula", _FOLLOWS.format(of=of))


def protect(sheet: Worksheet) -> None:
    """Lock the sheet against slips, without a password: Review > Unprotect Sheet opens it."""
    sheet.protect("", {"format_columns": True, "format_rows": True, "objects": True})


def guard(sheet: Worksheet, area: tuple[int, int, int, int], title: str, message: str, *, final: bool = False) -> None:
    """Ask before someone types over formulas on a sheet that must stay open for new rows; refuse where `final`.

    Args:
        sheet: to guard.
        area: first row, first column, last row, last column.
        title: of the message.
        message: why not.
        final: whether to refuse.
    """
    rule = {"validate": "custom", "value": "=FALSE", "error_title": title, "error_message": message}
    sheet.data_validation(*area, rule | {"error_type": "stop" if final else "warning"})
