"""What the arguments of a call in a cell are: numbers, cells, lists, texts."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final

from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir

__all__ = ["difference", "elements", "is_left_out", "number_of", "quotient", "rows_of_trees", "total", "whole_part"]

_ARITHMETIC: Final[dict[str, Callable[[float, float], float]]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
}


def _no_cell(_: Cell) -> float | None:
    return None


def number_of(tree: ir.Expression | None, value: Callable[[Cell], float | None] = _no_cell) -> float | None:
    """Return the number that a tree of plain arithmetic is; None if it is not known without calculating.

    Args:
        tree: resolved.
        value: of a cell; None if that is not known. By default of no cell.

    >>> number_of(ir.Binary("/", ir.Number(1.0), ir.Unary("%", ir.Number(50.0))))
    2.0
    """
    match tree:
        case ir.Number(number):
            return number
        case Cell():
            return value(tree)
        case ir.Unary(operator, operand):
            inner = number_of(operand, value)
            if inner is None:
                return None
            return -inner if operator == "-" else inner / 100 if operator == "%" else inner
        case ir.Call("INT", (argument,)):
            inner = number_of(argument, value)
            return None if inner is None else float(inner // 1)
        case ir.Call("IF", (ir.Binary("<=", left, right), then, otherwise)):
            a, b = number_of(left, value), number_of(right, value)
            return None if a is None or b is None else number_of(then if a <= b else otherwise, value)
        case ir.Binary(operator, left, right) if operator in _ARITHMETIC:
            a, b = number_of(left, value), number_of(right, value)
            if a is None or b is None or (operator == "/" and b == 0):
                return None
            return _ARITHMETIC[operator](a, b)
        case _:
            return None


def is_left_out(tree: ir.Expression) -> bool:
    """`RiskTruncate(,6)`: nothing stands there."""
    return isinstance(tree, ir.Missing)


def total(left: ir.Expression, right: ir.Expression) -> ir.Expression:
    """`left + right`."""
    return ir.Binary("+", left, right)


def difference(left: ir.Expression, right: ir.Expression) -> ir.Expression:
    """`left - right`."""
    return ir.Binary("-", left, right)


def quotient(over: ir.Expression | float, under: ir.Expression) -> ir.Expression:
    """`over / under`."""
    return ir.Binary("/", ir.Number(over) if isinstance(over, float) else over, under)


def whole_part(tree: ir.Expression) -> ir.Expression:
    """Return the largest whole number that is not above."""
    return ir.Call("INT", (tree,))


def elements(tree: ir.Expression) -> Iterator[ir.Expression]:
    """Return the elements of a list: of `{1,2,3}`, of a range row by row; one for anything else."""
    for row in rows_of_trees(tree):
        yield from row


def rows_of_trees(tree: ir.Expression) -> list[tuple[ir.Expression, ...]]:
    """Return the same, row by row."""
    match tree:
        case ir.Array(rows):
            return list(rows)
        case Area():
            cells: list[Cell] = list(tree.cells())
            return [tuple(cells[i : i + tree.columns]) for i in range(0, len(cells), tree.columns)]
        case _:
            return [(tree,)]
