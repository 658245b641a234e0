"""A rule says how the loop computes a node: its operands, and the instructions that make its value of them."""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence
from typing import Any, Final, NamedTuple, Protocol

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Constant, uses
from xlmc.excel.functions import Kind

__all__ = [
    "PLAIN",
    "Emit",
    "Emitter",
    "Literal",
    "LoopRule",
    "Operand",
    "first_operand",
    "is_number",
    "literal",
    "part_of",
    "reads",
]

PLAIN: Final = (Kind.NUMBER, Kind.LOGICAL)
"""What a value in the loop may be: a double or a truth value."""


class Emitter(Protocol):
    """Emits the instructions of a node for its rule: see `Body`, which is one.

    Attributes:
        builder: where instructions go.
        real: the type of numbers.
    """

    builder: Any
    real: Any

    def number(self, value: float) -> Any:
        """Make a constant."""

    def truth(self, value: bool) -> Any:
        """Make a constant truth value."""

    def intrinsic(self, name: str, *arguments: Any) -> Any:
        """Call one of LLVM's own functions of numbers."""

    def of_doubles(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Emit a function that is made of arithmetic."""

    def sine_and_cosine(self, angle: Any) -> tuple[Any, Any]:
        """Emit the sine and the cosine of an angle, once for each angle."""

    def flush(self, value: Any) -> Any:
        """0 instead of a number too small for Excel."""

    def flag(self, wrong: Any) -> None:
        """Have the trial computed again where `wrong` holds, if it needs the node at hand."""


Emit = Callable[[Emitter, Sequence[Any]], Any]
"""Takes the operands' values in the loop, gives the node's."""


class Operand(NamedTuple):
    """A node that varies, and what it is taken as: NUMBER or LOGICAL."""

    node: int
    kind: Kind


class Literal(NamedTuple):
    """A number or truth value known before the run."""

    value: float | bool


class LoopRule(NamedTuple):
    """How the loop computes a node. A tuple, like its operands, because nearly every node has one.

    Attributes:
        absorbs: the operands of which an infinity or NaN may leave no trace in the result.
        makes: whether finite operands may give an infinity or NaN.
        beside: what makes the node an error where it is one, although its value does not matter.
    """

    operands: tuple[Operand | Literal, ...]
    emit: Emit
    absorbs: Container[int] = ()
    makes: bool = True
    beside: tuple[Operand, ...] = ()


def is_number(part: Operand | Literal) -> bool:
    """Whether it is a number that is known before the run; a truth value is none."""
    return type(part) is Literal and type(part.value) is not bool


def first_operand(_: Emitter, parts: Sequence[Any]) -> Any:
    """Emit nothing: the value is that of the first operand."""
    return parts[0]


def part_of(dag: Dag, node: int, kind: Kind) -> Operand | Literal | None:
    """How a rule takes a node as a kind; None if it is many cells, or a constant that is not of that kind."""
    if type(dag.nodes[node]) is Constant:
        return literal(dag, Operand(node, kind))
    return Operand(node, kind) if dag.sizes[node] is None else None


def literal(dag: Dag, operand: Operand) -> Literal | None:
    """Return the constant that a node is; None if it varies, is an error, many cells, or a text that is no number."""
    node = dag.nodes[operand.node]
    if not isinstance(node, Constant) or dag.sizes[operand.node] is not None:
        return None
    if operand.kind is Kind.NUMBER and dag.types[operand.node] is Kind.NUMBER:
        return Literal(float(node.value.numbers[0]))
    values, errors = dag.to_numbers(node.value) if operand.kind is Kind.NUMBER else node.value.to_logicals()
    if values.size != 1 or errors.any():
        return None
    return Literal(values.item())


def reads(dag: Dag, node: int, rule: LoopRule | None) -> tuple[int, ...]:
    """Return the nodes that a node's computation needs: by its rule, or all that it uses where it has no rule."""
    if rule is None:
        return uses(dag.nodes[node])
    return tuple([part.node for part in (*rule.operands, *rule.beside) if type(part) is Operand])
