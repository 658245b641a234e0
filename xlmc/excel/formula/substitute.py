"""A resolved tree with some of its parts replaced, or with the variables of LET written out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final

from xlmc.excel.formula import ir

__all__ = ["is_bound", "substitute", "unfold"]


def substitute(tree: ir.Expression, change: Callable[[ir.Expression], ir.Expression | None]) -> ir.Expression:
    """Replace every part of the tree for which `change` gives another; outer parts are asked first, then left ones.

    Args:
        tree: resolved.
        change: takes a part and gives what replaces it, whole; None to look into the part instead.
    """
    changed = change(tree)
    if changed is not None:
        return changed
    match tree:
        case ir.Unary(_, operand):
            return replace(tree, operand=substitute(operand, change))
        case ir.Binary():
            return _chain(tree, change)
        case ir.Call(_, arguments):
            return replace(tree, arguments=tuple(substitute(part, change) for part in arguments))
        case ir.Let(bindings, body):
            bound = tuple((name, substitute(value, change)) for name, value in bindings)
            return replace(tree, bindings=bound, body=substitute(body, change))
        case ir.Lambda(_, body):
            return replace(tree, body=substitute(body, change))
        case ir.Invoke(function, arguments):
            called = substitute(function, change)
            return ir.Invoke(called, tuple(substitute(part, change) for part in arguments))
        case _:
            return tree


def _chain(tree: ir.Binary, change: Callable[[ir.Expression], ir.Expression | None]) -> ir.Expression:
    """Each operand of a long sum, from the left; partial sums are not asked about."""
    first, rest = ir.chain(tree)
    built = substitute(first, change)
    for operator, right in rest:
        built = ir.Binary(operator, built, substitute(right, change))
    return ir.marked_as(built, tree)


def is_bound(tree: ir.Expression) -> bool:
    """Whether the tree holds a variable of `LET` or `LAMBDA`."""
    result: list[ir.Expression] = []

    def look(part: ir.Expression) -> None:
        if isinstance(part, ir.Variable):
            result.append(part)

    substitute(tree, look)
    return bool(result)


_MOST: Final = 2000
"""Parts of a formula: variables of variables can double it on."""


def unfold(tree: ir.Expression) -> ir.Expression:
    """Write a resolved formula without LET: every variable as the formula that it stands for.

    A formula with a LAMBDA in it, or one that would become very long, is left as it is.
    """
    result: list[ir.Expression] = []
    _look_for_let(tree, result)
    if not all(isinstance(part, ir.Let) and not part.recursive for part in result) or not result:
        return tree
    budget = _Budget()
    try:
        return _write_out(tree, {}, budget)
    except OverflowError:
        return tree


def _look_for_let(tree: ir.Expression, result: list[ir.Expression]) -> None:
    """Collect the parts of a formula that bind or name something."""

    def look(part: ir.Expression) -> None:
        if isinstance(part, ir.Let | ir.Lambda | ir.Invoke | ir.FunctionName):
            result.append(part)

    substitute(tree, look)


class _Budget:
    """How many parts there may still be."""

    def __init__(self) -> None:
        self.left = _MOST

    def take(self, tree: ir.Expression) -> ir.Expression:
        """Count the parts of what stands for a variable once more.

        Raises:
            OverflowError: there are more than `_MOST`.
        """

        def count(_: ir.Expression) -> None:
            self.left -= 1

        substitute(tree, count)
        if self.left < 0:
            raise OverflowError
        return tree


def _write_out(tree: ir.Expression, known: Mapping[str, ir.Expression], budget: _Budget) -> ir.Expression:
    def change(part: ir.Expression) -> ir.Expression | None:
        match part:
            case ir.Variable(name) if name in known:
                return budget.take(known[name])
            case ir.Let(bindings, body):
                inner = dict(known)
                for name, value in bindings:
                    inner[name] = _write_out(value, inner, budget)
                return _write_out(body, inner, budget)
            case _:
                return None

    return substitute(tree, change)
