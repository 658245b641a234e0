"""Hold what the parts of the lowering share: the scope of a tree, what can be called there, what a part may ask for.

Each part (choices, references, LAMBDAs, …) is given a `TreeLowering`; `lowering.Lowering` is the one there is.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Final

from xlmc.engine.graph.arrays import NodeBuilder
from xlmc.errors import FormulaError
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import Graph, Resolver, ir
from xlmc.excel.functions import Function
from xlmc.excel.functions.budget import CallCount
from xlmc.excel.functions.registry import Ranges

__all__ = [
    "DEEPEST_CALLS",
    "Arguments",
    "Callee",
    "Closure",
    "Fork",
    "LambdaCalls",
    "Native",
    "RecursiveLambda",
    "Scope",
    "Thunk",
    "TooDeepError",
    "TreeLowering",
    "bind",
    "check_depth",
    "find_callee",
    "find_function",
    "is_omitted",
    "let_scope",
]

_MOST_WRITTEN_OUT: Final = 1_000
"""Calls of a LAMBDA by itself within one call that are written out."""


DEEPEST_CALLS: Final = 60
"""Calls within calls that are written out."""


class TreeLowering(NodeBuilder, ABC):
    """Lowers trees to nodes.

    Attributes:
        graph: the needed cells, in dependency order.
        calls: of LAMBDAs, which must not be too many.
        lambda_calls: the calls of LAMBDAs that are being lowered.
    """

    graph: Graph
    calls: CallCount
    lambda_calls: LambdaCalls

    @abstractmethod
    def lower(self, tree: ir.Expression, scope: Scope) -> int:
        """Lower a tree."""

    @abstractmethod
    def call_by_name(self, name: str, arguments: tuple[ir.Expression, ...], scope: Scope) -> int:
        """Lower a function of values."""

    @abstractmethod
    def whole(self, tree: ir.Expression, scope: Scope) -> list[int]:
        """Lower an argument that may be a range: ranges whole, joined areas one by one, anything else as it
        computes.
        """

    @abstractmethod
    def range(self, area: Area) -> int:
        """Return the node of all cells of an area, which are looked up once.

        Raises:
            TooLargeError: they are too many.
        """

    @abstractmethod
    def cell(self, cell: Cell) -> int:
        """Return the node of a cell's value."""

    @abstractmethod
    def array(self, cell: Cell) -> int:
        """Return the node of all that an array formula in a cell gives."""

    @abstractmethod
    def spill(self, cell: Cell) -> int:
        """Return the node of the cells that an array formula fills; a cell shows 0 for an empty value."""

    @abstractmethod
    def is_saved(self, cell: Cell) -> bool:
        """Whether formulas see what Excel saved in a formula's cell, rather than what it gives."""

    @abstractmethod
    def awaits(self, cell: Cell) -> bool:
        """Whether a cell must still be lowered before a formula can refer to it."""

    @abstractmethod
    def awaited(self, area: Area) -> Sequence[Cell]:
        """Return the cells of an area that must still be lowered before a formula can refer to it."""

    @property
    @abstractmethod
    def resolver(self) -> Resolver:
        """Reads the references in texts."""


