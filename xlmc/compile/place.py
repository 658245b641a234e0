"""Where each node is evaluated: on every trial, on the survivors of the filters, or in one branch of an `IF`.

A context is a set of trials. The root holds all of them, `SURVIVORS` those that every filter accepts, and each branch
of an `IF` those that take it. A node goes to the narrowest context that holds all of its uses. A branch that can raise
no error is not worth its own context and is evaluated with its parent.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial
from typing import Final

from xlmc.compile.dag import Apply, Constant, Dag, Input, Select
from xlmc.compile.steps import reads
from xlmc.functions import Kind

__all__ = ["ROOT", "SURVIVORS", "Context", "Placement"]


@dataclass(frozen=True, slots=True)
class Context:
    """One set of trials: `select` and `branch` (1 yes, 0 no) say which of the parent's."""

    parent: Context | None
    select: int
    branch: int
    depth: int = 0


ROOT = Context(None, -1, 1)
SURVIVORS = Context(ROOT, -1, 1, 1)

_DEEPEST: Final = 8
"""Branches within branches; below, both branches are evaluated on the trials of the one around them."""

_SAFE = {"+", "-", "*", "u-", "u+", "%", "=", "<>", "<", "<=", ">", ">=", "NOT", "ABS", "SIGN", "MIN", "MAX", "SUM"}


Reads = Callable[[int], tuple[int, ...]]


class Placement:
    """The context of every varying node that `first` (all trials) and `late` (survivors) need on the fast path.

    Attributes:
        reads: the nodes whose values the step of a node needs.
    """

    def __init__(self, dag: Dag, first: Sequence[int], late: Sequence[int]) -> None:
        self._dag = dag
        self.reads: Reads = cache(partial(reads, dag))
        self._members: defaultdict[Context, list[int]] = defaultdict(list)
        contexts = _without_safe_branches(dag, _contexts(dag, self.reads, first, late))
        for node, context in sorted(contexts.items()):
            self._members[context].append(node)
        self._inner: defaultdict[Context, list[Context]] = defaultdict(list)
        self._branches: defaultdict[int, list[Context]] = defaultdict(list)
        for context in {outer for inner in self._members for outer in _outwards(inner)} - {ROOT, SURVIVORS}:
            if context.parent is not None:
                self._inner[context.parent].append(context)
                self._branches[context.select].append(context)

    def members(self, context: Context) -> list[int]:
        """The nodes of a context itself, in order."""
        return self._members.get(context, [])

    def branches(self, place: int) -> list[Context]:
        """The branches of an `IF` that hold nodes of their own."""
        return self._branches.get(place, [])

    def externals(self, context: Context, results: Iterable[int]) -> list[int]:
        """The varying nodes that a context, its inner contexts included, takes from outside it."""
        inside = set(self._inside(context))
        read = {used for node in inside for used in self.reads(node)} | set(results)
        return sorted(node for node in read - inside if not isinstance(self._dag.nodes[node], Constant))

    def _inside(self, context: Context) -> Iterator[int]:
        yield from self.members(context)
        for inner in self._inner.get(context, ()):
            yield from self._inside(inner)


def _contexts(dag: Dag, reads: Reads, first: Sequence[int], late: Sequence[int]) -> dict[int, Context]:
    contexts: dict[int, Context] = {}
    _use(dag, contexts, first, ROOT)
    _use(dag, contexts, late, SURVIVORS)
    needed = dag.upstream([*first, *late], reads)
    for node in reversed(needed):
        for used, context in _edges(dag, reads, node, contexts[node]):
            _use(dag, contexts, [used], context)
    return {node: contexts[node] for node in needed}


def _edges(dag: Dag, reads: Reads, place: int, context: Context) -> list[tuple[int, Context]]:
    match dag.nodes[place]:
        case Select(condition, yes, no) if _divides(dag, place, condition, context):
            return [(condition, context), (yes, _branch(context, place, 1)), (no, _branch(context, place, 0))]
        case _:
            return [(used, context) for used in reads(place)]


def _branch(parent: Context, select: int, branch: int) -> Context:
    return Context(parent, select, branch, parent.depth + 1)


def _divides(dag: Dag, place: int, condition: int, context: Context) -> bool:
    """Whether the trials can be parted by the condition at sight, and the results put together again."""
    return {dag.types[place], dag.types[condition]} <= {Kind.NUMBER, Kind.LOGICAL} and context.depth < _DEEPEST


def _use(dag: Dag, contexts: dict[int, Context], places: Sequence[int], context: Context) -> None:
    for used in places:
        wanted = context
        while isinstance(dag.nodes[used], Input) and wanted.select >= 0 and wanted.parent is not None:
            wanted = wanted.parent  # draws are there for all trials
        contexts[used] = _common(contexts[used], wanted) if used in contexts else wanted


def _common(a: Context, b: Context) -> Context:
    while a is not b and a != b:
        if a.depth >= b.depth and a.parent is not None:
            a = a.parent
        elif b.parent is not None:
            b = b.parent
    return a


def _outwards(context: Context) -> Iterator[Context]:
    inner: Context | None = context
    while inner is not None:
        yield inner
        inner = inner.parent


def _without_safe_branches(dag: Dag, contexts: dict[int, Context]) -> dict[int, Context]:
    kept = {ROOT, SURVIVORS}
    for node, context in contexts.items():
        if context not in kept and not _is_safe(dag, node):
            kept.update(_outwards(context))
    return {node: _hoisted(context, kept) for node, context in contexts.items()}


def _hoisted(context: Context, kept: set[Context]) -> Context:
    """The nearest context around that is kept."""
    while context not in kept and context.parent is not None:
        context = context.parent
    return context


def _is_safe(dag: Dag, place: int) -> bool:
    node = dag.nodes[place]
    if dag.types[place] is Kind.ANY:
        return False
    return not isinstance(node, Apply) or node.function.name in _SAFE
