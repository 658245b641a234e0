"""A rule says how the loop computes a node: its operands, and the instructions that make its value of them."""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence
from dataclasses import dataclass
from typing import Any, Final, Protocol

from xlmc.evaluation.graph.dag import Dag
from xlmc.evaluation.graph.nodes import Constant, uses
from xlmc.functions import Kind

__all__ = ["PLAIN", "Emit", "Emitter", "Literal", "LoopRule", "Operand", "first_operand", "literal", "reads"]

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
        """A constant."""

    def truth(self, value: bool) -> Any:
        """A constant truth value."""

    def intrinsic(self, name: str, *arguments: Any) -> Any:
        """A call of one of LLVM's own functions of numbers."""

    def of_doubles(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """A function that is made of arithmetic."""

    def sine_and_cosine(self, angle: Any) -> tuple[Any, Any]:
        """The sine and the cosine of an angle, computed once for each angle."""

    def flush(self, value: Any) -> Any:
        """0 instead of a number too small for Excel."""

    def flag(self, wrong: Any) -> None:
        """The trial must be computed again where `wrong` holds, if it needs the node at hand."""


Emit = Callable[[Emitter, Sequence[Any]], Any]
"""Takes the operands' values in the loop, gives the node's."""


@dataclass(frozen=True, slots=True)
class Operand:
    """A node, and what it is taken as: NUMBER or LOGICAL."""

    node: int
    kind: Kind


@dataclass(frozen=True, slots=True)
class Literal:
    """A number or truth value known before the run."""

    value: float | bool


@dataclass(frozen=True, slots=True, eq=False)
class LoopRule:
    """How the loop computes a node.

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


def first_operand(_: Emitter, parts: Sequence[Any]) -> Any:
    """Emits nothing: the value is that of the first operand."""
    return parts[0]


def literal(dag: Dag, operand: Operand) -> Literal | None:
    """The constant that a node is; None where it varies, is an error, many cells, or a text that is no number."""
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
    """The nodes that a node's computation needs: by its rule, or all that it uses where it has no rule."""
    if rule is None:
        return uses(dag.nodes[node])
    return tuple([part.node for part in (*rule.operands, *rule.beside) if isinstance(part, Operand)])
