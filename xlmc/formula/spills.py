"""Cells that hold no formula and yet are computed: those that an array formula in another cell fills."""

from __future__ import annotations

from xlmc.address import Area, Cell
from xlmc.workbook.model import Sheet, Workbook

__all__ = ["Spills"]


class Spills:
    """Array formulas of a workbook by what they fill; a sheet is looked through when it is first asked about."""

    def __init__(self, workbook: Workbook) -> None:
        self._workbook = workbook
        self._areas: dict[str, list[tuple[Area, Cell]]] = {}

    def anchor(self, cell: Cell) -> Cell | None:
        """The cell whose array formula fills this other one; None where there is none."""
        if cell.sheet not in self._areas:
            sheet = self._workbook.sheets.get(cell.sheet)
            self._areas[cell.sheet] = [] if sheet is None else _filled(sheet)
        return next((anchor for area, anchor in self._areas[cell.sheet] if cell in area and cell != anchor), None)


def _filled(sheet: Sheet) -> list[tuple[Area, Cell]]:
    formulas = ((Cell(sheet.name, *place), content.formula) for place, content in sheet.cells.items())
    arrays = ((formula.array, cell) for cell, formula in formulas if formula is not None and formula.array is not None)
    return [(area, cell) for area, cell in arrays if area.rows * area.columns > 1]
