"""Formulas with the variables of LET written out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from xlmc.formula import ir
from xlmc.formula.substitute import substituted

__all__ = ["unfolded"]

_MOST: Final = 2000
"""Parts of a formula: variables of variables can double it on."""


def unfolded(tree: ir.Expression) -> ir.Expression:
    """A resolved formula without LET: every variable as the formula that it stands for.

    A formula with a LAMBDA in it, or one that would become very long, is left as it is.
    """
    found: list[ir.Expression] = []
    _look_for_let(tree, found)
    if not all(isinstance(part, ir.Let) and not part.recursive for part in found) or not found:
        return tree
    room = _Room()
    try:
        return _written_out(tree, {}, room)
    except OverflowError:
        return tree


def _look_for_let(tree: ir.Expression, found: list[ir.Expression]) -> None:
    """Collect the parts of a formula that bind or name something."""

    def look(part: ir.Expression) -> None:
        if isinstance(part, ir.Let | ir.Lambda | ir.Invoke | ir.FunctionName):
            found.append(part)

    substituted(tree, look)


class _Room:
    """How many parts there may still be."""

    def __init__(self) -> None:
        self.left = _MOST

    def take(self, tree: ir.Expression) -> ir.Expression:
        """Count the parts of what stands for a variable once more.

        Raises:
            OverflowError: there is no room left.
        """

        def count(_: ir.Expression) -> None:
            self.left -= 1

        substituted(tree, count)
        if self.left < 0:
            raise OverflowError
        return tree


def _written_out(tree: ir.Expression, known: Mapping[str, ir.Expression], room: _Room) -> ir.Expression:
    def change(part: ir.Expression) -> ir.Expression | None:
        match part:
            case ir.Variable(name) if name in known:
                return room.take(known[name])
            case ir.Let(bindings, body):
                inner = dict(known)
                for name, value in bindings:
                    inner[name] = _written_out(value, inner, room)
                return _written_out(body, inner, room)
            case _:
                return None

    return substituted(tree, change)
