"""What the loop can compute, and how: a node's operands and the instructions that make its value of them."""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from xlmc.evaluation.graph.dag import Apply, Constant, Dag, Node, Rescue, Select, uses
from xlmc.functions import Kind

if TYPE_CHECKING:
    from xlmc.evaluation.llvm.body import Body

__all__ = ["PLAIN", "Emit", "Literal", "Operand", "Recipe", "literal", "reads", "recipe_of"]

PLAIN: Final = (Kind.NUMBER, Kind.LOGICAL)
"""What a value in the loop may be: a double or a truth value."""

Emit = Callable[["Body", Sequence[Any]], Any]
"""Takes the operands' values in the loop, gives the node's."""


@dataclass(frozen=True, slots=True)
class Operand:
    """A node, and what it is taken as: NUMBER or LOGICAL."""

    place: int
    kind: Kind


@dataclass(frozen=True, slots=True)
class Literal:
    """A number or truth value known before the run."""

    value: float | bool


@dataclass(frozen=True, slots=True, eq=False)
class Recipe:
    """How the loop computes a node.

    Attributes:
        absorbs: the operands of which an infinity or NaN may leave no trace in the result.
        makes: whether finite operands may give an infinity or NaN.
        beside: nodes whose errors are the node's too, although their values do not matter.
    """

    operands: tuple[Operand | Literal, ...]
    emit: Emit
    absorbs: Container[int] = ()
    makes: bool = True
    beside: tuple[int, ...] = ()


def literal(dag: Dag, operand: Operand) -> Literal | None:
    """A constant as the loop takes it; None where it varies, is an error, many cells, or a text that is no number."""
    node = dag.nodes[operand.place]
    if not isinstance(node, Constant) or dag.sizes[operand.place] is not None:
        return None
    values, errors = node.value.to_numbers() if operand.kind is Kind.NUMBER else node.value.to_logicals()
    if values.size != 1 or errors.any():
        return None
    return Literal(values.item())


def _readable(dag: Dag, operand: Operand) -> bool:
    if isinstance(dag.nodes[operand.place], Constant):
        return literal(dag, operand) is not None
    return dag.sizes[operand.place] is None


def recipe_of(dag: Dag, place: int) -> Recipe | None:
    """How the loop computes a node; None where it cannot."""
    kind = dag.types[place]
    if dag.sizes[place] is not None or kind not in PLAIN:
        return None
    recipe = _recipe(dag, dag.nodes[place], kind)
    if recipe is None or not all(_readable(dag, part) for part in recipe.operands if isinstance(part, Operand)):
        return None
    return recipe


def _recipe(dag: Dag, node: Node, kind: Kind) -> Recipe | None:
    from xlmc.evaluation.llvm.operations import operation
    from xlmc.evaluation.llvm.sets import over_cells

    match node:
        case Apply():
            return operation(dag, node) or over_cells(dag, node)
        case Select(condition, yes, no):
            operands = Operand(condition, Kind.LOGICAL), Operand(yes, kind), Operand(no, kind)
            return Recipe(operands, lambda body, parts: body.builder.select(*parts), makes=False)
        case Rescue(value) if dag.types[value] is kind:
            # Where the value may be an error the trial is computed again: what stands in is never needed here.
            return Recipe((Operand(value, kind),), lambda body, parts: parts[0], makes=False)
        case _:
            return None


def reads(dag: Dag, place: int, recipe: Recipe | None) -> tuple[int, ...]:
    """The nodes that a node's computation needs: by its recipe, or whole where it has none."""
    if recipe is None:
        return uses(dag.nodes[place])
    return (*(part.place for part in recipe.operands if isinstance(part, Operand)), *recipe.beside)
