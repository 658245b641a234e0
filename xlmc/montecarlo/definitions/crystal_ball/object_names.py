"""The defined names that join Crystal Ball's objects to cells.

`CB_<GUID>` is the cell of an object, and `CBCR_<GUID>` the cell or formula that gives a parameter, a name or a
coefficient. They move with the cells, while the texts inside the objects go stale. A copied sheet has its own.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from xlmc.errors import FormulaError
from xlmc.excel.address import Area, Cell, parse_address
from xlmc.excel.formula import Resolver, ir
from xlmc.excel.formula.parse import parse
from xlmc.excel.formula.precedents import references
from xlmc.excel.workbook.workbook import DefinedName, Workbook
from xlmc.montecarlo.definitions.tables.table_rows import as_text

__all__ = ["ObjectNames", "UnreadableError"]

_OF_OBJECT: Final = re.compile(r"CB_([0-9a-f]{32})", re.IGNORECASE)
_OF_REFERENCE: Final = re.compile(r"CBCR_[0-9a-f]{32}", re.IGNORECASE)
_OF_SHEET: Final = "CBx_Sheet_Guid"
_NO_CELL: Final = ("#REF!", "#N/A")


class UnreadableError(ValueError):
    """The text, the numbers and the names do not say for certain what is drawn."""


class ObjectNames:
    """Looks the names of a workbook up."""

    def __init__(self, workbook: Workbook) -> None:
        self._workbook = workbook
        self._resolver = Resolver(workbook, strict=False)
        self.any = any(_OF_OBJECT.fullmatch(each.name) or _OF_REFERENCE.fullmatch(each.name) for each in workbook.names)

    def cell_of(self, sheet: str, guid: str) -> Cell | None:
        """Return the cell of an object whose block lies on this sheet; None if it was deleted."""
        name = self._workbook.defined_name(f"CB_{guid}", sheet)
        return None if name is None else self._cell(name)

    def objects(self) -> Iterator[tuple[str, str, Cell]]:
        """Return the sheet, the GUID and the cell of every object that has one, as the names say."""
        for name in self._workbook.names:
            match = _OF_OBJECT.fullmatch(name.name)
            if match and (cell := self._cell(name)) is not None:
                yield name.sheet or cell.sheet, match[1].lower(), cell

    def sheets_of(self, guid: str) -> list[str]:
        """Return the sheets that Crystal Ball knows by this GUID: the one, and copies that were made without it."""
        return [
            name.sheet
            for name in self._workbook.names
            if name.sheet is not None
            and name.name.casefold() == _OF_SHEET.casefold()
            and re.sub(r"[^0-9a-f]", "", name.text.lower()) == guid
        ]

    def reference(self, sheet: str, key: str) -> ir.Expression:
        """Return the resolved tree, most often a cell, that a reference of an object on this sheet stands for.

        Raises:
            UnreadableError: there is no such name, or it has lost its cell or leads to another workbook.
        """
        name = self._workbook.defined_name(key, sheet)
        if name is None:
            raise UnreadableError(f"the defined name {key}, which says from which cell, is missing")
        text = name.text.strip().removeprefix("=")
        if any(error in text.upper() for error in _NO_CELL):
            raise UnreadableError(f"the defined name {key} has lost its cell ({text})")
        try:
            tree = self._resolver.tree(parse(text), Cell(sheet, 1, 1))
        except FormulaError as error:
            raise UnreadableError(f"the defined name {key} stands for {text}: {error.message}") from None
        for read in references(tree):
            if read.sheet not in self._workbook.sheets:
                raise UnreadableError(f"the defined name {key} leads to another workbook ({text})")
        if isinstance(tree, Area):
            raise UnreadableError(f"the defined name {key} stands for {text}, more than one cell")
        return tree

    def text(self, tree: ir.Expression) -> str | None:
        """Return the text that a tree of texts, cells and `&` gives; None of any other."""
        match tree:
            case ir.Text():
                return tree.value
            case ir.Number():
                return as_text(tree.value)
            case Cell():
                return as_text(self._workbook.content(tree).value)
            case ir.Binary(operator="&"):
                left, right = self.text(tree.left), self.text(tree.right)
                return None if left is None or right is None else left + right
        return None

    def _cell(self, name: DefinedName) -> Cell | None:
        text = name.text.strip().removeprefix("=")
        if any(error in text.upper() for error in _NO_CELL):
            return None
        try:
            reference = parse_address(text, name.sheet)
        except ValueError:
            return None
        sheet = self._workbook.sheet_named(reference.sheet)
        if sheet is None:
            return None
        if isinstance(reference, Area):  # merged cells
            return Cell(sheet.name, reference.top, reference.left)
        return Cell(sheet.name, reference.row, reference.column)
