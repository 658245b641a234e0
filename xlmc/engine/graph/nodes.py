"""Define the nodes of the graph: constants, inputs, functions of other nodes, and cells side by side.

Elsewhere a node is known by its index in `Dag.nodes`: `node`, or `node_id` where the node itself is at hand, too.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, assert_never

from xlmc.excel.functions import Function
from xlmc.excel.functions.values import Value

if TYPE_CHECKING:
    from xlmc.excel.address import Cell
    from xlmc.excel.formula import ir

__all__ = [
    "Apply",
    "Constant",
    "Forgotten",
    "IfErrorNode",
    "Input",
    "Node",
    "Range",
    "Select",
    "Target",
    "in_slots",
    "uses",
]


@dataclass(frozen=True, slots=True, eq=False)
class Constant:
    """A value known before the run, `(1,)` or `(1, r, c)`."""

    value: Value


class Forgotten(Constant):
    """A constant array that was dropped for its memory, and is computed again when it is asked for."""

    __slots__ = ("_compute",)

    _compute: Callable[[], Value]

    def __init__(self, compute: Callable[[], Value]) -> None:
        object.__setattr__(self, "_compute", compute)

    @property
    def value(self) -> Value:
        """The value, which is kept from now on."""
        return self._compute()

    def __reduce__(self) -> tuple[Any, ...]:
        """Another process gets what has no value: no node that it evaluates reads this one."""
        return Forgotten, (_never_read,)


def _never_read() -> Value:
    raise RuntimeError("a constant array that nothing reads was asked for in another process")


@dataclass(frozen=True, slots=True)
class Input:
    """An assumption's draws, `(n,)`."""

    name: str


class Apply(NamedTuple):
    """A function of the registry. A tuple, because nearly every node is one, and looked up in a dict."""

    function: Function
    arguments: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Select:
    """`IF`: a node of its own because only one branch is needed in each trial."""

    condition: int
    yes: int
    no: int


@dataclass(frozen=True, slots=True)
class IfErrorNode:
    """`IFERROR`, `IFNA`: `instead` is needed only where `value` is an error (of `IFNA`, #N/A)."""

    value: int
    instead: int
    only_na: bool


@dataclass(frozen=True, slots=True)
class Range:
    """Cells side by side, `(n, r, c)`."""

    rows: tuple[tuple[int, ...], ...]


@dataclass(frozen=True, slots=True)
class Target:
    """What to compute: a resolved tree, and the cell that messages about it name."""

    tree: ir.Expression
    cell: Cell


Node = Constant | Input | Apply | Select | IfErrorNode | Range


def uses(node: Node) -> tuple[int, ...]:
    """Return the nodes that a node reads, from left to right."""
    match node:
        case Constant() | Input():
            return ()
        case Apply(_, arguments):
            return arguments
        case Select(condition, yes, no):
            return condition, yes, no
        case IfErrorNode(value, instead):
            return value, instead
        case Range(rows):
            return tuple(node_id for row in rows for node_id in row)
        case _:
            assert_never(node)


def in_slots(node: Node, slots: Mapping[int, int]) -> Apply | Select | IfErrorNode | Range:
    """Return a node whose parts are known by other numbers.

    Raises:
        TypeError: it has no parts.
    """
    match node:
        case Apply(function, arguments):
            return Apply(function, tuple(slots[node_id] for node_id in arguments))
        case Select(condition, yes, no):
            return Select(slots[condition], slots[yes], slots[no])
        case IfErrorNode(value, instead, only_na):
            return IfErrorNode(slots[value], slots[instead], only_na)
        case Range(rows):
            return Range(tuple(tuple(slots[node_id] for node_id in row) for row in rows))
        case Constant() | Input():
            raise TypeError(f"{node} depends on nothing")
        case _:
            assert_never(node)
