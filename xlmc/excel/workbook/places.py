"""Cells of a workbook by what people call them: `Sheet!B4`, `'My sheet'!$B$4:$B$9`, a defined name."""

from __future__ import annotations

from dataclasses import replace

from xlmc.errors import WorkbookError
from xlmc.excel.address import Area, Cell, parse_address
from xlmc.excel.workbook.workbook import Workbook

__all__ = ["area_named", "cell_named", "changeable_cell"]


def area_named(book: Workbook, place: str) -> Area:
    """Return the cells that a place names, as an area: that of a single cell, too.

    Raises:
        KeyError: there is no such sheet or name, or the place is no address.
    """
    text = place.strip()
    name = book.defined_name(text)
    only = next(iter(book.sheets), None) if len(book.sheets) == 1 else None
    try:
        found = parse_address(text if name is None else name.text, only)
    except ValueError as error:
        cure = "write Sheet!Cell, or a defined name that stands for cells"
        raise KeyError(f"{place!r} is no cell of {book.name}: {cure}") from error
    sheet = book.sheet_named(found.sheet)
    if sheet is None:
        raise KeyError(f"there is no sheet {found.sheet!r} in {book.name}; there are {', '.join(book.sheets)}")
    if isinstance(found, Cell):
        return Area(sheet.name, found.row, found.column, found.row, found.column)
    return replace(found, sheet=sheet.name)


def cell_named(book: Workbook, place: str) -> Cell:
    """Return the one cell that a place names.

    Raises:
        KeyError: as for `area_named`, or the place is several cells.
    """
    area = area_named(book, place)
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
