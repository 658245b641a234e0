"""What a node of the graph is: a constant, an input, a function of other nodes, or cells side by side.

Elsewhere a node is known by its index in `Dag.nodes`: `node`, or `node_id` where the node itself is at hand, too.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, assert_never

from xlmc.functions import Function
from xlmc.functions.values import Value

__all__ = ["Apply", "Constant", "IfErrorNode", "Input", "Node", "Range", "Select", "uses"]


@dataclass(frozen=True, slots=True, eq=False)
class Constant:
    """A value known before the run, `(1,)` or `(1, r, c)`."""

    value: Value


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


Node = Constant | Input | Apply | Select | IfErrorNode | Range


def uses(node: Node) -> tuple[int, ...]:
    """The nodes that a node reads, from left to right."""
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
