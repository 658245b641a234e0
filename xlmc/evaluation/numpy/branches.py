"""`IF` whose branches could err: each branch is evaluated on the trials that take it, and on no other."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.evaluation.graph.dag import Dag, Select
from xlmc.evaluation.numpy.place import Context, Placement
from xlmc.evaluation.numpy.steps import Frame, Step, make_step
from xlmc.functions import Kind
from xlmc.functions.values import Value

__all__ = ["branch_step"]


def branch_step(dag: Dag, placement: Placement, place: int) -> Step:
    """The step of an `IF` with at least one branch in a context of its own."""
    select = dag.nodes[place]
    assert isinstance(select, Select)
    contexts = {context.branch: context for context in placement.branches(place)}
    yes = _Branch(dag, placement, contexts.get(1), select.yes)
    no = _Branch(dag, placement, contexts.get(0), select.no)
    dtype = np.bool_ if dag.types[place] is Kind.LOGICAL else np.float64

    def step(frame: Frame) -> None:
        condition = _truth(frame.values[select.condition])
        out: NDArray[Any] = np.empty(frame.n, dtype)
        for branch, taken in ((yes, condition), (no, ~condition)):
            index = np.flatnonzero(taken)
            if index.size:
                out[index] = branch.run(frame, index)
        frame.values[place] = out

    return step


def _truth(condition: NDArray[Any]) -> NDArray[np.bool_]:
    return np.asarray(condition if condition.dtype == np.bool_ else condition != 0)


class _Branch:
    """What a branch computes; without a context of its own, its result alone is taken."""

    def __init__(self, dag: Dag, placement: Placement, context: Context | None, result: int) -> None:
        self._result = result
        self._outside = placement.externals(context, [result])
        members = [] if context is None else placement.members(context)
        self._steps = [_step(dag, placement, node) for node in members]

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


def _step(dag: Dag, placement: Placement, place: int) -> Step:
    return branch_step(dag, placement, place) if placement.branches(place) else make_step(dag, place, None)
