"""`IF` whose branches could err: each branch is evaluated on the trials that take it, and on no other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.compile.dag import Constant, Dag, Select, uses
from xlmc.compile.place import Context
from xlmc.compile.steps import Frame, Step, make_step
from xlmc.functions import Kind
from xlmc.functions.values import Value

__all__ = ["branch_step", "externals", "members", "own_contexts"]


def members(contexts: Mapping[int, Context], context: Context) -> list[int]:
    """The nodes of a context itself, in order."""
    return sorted(node for node, where in contexts.items() if where == context)


def externals(dag: Dag, contexts: Mapping[int, Context], context: Context, results: Sequence[int]) -> list[int]:
    """The nodes that a context, its inner contexts included, takes from outside it."""
    inside = {node for node, where in contexts.items() if _within(where, context)}
    read = {used for node in inside for used in uses(dag.nodes[node])} | set(results)
    return sorted(used for used in read - inside if not isinstance(dag.nodes[used], Constant))


def _within(context: Context, outer: Context) -> bool:
    inner: Context | None = context
    while inner is not None and inner != outer:
        inner = inner.parent
    return inner is not None


def own_contexts(contexts: Mapping[int, Context], place: int) -> list[Context]:
    """The branches of an `IF` that hold nodes of their own."""
    found = (Context(contexts[place], place, branch) for branch in (1, 0))
    return [context for context in found if any(_within(other, context) for other in set(contexts.values()))]


def branch_step(dag: Dag, contexts: Mapping[int, Context], place: int) -> Step:
    """The step of an `IF` with at least one branch in a context of its own."""
    select = dag.nodes[place]
    assert isinstance(select, Select)
    branches = [_Branch(dag, contexts, place, 1, select.yes), _Branch(dag, contexts, place, 0, select.no)]
    dtype = np.bool_ if dag.types[place] is Kind.LOGICAL else np.float64

    def step(frame: Frame) -> None:
        condition = _truth(frame.values[select.condition])
        out: NDArray[Any] = np.empty(frame.n, dtype)
        for branch, taken in zip(branches, (condition, ~condition), strict=True):
            index = np.flatnonzero(np.broadcast_to(taken, (frame.n,)))
            if index.size:
                out[index] = branch.run(frame, index)
        frame.values[place] = out

    return step


def _truth(condition: Any) -> NDArray[np.bool_]:
    return np.asarray(condition if np.asarray(condition).dtype == np.bool_ else condition != 0)


class _Branch:
    def __init__(self, dag: Dag, contexts: Mapping[int, Context], place: int, branch: int, result: int) -> None:
        context = Context(contexts[place], place, branch)
        self._result = result
        self._outside = externals(dag, contexts, context, [result])
        self._steps = [_step(dag, contexts, node) for node in members(contexts, context)]

    def run(self, frame: Frame, index: NDArray[np.intp]) -> Any:
        """The branch's value on the trials of `index`."""
        inner = Frame(frame.values.copy(), (), index.size)
        for node in self._outside:
            found = frame.values[node]
            inner.values[node] = found.take(index) if isinstance(found, Value) else found[index]
        for step in self._steps:
            step(inner)
        return inner.values[self._result]


def _step(dag: Dag, contexts: Mapping[int, Context], place: int) -> Step:
    return branch_step(dag, contexts, place) if own_contexts(contexts, place) else make_step(dag, place, None)
