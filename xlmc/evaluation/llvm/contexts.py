"""In which trials each node of a loop is needed: in all of them, or only where an `IF` takes the branch it stands in.

The loop computes both branches of every `IF`; what goes wrong in one counts only in the trials that take it. A node
that is needed in several places belongs to the innermost context around all of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from xlmc.evaluation.graph.dag import Dag, Select
from xlmc.evaluation.llvm.recipes import Recipe, reads

__all__ = ["ROOT", "Context", "branch", "contexts"]

_DEEPEST: Final = 8
"""Branches within branches; what errs in deeper ones counts in all trials of the one around them."""


@dataclass(frozen=True, slots=True)
class Context:
    """The trials in which an `IF`, the node `select` of the context `parent`, takes the branch: 1 yes, 0 no."""

    parent: Context | None
    select: int = -1
    branch: int = 1
    depth: int = 0


ROOT: Final = Context(None)


def branch(parent: Context, select: int, taken: int) -> Context:
    """The context of a branch."""
    return parent if parent.depth == _DEEPEST else Context(parent, select, taken, parent.depth + 1)


def contexts(dag: Dag, recipes: Mapping[int, Recipe], results: Sequence[int]) -> dict[int, Context]:
    """The context of every node that `recipes` computes, `results` being needed in all trials."""
    found: dict[int, Context] = {place: ROOT for place in results if place in recipes}
    for place in sorted(recipes, reverse=True):
        for used, context in _edges(dag, place, recipes[place], found.get(place, ROOT)):
            if used in recipes:
                found[used] = _common(found[used], context) if used in found else context
    return found


def _edges(dag: Dag, place: int, recipe: Recipe, context: Context) -> Iterator[tuple[int, Context]]:
    node = dag.nodes[place]
    if isinstance(node, Select):
        yield node.condition, context
        yield node.yes, branch(context, place, 1)
        yield node.no, branch(context, place, 0)
    else:
        for used in reads(dag, place, recipe):
            yield used, context


def _common(a: Context, b: Context) -> Context:
    while a is not b and a != b:
        if a.depth >= b.depth and a.parent is not None:
            a = a.parent
        elif b.parent is not None:
            b = b.parent
    return a
