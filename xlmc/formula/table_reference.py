"""Structured references, `Table1[[#This Row],[a]:[b]]`: the text between the outer brackets to a node.

A `'` escapes `[ ] # '` and `@` in column names.
"""

from __future__ import annotations

import re

from xlmc.formula import ir

__all__ = ["TABLE_REFERENCE", "parse_table_reference"]

_PLAIN = r"(?:'.|[^\[\]'])*"
_INNER = rf"(?:{_PLAIN}(?:\[{_PLAIN}\]{_PLAIN})*)"
TABLE_REFERENCE = re.compile(rf"\s*(?P<table>(?:[^\W\d]|\\)[\w.\\]*)?\[(?P<name>{_INNER})\](?![\w!])", re.DOTALL)
"""Matches a whole structured reference: `table` may be absent, `name` is what stands in the outer brackets."""

_PIECE = re.compile(rf"\s*(?:\[(?P<name>{_PLAIN})\]|(?P<sign>[,:]))\s*", re.DOTALL)
_ORDER = re.compile(r"(?:i(?:,i)*(?:,c(?::c)?)?|c(?::c)?)?")
_ORDER_OF_THIS_ROW = re.compile(r"(?:c(?::c)?)?")
"""How items (`i`, with a `#`) and columns (`c`) may follow each other."""


def parse_table_reference(table: str | None, inner: str) -> ir.TableReference:
    """The node for `table[inner]`.

    Raises:
        ValueError: `inner` is no structured reference.
    """
    this_row = inner.lstrip().startswith("@")
    pieces = _pieces(inner.lstrip()[1:] if this_row else inner)
    order = "".join(piece if piece in ",:" else ("i" if piece.startswith("#") else "c") for piece in pieces)
    if not (_ORDER_OF_THIS_ROW if this_row else _ORDER).fullmatch(order):
        raise ValueError(f"{inner!r} is not what may stand in a table's brackets")
    items = [piece.casefold() for piece, kind in zip(pieces, order, strict=True) if kind == "i"]
    columns = [_unescaped(piece) for piece, kind in zip(pieces, order, strict=True) if kind == "c"]
    first = columns[0] if columns else None
    last = columns[1] if len(columns) > 1 else None
    return ir.TableReference(table, ("#this row", *items) if this_row else tuple(items), first, last)


def _pieces(body: str) -> list[str]:
    """`[#Headers],[a]:[b]` as its names and signs; a body without inner brackets is one name."""
    if "[" not in re.sub("'.", "", body):
        return [body.strip()] if body.strip() else []
    found = list(_PIECE.finditer(body))
    if "".join(piece[0] for piece in found) != body or any(piece["name"] == "" for piece in found):
        raise ValueError(f"{body!r} is not what may stand in a table's brackets")
    return [piece["name"] or piece["sign"] for piece in found]


def _unescaped(name: str) -> str:
    return re.sub(r"'(.)", r"\1", name, flags=re.DOTALL)
