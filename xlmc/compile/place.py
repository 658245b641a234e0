"""Where each node is evaluated: on every trial, on the survivors of the filters, or in one branch of an `IF`.

A context is a set of trials. The root holds all of them, `SURVIVORS` those that every filter accepts, and each branch
of an `IF` those that take it. A node goes to the narrowest context that holds all of its uses. A branch that can raise
no error is not worth its own context and is evaluated with its parent.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from xlmc.compile.dag import Apply, Dag, Rescue, Select, uses
from xlmc.functions import Kind

__all__ = ["ROOT", "SURVIVORS", "Context", "place"]


@dataclass(frozen=True, slots=True)
class Context:
    """One set of trials: `select` and `branch` (1 yes, 0 no, -1 rescue) say which of the parent's."""

    parent: Context | None
    select: int
    branch: int

    @property
    def depth(self) -> int:
        return 0 if self.parent is None else self.parent.depth + 1


ROOT = Context(None, -1, 1)
SURVIVORS = Context(ROOT, -1, 1)
NEVER = -1
_SAFE = {"+", "-", "*", "u-", "u+", "%", "=", "<>", "<", "<=", ">", ">=", "NOT", "ABS", "SIGN", "MIN", "MAX", "SUM"}


def place(dag: Dag, first: Sequence[int], late: Sequence[int]) -> dict[int, Context]:
    """The context of every varying node that `first` (all trials) and `late` (survivors) need."""
    contexts: dict[int, Context] = {}
    _use(contexts, first, ROOT)
    _use(contexts, late, SURVIVORS)
    for node in reversed(dag.upstream([*first, *late])):
        for used, context in _edges(dag, node, contexts[node]):
            _use(contexts, [used], context)
    return _without_safe_branches(dag, {node: contexts[node] for node in dag.upstream([*first, *late])})


def _edges(dag: Dag, place: int, context: Context) -> list[tuple[int, Context]]:
    match dag.nodes[place]:
        case Select(condition, yes, no):
            return [(condition, context), (yes, Context(context, place, 1)), (no, Context(context, place, 0))]
        case Rescue(value, instead, _):
            return [(value, context), (instead, Context(context, place, NEVER))]
        case node:
            return [(used, context) for used in uses(node)]


def _use(contexts: dict[int, Context], places: Sequence[int], context: Context) -> None:
    for used in places:
        contexts[used] = _common(contexts[used], context) if used in contexts else context


def _common(a: Context, b: Context) -> Context:
    while a != b:
        if a.depth >= b.depth and a.parent is not None:
            a = a.parent
        elif b.parent is not None:
            b = b.parent
    return a


def _without_safe_branches(dag: Dag, contexts: dict[int, Context]) -> dict[int, Context]:
    members: defaultdict[Context, list[int]] = defaultdict(list)
    for node, context in contexts.items():
        inner: Context | None = context
        while inner is not None:
            members[inner].append(node)
            inner = inner.parent
    safe = {c for c, nodes in members.items() if c.select >= 0 and c.branch != NEVER and _is_hoisted(dag, c, nodes)}
    return {node: _hoisted(context, safe) for node, context in contexts.items()}


def _hoisted(context: Context, safe: set[Context]) -> Context:
    """The nearest context that is kept, its own parents kept too."""
    if context.parent is None:
        return context
    parent = _hoisted(context.parent, safe)
    if context in safe:
        return parent
    return Context(parent, context.select, context.branch) if context != SURVIVORS else context


def _is_hoisted(dag: Dag, context: Context, nodes: list[int]) -> bool:
    """Whether a branch raises no error anywhere, or is of mixed kinds and left to the careful path."""
    return dag.types[context.select] not in (Kind.NUMBER, Kind.LOGICAL) or all(_is_safe(dag, node) for node in nodes)


def _is_safe(dag: Dag, place: int) -> bool:
    node = dag.nodes[place]
    if dag.types[place] is Kind.ANY:
        return False
    return not isinstance(node, Apply) or node.function.name in _SAFE
