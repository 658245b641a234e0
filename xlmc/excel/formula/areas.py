"""What references mean: cells and areas seen from a host cell, parts of a table, cells of another workbook."""

from __future__ import annotations

from typing import Final

from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import MAX_COLUMN, MAX_ROW, Area, Cell
from xlmc.excel.formula import ir
from xlmc.excel.workbook.workbook import DefinedName, LinkedBook, Table, Workbook

__all__ = [
    "COPY",
    "as_area",
    "cells_of",
    "combine",
    "is_far",
    "linked_name",
    "linked_sheet",
    "meant_book",
    "seen_from",
    "table_rows",
]

_REF: Final = ir.ErrorLiteral(ErrorCode.REF)
_NULL: Final = ir.ErrorLiteral(ErrorCode.NULL)

_FAR: Final = 10_000
"""Empty rows at the end of a range that are counted instead of read."""

_Position = tuple[int | None, int | None]
"""Row and column; None for all of them."""


def seen_from(
    tree: ir.Reference, sheet: str, host: Cell, origin: tuple[int, int], *, wraps: bool
) -> Cell | Area | ir.ErrorLiteral:
    """Return what a reference means in one cell; `#REF!` off the sheet.

    Args:
        tree: the reference.
        sheet: that it leads to.
        host: the cell in which the formula stands.
        origin: row and column of the cell for which the formula is written.
        wraps: relative references go around the edge of the sheet, as they do in names.
    """
    first, last = (_position(corner, host, origin) for corner in (tree.first, tree.last or tree.first))
    if wraps:
        first, last = _wrap(first), _wrap(last)
    if not (_inside(first) and _inside(last)):
        return _REF
    top, bottom = _sorted(first[0], last[0]) or (1, MAX_ROW)
    left, right = _sorted(first[1], last[1]) or (1, MAX_COLUMN)
    return cells_of(sheet, top, left, bottom, right)


def _position(corner: ir.Corner, host: Cell, origin: tuple[int, int]) -> _Position:
    """Row and column of a corner as the host sees it; it may lie off the sheet."""
    row, column = corner.row, corner.column
    if row is not None and not corner.row_fixed:
        row += host.row - origin[0]
    if column is not None and not corner.column_fixed:
        column += host.column - origin[1]
    return row, column


def _inside(position: _Position) -> bool:
    row, column = position
    return (row is None or 1 <= row <= MAX_ROW) and (column is None or 1 <= column <= MAX_COLUMN)


def _wrap(position: _Position) -> _Position:
    row, column = position
    return (
        None if row is None else (row - 1) % MAX_ROW + 1,
        None if column is None else (column - 1) % MAX_COLUMN + 1,
    )


def _sorted(first: int | None, last: int | None) -> tuple[int, int] | None:
    return None if first is None or last is None else (min(first, last), max(first, last))


def cells_of(sheet: str, top: int, left: int, bottom: int, right: int) -> Cell | Area:
    """Return the area between two corners; one cell is a `Cell`."""
    if top == bottom and left == right:
        return Cell(sheet, top, left)
    return Area(sheet, top, left, bottom, right)


def is_far(end: int, used: int, most: int) -> bool:
    """Whether an area goes on far beyond the last filled row or column: to the edge of the sheet, or nearly so.

    Args:
        end: the area's last row, or column.
        used: the last that is filled.
        most: the last of the sheet.
    """
    return end > used and (end == most or end - used > _FAR)


