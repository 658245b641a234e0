"""The names that people gave to cells, as formulas of one sheet or another may use them."""

from __future__ import annotations

from xlmc.address import Cell, parse_address
from xlmc.workbook.model import DefinedName, Workbook

__all__ = ["Naming"]

_OF_EXCEL = "_xlnm."
"""What the names begin with that Excel gives: of areas to print, of filters."""


class Naming:
    """The defined names of single cells."""

    def __init__(self, workbook: Workbook) -> None:
        self._names: dict[Cell, list[DefinedName]] = {}
        self._local: set[tuple[str, str]] = set()
        for defined in workbook.names:
            if defined.name.casefold().startswith(_OF_EXCEL):
                continue
            if defined.sheet is not None:
                self._local.add((defined.sheet, defined.name.casefold()))
            try:
                place = parse_address(defined.text.replace("$", ""), "")
            except ValueError:
                continue
            if isinstance(place, Cell):
                self._names.setdefault(place, []).append(defined)

    def of(self, cell: Cell, sheet: str) -> str | None:
        """The name that a formula on a sheet may use for a cell; None where there is none.

        A name of another sheet is not known there, and one of the whole workbook is hidden by one of the sheet.
        """
        for defined in self._names.get(cell, ()):
            if defined.sheet == sheet or (
                defined.sheet is None and (sheet, defined.name.casefold()) not in self._local
            ):
                return defined.name
        return None

    def anywhere(self, cell: Cell) -> str:
        """A name of a cell, whatever sheet it is for; empty where it has none."""
        return next((defined.name for defined in self._names.get(cell, ())), "")
