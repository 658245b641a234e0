"""Which trials each node is evaluated on: all of them, the survivors of the filters, or those of one branch of an `IF`.

A context is a set of trials. The root holds all of them, `SURVIVORS` those that every filter accepts, and each branch
of an `IF` those that take it. A node goes to the narrowest context that holds all of its uses. A branch that can raise
no error is not worth its own context and is evaluated with its parent; one that could err is evaluated on the trials
that take it, and on no other.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.evaluation.graph.dag import Dag
from xlmc.evaluation.graph.nodes import Apply, Constant, Input, Select
from xlmc.evaluation.numpy.steps import Frame, Step, make_step, reads
from xlmc.functions import Kind
from xlmc.functions.values import Value

__all__ = ["ROOT", "SURVIVORS", "Context", "Placement", "branch_step"]

_DEEPEST: Final = 8
"""Branches within branches; below, both branches are evaluated on the trials of the one around them."""


@dataclass(frozen=True, slots=True, eq=False)
class Context:
    """One set of trials: `select` and `branch` (1 yes, 0 no) say which of the parent's."""

    parent: Context | None
    select: int
    branch: int
    depth: int = 0


ROOT = Context(None, -1, 1)
SURVIVORS = Context(ROOT, -1, 1, 1)


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

    def branches(self, node: int) -> list[Context]:
        """The branches of an `IF` that hold nodes of their own."""
        return self._branches.get(node, [])

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
        for node_ids, context in ((first, ROOT), (late, SURVIVORS)):
            for node_id in node_ids:
                wanted[node_id] = _common(wanted[node_id], context)
        found: dict[int, Context] = {}
        for node_id in range(len(nodes) - 1, -1, -1):
            at = wanted[node_id]
            node = nodes[node_id]
            if at is None or type(node) is Constant:
                continue
            if type(node) is Input:
                at = _undivide(at)  # draws are there for all trials
            found[node_id] = at
            self.reads[node_id] = read = reads(self._dag, node_id)
            if type(node) is Select and at.depth < _DEEPEST and _divides(types[node_id], types[node.condition]):
                edges = [(node.condition, at), (node.yes, _branch(at, node_id, 1)), (node.no, _branch(at, node_id, 0))]
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


def _undivide(context: Context) -> Context:
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


def _is_safe(dag: Dag, node_id: int) -> bool:
    node = dag.nodes[node_id]
    if dag.types[node_id] is Kind.ANY:
        return False
    return not isinstance(node, Apply) or node.function.facts.never_errs


def branch_step(dag: Dag, placement: Placement, node: int) -> Step:
    """The step of an `IF` with at least one branch in a context of its own."""
    select = dag.nodes[node]
    assert isinstance(select, Select)
    contexts = {context.branch: context for context in placement.branches(node)}
    yes = _Branch(dag, placement, contexts.get(1), select.yes)
    no = _Branch(dag, placement, contexts.get(0), select.no)
    dtype = np.bool_ if dag.types[node] is Kind.LOGICAL else np.float64

    def step(frame: Frame) -> None:
        condition = _truth(frame.values[select.condition])
        out: NDArray[Any] = np.empty(frame.n, dtype)
        for branch, taken in ((yes, condition), (no, ~condition)):
            index = np.flatnonzero(taken)
            if index.size:
                out[index] = branch.run(frame, index)
        frame.values[node] = out

    return step


def _truth(condition: NDArray[Any]) -> NDArray[np.bool_]:
    return np.asarray(condition if condition.dtype == np.bool_ else condition != 0)


class _Branch:
    """What a branch computes; without a context of its own, its result alone is taken."""

    def __init__(self, dag: Dag, placement: Placement, context: Context | None, result: int) -> None:
        self._result = result
        self._outside = placement.externals(context, [result])
        members = [] if context is None else placement.members(context)
        self._steps = [_member_step(dag, placement, node) for node in members]

    def run(self, frame: Frame, index: NDArray[np.intp]) -> Any:
        """The branch's value on the trials of `index`; for that long the values from outside are those of `index`."""
        values = frame.values
        whole = [values[node] for node in self._outside]
        for node, found in zip(self._outside, whole, strict=True):
            values[node] = found.take(index) if isinstance(found, Value) else found[index]
        inner = Frame(values, (), index.size, frame.underflow)
        for step in self._steps:
            step(inner)
        result = values[self._result]
        for node, found in zip(self._outside, whole, strict=True):
            values[node] = found
        return result


def _member_step(dag: Dag, placement: Placement, node: int) -> Step:
    return branch_step(dag, placement, node) if placement.branches(node) else make_step(dag, node, None)
