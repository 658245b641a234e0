"""Cells of a workbook by what people call them: `Sheet!B4`, `'My sheet'!$B$4:$B$9`, `Sheet!B:D`, a defined name."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Final

from xlmc.errors import WorkbookError
from xlmc.excel.address import MAX_COLUMN, MAX_ROW, Area, Cell, column_letters, parse_address
from xlmc.excel.workbook.workbook import Sheet, Workbook

__all__ = ["area_named", "cell_named", "changeable_cell"]

_COLUMNS: Final = re.compile(r"(?P<sheet>.*!)?\$?(?P<first>[A-Za-z]{1,3}):\$?(?P<last>[A-Za-z]{1,3})", re.DOTALL)
_ROWS: Final = re.compile(r"(?P<sheet>.*!)?\$?(?P<first>[1-9]\d{0,6}):\$?(?P<last>[1-9]\d{0,6})", re.DOTALL)
_LARGE: Final = 100_000
"""Cells from which on an area ends with the last filled ones, as whole columns and rows do."""


def area_named(book: Workbook, place: str) -> Area:
    """Return the cells that a place names, as an area: that of a single cell, too.

    Whole columns and rows, and very large areas, end with the last row and column of the sheet that hold anything.

    Raises:
        KeyError: there is no such sheet or name, the place is no address, or nothing stands in a whole column.
    """
    area = _area(book, place)
    whole = area.rows == MAX_ROW or area.columns == MAX_COLUMN
    if not whole and area.rows * area.columns <= _LARGE:
        return area
    bottom, right = _last_used(book.sheets[area.sheet])
    if bottom < area.top or right < area.left:
        raise KeyError(f"{place!r} holds nothing")
    return replace(area, bottom=min(area.bottom, bottom), right=min(area.right, right))


def _last_used(sheet: Sheet) -> tuple[int, int]:
    """Return the last row and the last column of a sheet that hold anything, or are filled by a formula."""
    filled = [at for at, content in sheet.cells.items() if not content.is_blank]
    filled += [(area.bottom, area.right) for area in sheet.arrays.values()]
    filled += [(table.area.bottom, table.area.right) for table in sheet.data_tables]
    return max((row for row, _ in filled), default=0), max((column for _, column in filled), default=0)


def _area(book: Workbook, place: str) -> Area:
    """Return the area of a place as it is written; raises `KeyError` as `area_named` does."""
    text = place.strip()
    name = book.defined_name(text)
    only = next(iter(book.sheets), None) if len(book.sheets) == 1 else None
    try:
        reference = parse_address(_with_corners(text if name is None else name.text), only)
    except ValueError as error:
        cure = "write Sheet!Cell, or a defined name that stands for cells"
        raise KeyError(f"{place!r} is no cell of {book.name}: {cure}") from error
    sheet = book.sheet_named(reference.sheet)
    if sheet is None:
        raise KeyError(f"there is no sheet {reference.sheet!r} in {book.name}; there are {', '.join(book.sheets)}")
    if isinstance(reference, Cell):
        return Area(sheet.name, reference.row, reference.column, reference.row, reference.column)
    return replace(reference, sheet=sheet.name)


def _with_corners(text: str) -> str:
    """Write whole columns and rows as areas: `Sheet!B:D` as `Sheet!B1:D1048576`; any other text stays."""
    if columns := _COLUMNS.fullmatch(text):
        return f"{columns['sheet'] or ''}{columns['first']}1:{columns['last']}{MAX_ROW}"
    if rows := _ROWS.fullmatch(text):
        return f"{rows['sheet'] or ''}A{rows['first']}:{column_letters(MAX_COLUMN)}{rows['last']}"
    return text


def cell_named(book: Workbook, place: str) -> Cell:
    """Return the one cell that a place names.

    Raises:
        KeyError: as for `area_named`, or the place is several cells.
    """
    area = _area(book, place)
    if area.rows * area.columns > 1:
        raise KeyError(f"{place!r} is not one cell, but {area}")
    return Cell(area.sheet, area.top, area.left)


def changeable_cell(book: Workbook, place: str) -> Cell:
    """Return the cell that a place names, where something else may be typed into it.

    Raises:
        KeyError: as for `cell_named`.
        WorkbookError: a formula stands in it or fills it, a what-if table does, or it is hidden by a merged cell.
    """
    cell = cell_named(book, place)
    sheet, hint = book.sheets[cell.sheet], "Change the cells that it is computed from"
    if book.content(cell).formula is not None:
        raise WorkbookError("the cell holds a formula, which a value would replace", where=cell, hint=hint)
    for anchor, area in sheet.arrays.items():
        if cell in area:
            raise WorkbookError(f"the array formula in {anchor} fills the cell", where=cell, hint=hint)
    if any(cell in table.area for table in sheet.data_tables):
        raise WorkbookError("a what-if table fills the cell", where=cell, hint=hint)
    for merged in sheet.merged:
        first = Cell(cell.sheet, merged.top, merged.left)
        if cell in merged and cell != first:
            raise WorkbookError("the cell is hidden by a merged one", where=cell, hint=f"Change {first}")
    return cell
