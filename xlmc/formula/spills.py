"""Cells that hold no formula and yet are computed: those that an array formula in another cell fills."""

from __future__ import annotations

from typing import Final

from xlmc.address import Area, Cell
from xlmc.workbook.model import Sheet, Workbook

__all__ = ["Spills"]


_MOST_LISTED: Final = 10_000
"""Cells of an array formula that are listed one by one."""


class Spills:
    """Array formulas of a workbook by what they fill; a sheet is looked through when it is first asked about."""

    def __init__(self, workbook: Workbook) -> None:
        self._workbook = workbook
        self._sheets: dict[str, tuple[dict[Cell, Cell], list[tuple[Area, Cell]]]] = {}

    def anchor(self, cell: Cell) -> Cell | None:
        """The cell whose array formula fills this other one; None where there is none."""
        if cell.sheet not in self._sheets:
            sheet = self._workbook.sheets.get(cell.sheet)
            self._sheets[cell.sheet] = ({}, []) if sheet is None else _filled(sheet)
        listed, large = self._sheets[cell.sheet]
        if cell in listed:
            return listed[cell]
        return next((anchor for area, anchor in large if cell in area and cell != anchor), None) if large else None


def _filled(sheet: Sheet) -> tuple[dict[Cell, Cell], list[tuple[Area, Cell]]]:
    """The anchors of the cells that array formulas fill, and large areas with theirs."""
    listed: dict[Cell, Cell] = {}
    large = []
    for place, content in sheet.cells.items():
        area = None if content.formula is None else content.formula.array
        if area is None or area.rows * area.columns == 1:
            continue
        anchor = Cell(sheet.name, *place)
        if area.rows * area.columns > _MOST_LISTED:
            large.append((area, anchor))
        else:
            for cell in area.cells():
                if cell != anchor:
                    listed.setdefault(cell, anchor)
    return listed, large