def combine(operator: str, left: ir.Expression, right: ir.Expression) -> ir.Expression:
    """Join two resolved trees by an operation, of which `:` and the blank give an area.

    Raises:
        FormulaError: `:` or the blank stands between what gives no references.
    """
    if operator not in (":", " "):
        return ir.Binary(operator, left, right)
    for part in (left, right):
        if isinstance(part, ir.ErrorLiteral):
            return part
    if not isinstance(left, Cell | Area) or not isinstance(right, Cell | Area):
        if all(isinstance(part, Cell | Area | ir.Call | ir.Variable) for part in (left, right)):
            return ir.Binary(operator, left, right)  # OFFSET(…):B9 is known only when its arguments are
        name = "range (:)" if operator == ":" else "intersection (a blank)"
        raise FormulaError(f"the {name} operator needs references on both sides", hint="is an operator missing?")
    a, b = as_area(left).whole, as_area(right).whole
    if a.sheet != b.sheet:
        return ir.ErrorLiteral(ErrorCode.VALUE)
    if operator == ":":
        top, start = min(a.top, b.top), min(a.left, b.left)
        return cells_of(a.sheet, top, start, max(a.bottom, b.bottom), max(a.right, b.right))
    top, start, bottom, end = max(a.top, b.top), max(a.left, b.left), min(a.bottom, b.bottom), min(a.right, b.right)
    return cells_of(a.sheet, top, start, bottom, end) if top <= bottom and start <= end else _NULL


def as_area(reference: Cell | Area) -> Area:
    """Turn the reference into an area, of one cell if it is one."""
    if isinstance(reference, Area):
        return reference
    return Area(reference.sheet, reference.row, reference.column, reference.row, reference.column)


def table_rows(table: Table, items: tuple[str, ...], host: Cell) -> tuple[int, int] | None:
    """First and last row that the items of a structured reference name; None if the table has no such row.

    Raises:
        FormulaError: an item is none of Excel's.
    """
    area, body = table.area, table.body
    if "#this row" in items:
        inside = host.sheet == body.sheet and body.top <= host.row <= body.bottom
        return (host.row, host.row) if inside else None
    spans = {
        "#all": (area.top, area.bottom),
        "#data": (body.top, body.bottom),
        "#headers": (area.top, body.top - 1),
        "#totals": (body.bottom + 1, area.bottom),
    }
    unknown = [item for item in items if item not in spans]
    if unknown:
        hint = "use #All, #Data, #Headers, #Totals or #This Row"
        raise FormulaError(f"a table has no part {unknown[0]!r}", hint=hint)
    named = [spans[item] for item in items or ("#data",)]
    top, bottom = min(span[0] for span in named), max(span[1] for span in named)
    return (top, bottom) if top <= bottom else None


COPY: Final = "copy the value into this workbook; links are not followed"
"""The hint for what is not stored."""

_THIS: Final = "[0]"


def meant_book(workbook: Workbook, book: str | None, around: str | None) -> str | None:
    """Return the linked workbook that a prefix means; None of this one.

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
        raise FormulaError("the formula refers to another workbook", hint=COPY)
    return book


def linked_sheet(workbook: Workbook, book: str, name: str | None, host: Cell) -> str:
    """Return a sheet of a linked workbook, or the host's own.

    Raises:
        FormulaError: nothing of it is stored.
    """
    linked = workbook.links[book]
    sheets = {title.casefold(): title for title in linked.sheets}
    text = sheets.get((host.sheet if name is None else f"{book}{name}").casefold())
    if text is None:
        raise FormulaError(f"the formula refers to {_name_of(linked)}, of which no values are stored", hint=COPY)
    return text


def linked_name(workbook: Workbook, book: str, name: ir.Name) -> DefinedName:
    """Return a name of a linked workbook: the sheet's own first, then the workbook's, then the only one.

    Raises:
        FormulaError: what it stands for is not stored.
    """
    linked = workbook.links[book]
    named = {(n.sheet and n.sheet.casefold()): n for n in linked.names if n.name.casefold() == name.name.casefold()}
    scope = None if name.sheet is None else f"{book}{name.sheet}".casefold()
    only = next(iter(named.values())) if len(named) == 1 and scope is None else None
    defined_name = named.get(scope) or named.get(None) or only
    if defined_name is None:
        raise FormulaError(f"the formula refers to {name.name!r} of {_name_of(linked)}, which is not stored", hint=COPY)
    return defined_name


def _name_of(linked: LinkedBook) -> str:
    return linked.file or "another workbook"
