"""The cells and areas that a formula reads: by its resolved tree, or by its text where it cannot be read."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import Final, assert_never

from xlmc.excel.address import MAX_COLUMN, MAX_ROW, Area, Cell, column_number
from xlmc.excel.formula import ir
from xlmc.excel.workbook.workbook import Formula, Workbook

__all__ = ["LOOKED_AT", "mentioned", "mentioned_cells", "references"]

LOOKED_AT: Final = frozenset(
    {
        "ROW",
        "COLUMN",
        "ROWS",
        "COLUMNS",
        "AREAS",
        "SHEET",
        "SHEETS",
        "ISREF",
        "ISFORMULA",
        "FORMULATEXT",
        "CELL",
    }
)
"""Functions that ask where their arguments are, not what they hold."""


def references(tree: ir.Expression) -> Iterator[Cell | Area]:
    """Every cell and area a resolved tree reads, from left to right."""
    match tree:
        case Cell() | Area():
            yield tree
        case ir.Unary(_, operand):
            yield from references(operand)
        case ir.Binary():
            first, rest = ir.chain(tree)
            yield from references(first)
            for _, right in rest:
                yield from references(right)
        case ir.Call(name, arguments):
            looked_at = name in LOOKED_AT
            for part in arguments:
                if not (looked_at and isinstance(part, Cell | Area)):
                    yield from references(part)
        case ir.Let(bindings, body):
            for _, value in bindings:
                yield from references(value)
            yield from references(body)
        case ir.Lambda(_, body):
            yield from references(body)
        case ir.Invoke(function, arguments):
            yield from references(function)
            for part in arguments:
                yield from references(part)
        case ir.Array(rows):
            for row in rows:
                for part in row:
                    yield from references(part)
        case ir.Variable() | ir.FunctionName():
            return
        case ir.Number() | ir.Text() | ir.Logical() | ir.ErrorLiteral() | ir.Missing():
            return
        case ir.Reference() | ir.Name() | ir.TableReference():
            raise TypeError(f"not resolved: {tree}")
        case _:
            assert_never(tree)


_TEXTS: Final = re.compile(r'"(?:[^"]|"")*"')
_SHEET: Final = r"(?:(?:'(?P<quoted>(?:[^']|'')+)'|(?P<bare>[\w.]+))!)?"
_CORNER: Final = r"(\$?)([A-Za-z]{1,3})(\$?)([1-9][0-9]{0,6})"
_PLACE: Final = re.compile(rf"(?<![\w.$]){_SHEET}{_CORNER}(?::{_CORNER})?(?![\w(.])")
_COLUMNS: Final = re.compile(rf"(?<![\w.$]){_SHEET}\$?([A-Za-z]{{1,3}}):\$?([A-Za-z]{{1,3}})(?![\w(.])")
_WORD: Final = re.compile(r"(?<![\w.\\])[^\W\d][\w.\\]*")


def mentioned(formula: Formula, cell: Cell, workbook: Workbook) -> Iterator[Area]:
    """Return the areas of the workbook that a cell's formula mentions, also by names and tables; rather too many than
    too few.

    Args:
        formula: of the cell.
        cell: the host; relative references of a shared formula are moved to it.
        workbook: whose sheets, names and tables are meant.
    """
    yield from _in_text(formula.text, cell, (cell.row - formula.row, cell.column - formula.column), workbook, set())


def mentioned_cells(workbook: Workbook, cell: Cell, among: Collection[Cell]) -> Iterator[Cell]:
    """Yield the cells that a cell's formula mentions: of areas with more cells than `among`, those of these alone."""
    formula = workbook.content(cell).formula
    for area in () if formula is None else mentioned(formula, cell, workbook):
        few = area.rows * area.columns <= len(among)
        yield from area.cells() if few else (each for each in among if each in area)


def _in_text(text: str, host: Cell, shift: tuple[int, int], workbook: Workbook, open_names: set[str]) -> Iterator[Area]:
    text = _TEXTS.sub('""', text)
    for match in _PLACE.finditer(text):
        sheet = _sheet(match, host, workbook)
        if sheet is not None:
            yield _area(sheet, match.groups()[2:], shift)
    for match in _COLUMNS.finditer(text):
        sheet = _sheet(match, host, workbook)
        if sheet is not None:
            left, right = sorted(min(column_number(letters.upper()), MAX_COLUMN) for letters in match.groups()[2:])
            yield Area(sheet, 1, left, MAX_ROW, right)
    for word in dict.fromkeys(_WORD.findall(text)):
        table = workbook.table_named(word)
        if table is not None:
            yield table.area
        if word.casefold() in open_names:
            continue
        meant = workbook.defined_name(word, host.sheet), workbook.defined_name(word)  # names in names mean the latter
        for name in dict.fromkeys(meant):
            own = (host.row - 1, host.column - 1)  # relative references in a name are as seen from A1
            if name is not None:
                yield from _in_text(name.text, host, own, workbook, open_names | {word.casefold()})


def _sheet(match: re.Match[str], host: Cell, workbook: Workbook) -> str | None:
    name = match["bare"] if match["quoted"] is None else match["quoted"].replace("''", "'")
    if name is None:
        return host.sheet
    sheet = workbook.sheet_named(name)
    return None if sheet is None else sheet.name


def _area(sheet: str, groups: tuple[str | None, ...], shift: tuple[int, int]) -> Area:
    first = _moved(groups[:4], shift)
    last = first if groups[5] is None else _moved(groups[4:], shift)
    (top, bottom), (left, right) = sorted((first[0], last[0])), sorted((first[1], last[1]))
    return Area(sheet, top, left, bottom, right)


def _moved(corner: tuple[str | None, ...], shift: tuple[int, int]) -> tuple[int, int]:
    column_fixed, letters, row_fixed, digits = corner
    row = int(digits or 1) + (0 if row_fixed else shift[0])
    column = column_number((letters or "A").upper()) + (0 if column_fixed else shift[1])
    return (row - 1) % MAX_ROW + 1, (column - 1) % MAX_COLUMN + 1
