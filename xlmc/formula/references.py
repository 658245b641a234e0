"""The cells and areas that a resolved tree reads."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, assert_never

from xlmc.address import Area, Cell
from xlmc.formula import ir

__all__ = ["LOOKED_AT", "references"]

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
