"""What a formula that reads another workbook means: the sheets and names of which Excel stored something."""

from __future__ import annotations

from typing import Final

from xlmc.address import Cell
from xlmc.errors import FormulaError
from xlmc.formula import ir
from xlmc.workbook.model import DefinedName, LinkedBook, Workbook

__all__ = ["COPY", "linked_name", "linked_sheet", "meant_book"]

COPY: Final = "copy the value into this workbook; links are not followed"
"""The hint for what is not stored."""

_THIS: Final = "[0]"


def meant_book(workbook: Workbook, book: str | None, around: str | None) -> str | None:
    """The linked workbook that a prefix means; None of this one.

    Args:
        workbook: whose formula it is.
        book: the prefix.
        around: the linked workbook whose name is being read, if any.

    Raises:
        FormulaError: there is no such link.
    """
    if book is None:
        return around
    if book == _THIS:
        return None
    if book not in workbook.links:
        raise FormulaError("refers to another workbook", hint=COPY)
    return book


def linked_sheet(workbook: Workbook, book: str, name: str | None, host: Cell) -> str:
    """A sheet of a linked workbook, or the host's own.

    Raises:
        FormulaError: nothing of it is stored.
    """
    linked = workbook.links[book]
    sheets = {title.casefold(): title for title in linked.sheets}
    found = sheets.get((host.sheet if name is None else f"{book}{name}").casefold())
    if found is None:
        raise FormulaError(f"refers to {_name_of(linked)}, of which no values are stored", hint=COPY)
    return found


def linked_name(workbook: Workbook, book: str, name: ir.Name) -> DefinedName:
    """A name of a linked workbook: the sheet's own first, then the workbook's, then the only one.

    Raises:
        FormulaError: what it stands for is not stored.
    """
    linked = workbook.links[book]
    named = {(n.sheet and n.sheet.casefold()): n for n in linked.names if n.name.casefold() == name.name.casefold()}
    scope = None if name.sheet is None else f"{book}{name.sheet}".casefold()
    only = next(iter(named.values())) if len(named) == 1 and scope is None else None
    found = named.get(scope) or named.get(None) or only
    if found is None:
        raise FormulaError(f"refers to {name.name!r} of {_name_of(linked)}, which is not stored", hint=COPY)
    return found


def _name_of(linked: LinkedBook) -> str:
    return linked.file or "another workbook"
