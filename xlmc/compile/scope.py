"""Where a tree stands while it is lowered: its cell, how it takes ranges, and what its variables stand for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from xlmc.address import Cell
from xlmc.formula import ir

__all__ = ["Closure", "Scope", "Thunk"]


@dataclass(frozen=True, eq=False)
class Thunk:
    """A tree that a variable stands for, in the scope it was written in."""

    tree: ir.Expression
    scope: Scope
    known: dict[bool, int] = field(default_factory=dict)
    """Its node, with ranges taken cell by cell and not, once it was lowered."""


@dataclass(frozen=True, eq=False)
class Closure:
    """A LAMBDA with the scope it was written in."""

    function: ir.Lambda
    scope: Scope


@dataclass(frozen=True, eq=False)
class Scope:
    """Where a tree stands.

    Attributes:
        cell: whose formula it is in.
        array: whether ranges are taken cell by cell, as in an array formula; a plain formula takes the cell of a range
            that stands beside it.
        variables: name -> a node's place, a tree to be lowered in its scope, or a LAMBDA.
        depth: how many LAMBDAs are being called.
    """

    cell: Cell
    array: bool = False
    variables: Mapping[str, int | Thunk | Closure] = field(default_factory=dict)
    depth: int = 0

    def over_arrays(self) -> Scope:
        """The same, ranges taken cell by cell."""
        return self if self.array else replace(self, array=True)

    def bound(self, **variables: int | Thunk | Closure) -> Scope:
        """The same with more variables."""
        return replace(self, variables={**self.variables, **variables})
