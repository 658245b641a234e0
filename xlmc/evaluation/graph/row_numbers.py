"""`ROW(A:A)` among what is computed of whole columns: of the further rows it is what alone differs from row to row.

Where a tree is a constant times ROW and a constant, as `(A:A="x")*ROW(A:A)` is over the empty rows, it is largest and
smallest at the first or the last of them, and on average half of what it is at both.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from xlmc.address import Area
from xlmc.formula import ir

__all__ = ["CURVED", "degree", "is_numbered"]

CURVED = 2
"""The degree of what is neither the same in each row nor rises by the same from row to row."""

Taken = Callable[[ir.Call], Sequence[ir.Expression]]
"""The arguments of a call that are taken cell by cell."""


def is_numbered(tree: ir.Expression) -> bool:
    """Whether a tree is the row numbers of a whole column, or the column numbers of a whole row."""
    match tree:
        case ir.Call("ROW", (Area() as area,)):
            return area.further_rows > 0
        case ir.Call("COLUMN", (Area() as area,)):
            return area.further_columns > 0
        case _:
            return False


def degree(tree: ir.Expression, taken: Taken) -> int:
    """0 where a tree has no row numbers, 1 where it rises by the same from row to row, else `CURVED`."""

    def of(part: ir.Expression) -> int:
        return degree(part, taken)

    if is_numbered(tree):
        return 1
    match tree:
        case ir.Unary(_, operand):
            return of(operand)
        case ir.Binary("+" | "-", left, right):
            return max(of(left), of(right))
        case ir.Binary("*", left, right):
            return min(of(left) + of(right), CURVED)
        case ir.Binary("/", left, right):
            return CURVED if of(right) else of(left)
        case ir.Binary(_, left, right):
            return CURVED if of(left) or of(right) else 0
        case ir.Call("IF", (test, *branches)):
            return CURVED if of(test) else max(map(of, branches), default=0)
        case ir.Call():
            return CURVED if any(map(of, taken(tree))) else 0
        case _:
            return 0
