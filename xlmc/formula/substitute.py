"""A resolved tree with some of its parts replaced."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from xlmc.formula import ir

__all__ = ["is_bound", "substituted"]


def substituted(tree: ir.Expression, change: Callable[[ir.Expression], ir.Expression | None]) -> ir.Expression:
    """The tree with every part replaced for which `change` gives another; outer parts are asked first, then left ones.

    Args:
        tree: resolved.
        change: takes a part and gives what stands in its place, whole; None to look into the part instead.
    """
    changed = change(tree)
    if changed is not None:
        return changed
    match tree:
        case ir.Unary(_, operand):
            return replace(tree, operand=substituted(operand, change))
        case ir.Binary():
            return _chain(tree, change)
        case ir.Call(_, arguments):
            return replace(tree, arguments=tuple(substituted(part, change) for part in arguments))
        case ir.Let(bindings, body):
            bound = tuple((name, substituted(value, change)) for name, value in bindings)
            return replace(tree, bindings=bound, body=substituted(body, change))
        case ir.Lambda(_, body):
            return replace(tree, body=substituted(body, change))
        case ir.Invoke(function, arguments):
            called = substituted(function, change)
            return ir.Invoke(called, tuple(substituted(part, change) for part in arguments))
        case _:
            return tree


def _chain(tree: ir.Binary, change: Callable[[ir.Expression], ir.Expression | None]) -> ir.Expression:
    """Each operand of a long sum, from the left; partial sums are not asked about."""
    first, rest = ir.chain(tree)
    built = substituted(first, change)
    for operator, right in rest:
        built = ir.Binary(operator, built, substituted(right, change))
    return ir.marked_as(built, tree)


def is_bound(tree: ir.Expression) -> bool:
    """Whether the tree holds a variable of `LET` or `LAMBDA`."""
    found: list[ir.Expression] = []

    def look(part: ir.Expression) -> None:
        if isinstance(part, ir.Variable):
            found.append(part)

    substituted(tree, look)
    return bool(found)
