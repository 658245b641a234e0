"""How formulas write references: cells and names with their sheets, and columns of tables.

In a structured reference, `Table1[[#This Row],[a]:[b]]`, a `'` escapes `[ ] # '` and `@` in column names.
"""

from __future__ import annotations

import re

from xlmc.excel.address import MAX_COLUMN, MAX_ROW, column_number
from xlmc.excel.formula import ir

__all__ = [
    "CELL",
    "NAME",
    "PREFIX",
    "REFERENCE",
    "TABLE_REFERENCE",
    "corner",
    "is_on_the_sheet",
    "parse_table_reference",
    "prefix",
]

_SHEET = r"[^\W\d][\w.]*"
PREFIX = rf"(?:'(?P<quoted>(?:[^']|'')+)'|(?P<book>\[[^\[\]]+\])?(?P<sheet>{_SHEET}(?::{_SHEET})?)?)!"
"""Matches a sheet, or the first and the last of several, with the workbook's number before it; see `prefix`."""

CELL = r"\$?[A-Za-z]{1,3}\$?[1-9][0-9]{0,6}"
REFERENCE = rf"(?P<name>{CELL}(?::{CELL})?|\$?[A-Za-z]{{1,3}}:\$?[A-Za-z]{{1,3}}|\$?[1-9][0-9]*:\$?[1-9][0-9]*)"
NAME = r"(?P<name>[^\W\d][\w.\\?]*|\\[\w.\\?]*)"
_CORNER = re.compile(r"(?P<cf>\$?)(?P<c>[A-Za-z]{1,3})?(?P<rf>\$?)(?P<r>[0-9]+)?")

_PLAIN = r"(?:'.|[^\[\]'])*"
_INNER = rf"(?:{_PLAIN}(?:\[{_PLAIN}\]{_PLAIN})*)"
TABLE_REFERENCE = re.compile(rf"\s*(?P<table>(?:[^\W\d]|\\)[\w.\\]*)?\[(?P<name>{_INNER})\](?![\w!])", re.DOTALL)
"""Matches a whole structured reference: `table` may be absent, `name` is what stands in the outer brackets."""

_PIECE = re.compile(rf"\s*(?:\[(?P<name>{_PLAIN})\]|(?P<sign>[,:]))\s*", re.DOTALL)
_ORDER = re.compile(r"(?:i(?:,i)*(?:,c(?::c)?)?|c(?::c)?)?")
_ORDER_OF_THIS_ROW = re.compile(r"(?:c(?::c)?)?")
"""How items (`i`, with a `#`) and columns (`c`) may follow each other."""


def prefix(groups: dict[str, str]) -> tuple[str | None, str | None, str | None]:
    """Sheet, last sheet and external book of a reference, from the groups of `PREFIX`."""
    text = groups["quoted"].replace("''", "'") if "quoted" in groups else groups.get("sheet", "")
    book = groups.get("book")
    if "quoted" in groups and "]" in text:
        book, _, text = text.rpartition("]")
        book += "]"
    first, _, last = text.partition(":")
    return first or None, last or None, book


def corner(text: str) -> ir.Corner:
    """Return the cell `$A$1`, column `A` or row `1` of a matched `REFERENCE`, as one of its ends."""
    match = _CORNER.fullmatch(text)
    assert match is not None  # `REFERENCE` matches nothing else
    row, column = match["r"], match["c"]
    if column is None:  # a whole row, `$3`: the `$` was read as the column's
        return ir.Corner(int(row), None, bool(match["cf"] or match["rf"]), False)
    return ir.Corner(int(row) if row else None, column_number(column), bool(match["rf"]), bool(match["cf"]))


def is_on_the_sheet(end: ir.Corner) -> bool:
    """Whether Excel's sheets have such a row and column."""
    return (end.row or 1) <= MAX_ROW and (end.column or 1) <= MAX_COLUMN


def parse_table_reference(table: str | None, inner: str) -> ir.TableReference:
    """Make the node for `table[inner]`.

    Raises:
        ValueError: `inner` is no structured reference.
    """
    this_row = inner.lstrip().startswith("@")
    pieces = _pieces(inner.lstrip()[1:] if this_row else inner)
    order = "".join(piece if piece in ",:" else ("i" if piece.startswith("#") else "c") for piece in pieces)
    if not (_ORDER_OF_THIS_ROW if this_row else _ORDER).fullmatch(order):
        raise ValueError(f"{inner!r} is not allowed in a table's brackets")
    items = [piece.casefold() for piece, kind in zip(pieces, order, strict=True) if kind == "i"]
    columns = [_unescaped(piece) for piece, kind in zip(pieces, order, strict=True) if kind == "c"]
    first = columns[0] if columns else None
    last = columns[1] if len(columns) > 1 else None
    return ir.TableReference(table, ("#this row", *items) if this_row else tuple(items), first, last)


def _pieces(body: str) -> list[str]:
    """`[#Headers],[a]:[b]` as its names and signs; a body without inner brackets is one name."""
    if "[" not in re.sub("'.", "", body):
        return [body.strip()] if body.strip() else []
    result = list(_PIECE.finditer(body))
    if "".join(piece[0] for piece in result) != body or any(piece["name"] == "" for piece in result):
        raise ValueError(f"{body!r} is not allowed in a table's brackets")
    return [piece["name"] or piece["sign"] for piece in result]


def _unescaped(name: str) -> str:
    return re.sub(r"'(.)", r"\1", name, flags=re.DOTALL)