@dataclass(eq=False)
class Thunk:
    """A tree that a variable stands for, in the scope it was written in."""

    tree: ir.Expression
    scope: Scope
    known: dict[tuple[bool, bool, bool], int] = field(default_factory=dict)
    """The node of a cell for each way to take ranges (see `Scope.taking`), once the cell was lowered."""
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
        """Return the scope of its calculation in a call."""
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
    """The place of a tree in the workbook.

    Attributes:
        cell: whose formula it is in.
        of_array: whether it is an array formula, in which ranges are taken cell by cell everywhere; a plain formula
            takes the cell of a range that stands beside it.
        around: whether a function around the tree has it taken cell by cell also in a plain formula.
        whole: whether a range that is all of the tree, or a branch of a choice that is, is wanted whole.
        pointing: whether it is asked only where the tree leads, not what its cells hold.
        variables: name -> a node, a tree to be lowered in its scope, or a LAMBDA.
        depth: how many LAMBDAs are being called.
    """

    cell: Cell
    of_array: bool = False
    around: bool = False
    whole: bool = False
    variables: Mapping[str, int | Thunk | Closure] = field(default_factory=dict)
    depth: int = 0
    pointing: bool = False

    @property
    def array(self) -> bool:
        """Whether ranges are taken cell by cell."""
        return self.of_array or self.around

    @property
    def taking(self) -> tuple[bool, bool, bool]:
        """The three flags that decide how ranges are taken."""
        return self.of_array, self.around, self.whole

    def over_arrays(self) -> Scope:
        """Return the same scope, but with ranges taken cell by cell."""
        return self if self.array else replace(self, around=True, whole=False)

    def plainly(self) -> Scope:
        """Return the same scope, but with ranges taken as in the formula, whatever the function around the
        tree wants.
        """
        changes = self.around or self.whole or self.pointing
        return replace(self, around=False, whole=False, pointing=False) if changes else self

    def pointed_at(self) -> Scope:
        """Return the same scope, asking only where the tree leads."""
        return self if self.pointing else replace(self, pointing=True)

    def inside(self) -> Scope:
        """Return the scope of a part of the tree."""
        return replace(self, whole=False, pointing=False) if self.whole or self.pointing else self

    def wanted_whole(self) -> Scope:
        """Return the same scope, but with a range that is all of the tree wanted whole."""
        return self if self.whole else replace(self, whole=True)

    def branch(self) -> Scope:
        """Return the scope of a choice's branch: a range there is whole where the choice is wanted whole or cell by
        cell.
        """
        return replace(self, around=False, whole=self.whole or self.around) if self.around else self

    def of(self, ranges: Ranges) -> Scope:
        """Return the scope of an argument that takes ranges so."""
        if ranges is Ranges.CELLS:
            return self.over_arrays()
        return self if ranges in (Ranges.AROUND, Ranges.ONE_CELL) else self.plainly()

    def seen_from(self, user: Scope) -> Scope:
        """Return the same scope, but with ranges taken, and as deep, as in the scope `user` that uses a
        variable of it.
        """
        return replace(self, of_array=user.of_array, around=user.around, whole=user.whole, depth=user.depth)

    def bound(self, variables: Mapping[str, int | Thunk | Closure]) -> Scope:
        """Return the same scope with more variables."""
        return replace(self, variables={**self.variables, **variables})

    def defining(self, name: str, tree: ir.Expression) -> Scope:
        """Return the same scope with a variable whose tree may name the variable itself."""
        variables = dict(self.variables)
        inner = replace(self, variables=variables)
        variables[name] = Thunk(tree, inner)
        return inner


class TooDeepError(FormulaError):
    """Calls within calls are too many to be written out.

    Attributes:
        repeated: the LAMBDAs among them that call themselves.
    """

    def __init__(self) -> None:
        super().__init__(f"LAMBDAs call each other more than {DEEPEST_CALLS} deep", hint="use REDUCE or SCAN")
        self.repeated: set[Closure] = set()


@dataclass(eq=False, slots=True)
class RecursiveLambda:
    """A LAMBDA that calls itself, lowered on its own.

    Attributes:
        parameters: the nodes that stand for its parameters.
        itself: stands for its calls within itself.
        function: for all other calls; None until it is lowered.
        taken: the nodes that it takes from outside.
    """

    parameters: list[int]
    itself: Function
    function: Function | None = None
    taken: tuple[int, ...] = ()


class LambdaCalls:
    """The LAMBDAs of a workbook that are being called, and those that were lowered on their own.

    Attributes:
        recursive: what decides on its body -> a LAMBDA that was lowered on its own.
    """

    def __init__(self) -> None:
        self._calls: Counter[Closure] = Counter()
        self._made: Counter[Closure] = Counter()
        self._open: Counter[Closure] = Counter()
        self.recursive: dict[object, RecursiveLambda] = {}

    def is_open(self, function: Closure) -> bool:
        """Whether the LAMBDA is being lowered on its own."""
        return self._open[function] > 0

    def is_called(self, function: Closure) -> bool:
        """Whether a call of the LAMBDA is being written out."""
        return self._calls[function] > 0

    @contextmanager
    def calling(self, function: Closure) -> Iterator[None]:
        """Count a call while it is written out."""
        self._calls[function] += 1
        self._made[function] += 1
        try:
            if self._made[function] > _MOST_WRITTEN_OUT:
                raise TooDeepError
            yield
        except TooDeepError as error:
            if self._calls[function] > 1:
                error.repeated.add(function)
            raise
        finally:
            self._calls[function] -= 1
            if not self._calls[function]:
                del self._made[function]

    @contextmanager
    def opening(self, function: Closure) -> Iterator[None]:
        """Mark a LAMBDA while it is lowered on its own."""
        self._open[function] += 1
        try:
            yield
        finally:
            self._open[function] -= 1

    @property
    def any_open(self) -> bool:
        """Whether any LAMBDA is being lowered on its own."""
        return any(self._open.values())


