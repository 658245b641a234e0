"""Structured references, `Table1[[#This Row],[a]:[b]]`: the text between the outer brackets to a node.

A `'` escapes `[ ] # '` and `@` in column names.
"""

from __future__ import annotations

import re

from xlmc.formula import ir

__all__ = ["TABLE_REFERENCE", "parse_table_reference"]

_PLAIN = r"(?:'.|[^\[\]'])*"
_INNER = rf"(?:{_PLAIN}(?:\[{_PLAIN}\]{_PLAIN})*)"
TABLE_REFERENCE = re.compile(rf"\s*(?P<table>[^\W\d][\w.\\]*)?\[(?P<name>{_INNER})\](?![\w!])", re.DOTALL)
"""Matches a whole structured reference: `table` may be absent, `name` is what stands in the outer brackets."""

_PIECE = re.compile(rf"\s*\[({_PLAIN})\]\s*|\s*([,:])\s*|\s*(@)\s*", re.DOTALL)


def parse_table_reference(table: str | None, inner: str) -> ir.TableReference:
    """The node for `table[inner]`."""
    this_row = inner.lstrip().startswith("@")
    body = inner.lstrip()[1:] if this_row else inner
    items, columns = (["#this row"], []) if this_row else ([], [])
    for piece in _pieces(body):
        if piece.startswith("#"):
            items.append(piece.casefold())
        elif piece:
            columns.append(_unescaped(piece))
    first = columns[0] if columns else None
    last = columns[-1] if len(columns) > 1 else None
    return ir.TableReference(table, tuple(items), first, last)


def _pieces(body: str) -> list[str]:
    """`[#Headers],[a]:[b]` in parts; a body without inner brackets is one part."""
    if "[" not in re.sub("'.", "", body):
        return [body.strip()] if body.strip() else []
    return [found[1] for found in _PIECE.finditer(body) if found[1] is not None]


def _unescaped(name: str) -> str:
    return re.sub(r"'(.)", r"\1", name, flags=re.DOTALL)
