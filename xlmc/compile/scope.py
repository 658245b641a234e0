"""Where a tree stands while it is lowered: its cell, how it takes ranges, and what its variables stand for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from xlmc.address import Cell
from xlmc.formula import ir

__all__ = ["Callee", "Closure", "Fork", "Native", "Scope", "Thunk"]


@dataclass(eq=False)
class Thunk:
    """A tree that a variable stands for, in the scope it was written in."""

    tree: ir.Expression
    scope: Scope
    known: dict[bool, int] = field(default_factory=dict)
    """Its node, with ranges taken cell by cell and not, once it was lowered."""
    callee: Callee | None = None
    """The function that it gives, once it was called."""


@dataclass(frozen=True, eq=False)
class Closure:
    """A LAMBDA with the scope it was written in."""

    function: ir.Lambda
    scope: Scope

    def takes(self, count: int) -> bool:
        """Whether it may be called with so many arguments."""
        most = len(self.function.parameters)
        return most - self.function.optional <= count <= most

    def inside(self, arguments: Sequence[int | Thunk | Closure], caller: Scope) -> Scope:
        """The scope of its calculation in a call."""
        left_out = [Thunk(ir.Missing(), self.scope)] * (len(self.function.parameters) - len(arguments))
        given = dict(zip(self.function.parameters, (*arguments, *left_out), strict=True))
        return replace(self.scope.bound(given), array=caller.array, depth=caller.depth + 1)


@dataclass(frozen=True)
class Native:
    """A function of Excel, given as a value."""

    name: str


@dataclass(frozen=True, eq=False)
class Fork:
    """One of two functions, by a condition that varies."""

    condition: int
    yes: Callee
    no: Callee


Callee = Closure | Native | Fork
"""What can be called."""


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

    def seen_from(self, user: Scope) -> Scope:
        """The same, taken as the scope takes ranges in which a variable of this one is used, and as deep."""
        return replace(self, array=user.array, depth=user.depth)

    def bound(self, variables: Mapping[str, int | Thunk | Closure]) -> Scope:
        """The same with more variables."""
        return replace(self, variables={**self.variables, **variables})

    def defining(self, name: str, tree: ir.Expression) -> Scope:
        """The same with a variable whose tree may name the variable itself."""
        variables = dict(self.variables)
        inner = replace(self, variables=variables)
        variables[name] = Thunk(tree, inner)
        return inner