Arguments = tuple[int | Thunk | Closure, ...]


def check_depth(scope: Scope) -> None:
    """Refuse calls within calls that do not end.

    Raises:
        TooDeepError: they are too many.
    """
    if scope.depth >= DEEPEST_CALLS:
        raise TooDeepError


def bind(value: ir.Expression, scope: Scope) -> Thunk | Closure:
    """Return what a variable bound to a tree stands for."""
    return Closure(value, scope) if isinstance(value, ir.Lambda) else Thunk(value, scope)


def let_scope(tree: ir.Let, scope: Scope) -> Scope:
    """Return the scope in which a LET calculates its result."""
    for name, value in tree.bindings:
        scope = scope.defining(name, value) if tree.recursive else scope.bound({name: bind(value, scope)})
    return scope


def find_callee(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> Callee:
    """Return the function that a tree gives.

    Raises:
        FormulaError: it gives none.
    """
    match tree:
        case ir.Lambda():
            return Closure(tree, scope)
        case ir.FunctionName(name):
            return Native(name)
        case ir.Variable(name):
            return _of_variable(lowering, name, scope)
        case ir.Let(_, body):
            return find_callee(lowering, body, let_scope(tree, scope))
        case ir.Invoke(function, arguments):
            called = find_callee(lowering, function, scope)
            if isinstance(called, Closure):
                return _find_result(lowering, called, tuple(bind(part, scope) for part in arguments), scope)
        case ir.Call("IF", (condition, yes, no)):
            return _of_if(lowering, lowering.lower(condition, scope), yes, no, scope)
        case ir.Call("CHOOSE", (index, *options)):
            known = lowering.lookup_constant(lowering.lower(index, scope))
            if known is not None and known.plain and 1 <= known.numbers[0] < len(options) + 1:
                return find_callee(lowering, options[int(known.numbers[0]) - 1], scope)
    raise FormulaError("what is called here is not a LAMBDA")


def _of_variable(lowering: TreeLowering, name: str, scope: Scope) -> Callee:
    result = scope.variables.get(name)
    if isinstance(result, Closure):
        return result
    if isinstance(result, Thunk):
        return _of_thunk(lowering, result)
    raise FormulaError("what is called here is not a LAMBDA")


def _of_thunk(lowering: TreeLowering, thunk: Thunk) -> Callee:
    if thunk.callee is None:
        thunk.callee = find_callee(lowering, thunk.tree, thunk.scope)
    return thunk.callee


def _find_result(lowering: TreeLowering, called: Closure, arguments: Arguments, scope: Scope) -> Callee:
    """Return the function that a call gives, which is called in turn."""
    if not called.takes(len(arguments)):
        raise FormulaError("a LAMBDA that gives a LAMBDA is given another number of arguments than it has parameters")
    check_depth(scope)
    lowering.calls.add()
    return find_callee(lowering, called.function.body, called.inside(arguments, scope))


def _of_if(lowering: TreeLowering, condition: int, yes: ir.Expression, no: ir.Expression, scope: Scope) -> Callee:
    known = lowering.lookup_condition(condition)
    if known is not None:
        return find_callee(lowering, yes if known else no, scope)
    return Fork(condition, find_callee(lowering, yes, scope), find_callee(lowering, no, scope))


def find_function(lowering: TreeLowering, argument: int | Thunk | Closure) -> Callee | None:
    """Return the function that an argument is; None if it is a value, or where its tree does not show it."""
    while isinstance(argument, Thunk):
        match argument.tree:
            case ir.Variable(name):
                argument = argument.scope.variables.get(name, -1)
            case ir.Let(_, ir.Variable(), True) | ir.FunctionName():
                return _of_thunk(lowering, argument)
            case _:
                return None
    return argument if isinstance(argument, Closure) else None


def is_omitted(tree: ir.Expression, scope: Scope) -> bool:
    """Whether a tree is a parameter for which nothing was given, here or further out."""
    while isinstance(tree, ir.Variable):
        result = scope.variables.get(tree.name)
        if not isinstance(result, Thunk):
            return False
        tree, scope = result.tree, result.scope
    return isinstance(tree, ir.Missing)
