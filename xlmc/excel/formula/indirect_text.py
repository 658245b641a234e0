"""References in the texts that INDIRECT is given, in both of Excel's styles."""

from __future__ import annotations

import re
from typing import Final

from xlmc.errors import FormulaError
from xlmc.excel.address import MAX_COLUMN, Cell, column_number
from xlmc.excel.formula import ir
from xlmc.excel.formula.parse import parse

__all__ = ["read_a1", "read_r1c1"]

_STEP: Final = r"\[-?[0-9]{1,7}\]|[0-9]{1,7}"
_R1C1: Final = re.compile(rf"(?P<row>R(?P<r>{_STEP})?)?(?P<column>C(?P<c>{_STEP})?)?", re.IGNORECASE)
"""Matches a cell as Excel's other style writes it, `R2C[-1]`, a whole row, `R2`, or a whole column."""

_PADDED: Final = re.compile(r"(?P<before>\$?(?P<column>[A-Za-z]{1,3})\$?)0+(?=[1-9])")
"""The row of a cell with zeros before it, `A02`, which Excel reads as `A2`."""
_CELLS: Final = re.compile(r"\$?[A-Za-z]{1,3}\$?[0-9]+(?::\$?[A-Za-z]{1,3}\$?[0-9]+)?")


def _unpad(match: re.Match[str]) -> str:
    return match["before"] if column_number(match["column"].upper()) <= MAX_COLUMN else match[0]


def read_a1(text: str) -> ir.Expression | None:
    """Read a reference in the usual style; None if the text is none."""
    sheet, mark, place = text.rpartition("!")
    if _CELLS.fullmatch(place):
        text = sheet + mark + _PADDED.sub(_unpad, place)
    try:
        return parse(text)
    except FormulaError:
        return None


def read_r1c1(text: str, host: Cell) -> ir.Expression | None:
    """Read the reference `R1C1`, `Data!R[1]C:R3C` or `C2`; names and tables are written as in the usual style."""
    sheet, _, place = text.strip().rpartition("!")
    corners = [_r1c1_corner(end, host) for end in place.split(":")]
    first, last = corners[0], corners[-1]
    if first is not None and last is not None and len(corners) <= 2 and _go_together(first, last):
        unquoted = sheet[1:-1].replace("''", "'") if sheet.startswith("'") and sheet.endswith("'") else sheet
        return ir.Reference(first, last, sheet=unquoted or None)
    tree = read_a1(text)
    return tree if isinstance(tree, ir.Name | ir.TableReference) else None


def _go_together(first: ir.Corner, last: ir.Corner) -> bool:
    """Whether both are cells, both whole rows or both whole columns."""
    return (first.row is None, first.column is None) == (last.row is None, last.column is None)


def _r1c1_corner(text: str, host: Cell) -> ir.Corner | None:
    match = _R1C1.fullmatch(text)
    if match is None or not text:
        return None
    row = _step(match["r"], host.row) if match["row"] else None
    column = _step(match["c"], host.column) if match["column"] else None
    return ir.Corner(row, column, True, True)


def _step(text: str | None, base: int) -> int:
    if text is None:
        return base
    return base + int(text[1:-1]) if text.startswith("[") else int(text)
