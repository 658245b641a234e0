"""Where each node is evaluated: on every trial, on the survivors of the filters, or in one branch of an `IF`.

A context is a set of trials. The root holds all of them, `SURVIVORS` those that every filter accepts, and each branch
of an `IF` those that take it. A node goes to the narrowest context that holds all of its uses. A branch that can raise
no error is not worth its own context and is evaluated with its parent.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from xlmc.evaluation.graph.dag import Apply, Constant, Dag, Input, Select
from xlmc.evaluation.numpy.steps import reads
from xlmc.functions import Kind

__all__ = ["ROOT", "SURVIVORS", "Context", "Placement"]


@dataclass(frozen=True, slots=True, eq=False)
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


class Placement:
    """The context of every varying node that `first` (all trials) and `late` (survivors) need on the fast path.

    Attributes:
        reads: by node, the nodes whose values its step needs.
        branched: the `IF`s with branches that hold nodes of their own.
    """

    def __init__(self, dag: Dag, first: Sequence[int], late: Sequence[int]) -> None:
        self._dag = dag
        self.reads: dict[int, tuple[int, ...]] = {}
        contexts = self._contexts(first, late)
        hoisted = _without_safe_branches(dag, contexts)
        self._members: defaultdict[Context, list[int]] = defaultdict(list)
        for node in reversed(contexts):  # they were found from the last to the first
            context = contexts[node]
            self._members[hoisted.get(context, context)].append(node)
        self._inner: defaultdict[Context, list[Context]] = defaultdict(list)
        self._branches: defaultdict[int, list[Context]] = defaultdict(list)
        for context in dict.fromkeys(outer for inner in self._members for outer in _outwards(inner)):
            if context.parent is not None and context is not SURVIVORS:
                self._inner[context.parent].append(context)
                self._branches[context.select].append(context)
        self.branched = frozenset(self._branches)

    def members(self, context: Context) -> list[int]:
        """The nodes of a context itself, in order."""
        return self._members.get(context, [])

    def branches(self, place: int) -> list[Context]:
        """The branches of an `IF` that hold nodes of their own."""
        return self._branches.get(place, [])

    def externals(self, context: Context | None, results: Iterable[int]) -> list[int]:
        """The varying nodes that a context, its inner contexts included, takes from outside it; None has no nodes."""
        inside = set() if context is None else set(self._inside(context))
        read = {used for node in inside for used in self.reads[node]} | set(results)
        return sorted(node for node in read - inside if not isinstance(self._dag.nodes[node], Constant))

    def _inside(self, context: Context) -> Iterator[int]:
        yield from self.members(context)
        for inner in self._inner.get(context, ()):
            yield from self._inside(inner)

    def _contexts(self, first: Sequence[int], late: Sequence[int]) -> dict[int, Context]:
        """The context of each needed node, from the last node to the first."""
        nodes, types = self._dag.nodes, self._dag.types
        wanted: list[Context | None] = [None] * len(nodes)
        for places, context in ((first, ROOT), (late, SURVIVORS)):
            for place in places:
                wanted[place] = _common(wanted[place], context)
        found: dict[int, Context] = {}
        for place in range(len(nodes) - 1, -1, -1):
            at = wanted[place]
            node = nodes[place]
            if at is None or type(node) is Constant:
                continue
            if type(node) is Input:
                at = _undivided(at)  # draws are there for all trials
            found[place] = at
            self.reads[place] = read = reads(self._dag, place)
            if type(node) is Select and at.depth < _DEEPEST and _divides(types[place], types[node.condition]):
                edges = [(node.condition, at), (node.yes, _branch(at, place, 1)), (node.no, _branch(at, place, 0))]
                for used, inner in edges:
                    wanted[used] = _common(wanted[used], inner)
                continue
            for used in read:
                if wanted[used] is not at:
                    wanted[used] = _common(wanted[used], at)
        return found


def _branch(parent: Context, select: int, branch: int) -> Context:
    return Context(parent, select, branch, parent.depth + 1)


def _divides(result: Kind, condition: Kind) -> bool:
    """Whether the trials can be parted by the condition at sight, and the results put together again."""
    return {result, condition} <= {Kind.NUMBER, Kind.LOGICAL}


def _undivided(context: Context) -> Context:
    while context.select >= 0 and context.parent is not None:
        context = context.parent
    return context


def _common(a: Context | None, b: Context) -> Context:
    """The narrowest context that holds the trials of both; of nothing yet and one, that one."""
    if a is None:
        return b
    while a is not b:
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


def _without_safe_branches(dag: Dag, contexts: dict[int, Context]) -> dict[Context, Context]:
    """The branches in which nothing can err, and the nearest context around that is kept."""
    kept = {ROOT, SURVIVORS}
    for node, context in contexts.items():
        if context not in kept and not _is_safe(dag, node):
            kept.update(_outwards(context))
    return {context: _kept(context, kept) for context in set(contexts.values()) - kept}


def _kept(context: Context, kept: set[Context]) -> Context:
    while context not in kept and context.parent is not None:
        context = context.parent
    return context


def _is_safe(dag: Dag, place: int) -> bool:
    node = dag.nodes[place]
    if dag.types[place] is Kind.ANY:
        return False
    return not isinstance(node, Apply) or node.function.facts.never_errs
