"""Where a tree stands while it is lowered: its cell, how it takes ranges, and what its variables stand for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from xlmc.address import Cell
from xlmc.formula import ir
from xlmc.functions.registry import Ranges

__all__ = ["Callee", "Closure", "Fork", "Native", "Scope", "Thunk"]


@dataclass(eq=False)
class Thunk:
    """A tree that a variable stands for, in the scope it was written in."""

    tree: ir.Expression
    scope: Scope
    known: dict[tuple[bool, bool, bool], int] = field(default_factory=dict)
    """Its node for each way to take ranges (see `Scope.taking`), once it was lowered."""
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
        return replace(self.scope.bound(given).seen_from(caller), depth=caller.depth + 1)


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
        of_array: whether it is an array formula, in which ranges are taken cell by cell everywhere; a plain formula
            takes the cell of a range that stands beside it.
        around: whether a function around the tree has it taken cell by cell also in a plain formula.
        whole: whether a range that is all of the tree, or a branch of a choice that is, is wanted whole.
        variables: name -> a node's place, a tree to be lowered in its scope, or a LAMBDA.
        depth: how many LAMBDAs are being called.
    """

    cell: Cell
    of_array: bool = False
    around: bool = False
    whole: bool = False
    variables: Mapping[str, int | Thunk | Closure] = field(default_factory=dict)
    depth: int = 0

    @property
    def array(self) -> bool:
        """Whether ranges are taken cell by cell."""
        return self.of_array or self.around

    @property
    def taking(self) -> tuple[bool, bool, bool]:
        """All that says how ranges are taken."""
        return self.of_array, self.around, self.whole

    def over_arrays(self) -> Scope:
        """The same, ranges taken cell by cell."""
        return self if self.array else replace(self, around=True, whole=False)

    def plainly(self) -> Scope:
        """The same, ranges taken as in the formula, whatever a function around has them taken as."""
        return replace(self, around=False, whole=False) if self.around or self.whole else self

    def inside(self) -> Scope:
        """That of a part of the tree."""
        return replace(self, whole=False) if self.whole else self

    def wanted_whole(self) -> Scope:
        """The same, what a range gives wanted whole."""
        return self if self.array or self.whole else replace(self, whole=True)

    def branch(self) -> Scope:
        """That of a choice's branch: a range there is whole where the choice is wanted whole or cell by cell."""
        return replace(self, around=False, whole=self.whole or self.around) if self.around else self

    def of(self, ranges: Ranges) -> Scope:
        """That of an argument."""
        if ranges is Ranges.CELLS:
            return self.over_arrays()
        return self if ranges in (Ranges.AROUND, Ranges.ONE_CELL) else self.plainly()

    def seen_from(self, user: Scope) -> Scope:
        """The same, taken as the scope takes ranges in which a variable of this one is used, and as deep."""
        return replace(self, of_array=user.of_array, around=user.around, whole=user.whole, depth=user.depth)

    def bound(self, variables: Mapping[str, int | Thunk | Closure]) -> Scope:
        """The same with more variables."""
        return replace(self, variables={**self.variables, **variables})

    def defining(self, name: str, tree: ir.Expression) -> Scope:
        """The same with a variable whose tree may name the variable itself."""
        variables = dict(self.variables)
        inner = replace(self, variables=variables)
        variables[name] = Thunk(tree, inner)
        return inner
