"""What stands in the cells that a run needed, as texts to keep and to compare."""

from __future__ import annotations

from collections.abc import Container
from typing import TYPE_CHECKING, Final

from xlmc.address import Area, Cell, host_of
from xlmc.definitions.tables.tables import KINDS
from xlmc.errors import ErrorCode
from xlmc.formula.shape import text_at
from xlmc.results.record.wording import number_text
from xlmc.workbook.model import CellValue, Formula

if TYPE_CHECKING:
    from xlmc.run.model import Model
    from xlmc.workbook.model import Workbook

__all__ = ["SAVED", "content_text", "definition_cells", "needed_contents"]

SAVED: Final = "  (Excel saved "
"""What stands between the formula of a cell that xlmc cannot compute and the value that was used for it."""


def needed_contents(model: Model) -> dict[Cell, str]:
    """The cells that a run of the model is a function of, with their contents, by sheets, rows and columns.

    These are the cells that forecasts and filters read, those of assumptions and of their data, and the reserved
    tables. Blank cells are left out.
    """
    workbook, saved = model.workbook, model.saved
    cells = {host_of(cell) for cell in model.read} | {host_of(a.cell) for a in model.assumptions}
    cells |= definition_cells(workbook)
    for assumption in model.assumptions:
        if assumption.data is not None:
            cells.update(_held(workbook, assumption.data.area))
    linked = sorted({cell.sheet for cell in cells if cell.sheet not in workbook.sheets and workbook.sheet_of(cell)})
    places = {name: place for place, name in enumerate((*workbook.sheets, *linked))}
    known = (cell for cell in cells if cell.sheet in places)
    found = {}
    for cell in sorted(known, key=lambda cell: (places[cell.sheet], cell)):
        if text := content_text(workbook, cell, saved):
            found[cell] = text
    return found


def definition_cells(workbook: Workbook) -> set[Cell]:
    """The cells of the reserved tables that hold something, headings among them."""
    areas = (table.area for table in workbook.tables if table.name.casefold().startswith(KINDS))
    return {cell for area in areas for cell in _held(workbook, area)}


def content_text(workbook: Workbook, cell: Cell, saved: Container[Cell] = ()) -> str:
    """What a cell holds, as a formula would write it: `=A1*2`, `6661`, `"text"`, `TRUE`, `#N/A`; empty if it is blank.

    Args:
        workbook: that it stands in.
        cell: to look at.
        saved: the cells whose saved values a run uses although they hold formulas.
    """
    content = workbook.content(cell)
    if content.formula is None:
        return value_text(content.value)
    written = _formula_text(content.formula, cell)
    return f"{written}{SAVED}{value_text(content.value)})" if cell in saved else written


def value_text(value: CellValue) -> str:
    """A value as a formula writes it."""
    match value:
        case None:
            return ""
        case bool():
            return "TRUE" if value else "FALSE"
        case ErrorCode():
            return value.text
        case str():
            doubled = value.replace('"', '""')
            return f'"{doubled}"'
        case _:
            return number_text(value)


def _formula_text(formula: Formula, cell: Cell) -> str:
    if formula.array is not None and not formula.dynamic:
        return f"{{={formula.text}}} in {formula.array.a1}"
    return f"={text_at(formula.text, cell.row - formula.row, cell.column - formula.column)}"


def _held(workbook: Workbook, area: Area) -> list[Cell]:
    """The cells of an area that hold something."""
    sheet = workbook.sheet_of(area)
    if sheet is None:
        return []
    places = sheet.cells.keys()
    if area.rows * area.columns > len(places):
        return [cell for cell in (Cell(area.sheet, *place) for place in places) if cell in area]
    return [cell for cell in area.cells() if cell[1:] in places]
