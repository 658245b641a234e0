"""The steps of a program in order, their buffers, and the frames they run in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.evaluation.engine import Column, column_of
from xlmc.evaluation.graph.dag import Dag, Input, constants
from xlmc.evaluation.numpy.branches import branch_step
from xlmc.evaluation.numpy.buffers import Buffers
from xlmc.evaluation.numpy.place import ROOT, SURVIVORS, Context, Placement
from xlmc.evaluation.numpy.sequence import Steps
from xlmc.evaluation.numpy.steps import Frame, Step, plain_constant
from xlmc.evaluation.passes.bounds import Bounds, bounds
from xlmc.functions import Kind
from xlmc.functions.denormals import Underflow
from xlmc.functions.values import Floats, Value

__all__ = ["Plan", "Space"]


class Plan:
    """How to run a graph of nodes: which steps, on which trials, into which buffers.

    Args:
        between: name of an input -> its bounds, where they are known.

    Attributes:
        inputs: the names of those it reads.
    """

    def __init__(
        self,
        dag: Dag,
        filters: Sequence[int],
        forecasts: Sequence[int],
        between: Mapping[str, Bounds] | None = None,
    ) -> None:
        self._dag, self._filters, self._forecasts = dag, filters, forecasts
        self._between = bounds(dag, dag.upstream([*filters, *forecasts]), between) if between else {}
        self._placement = Placement(dag, filters, forecasts)
        self._template: list[Any] = [None] * len(dag.nodes)
        for node, value in constants(dag):
            self._template[node] = plain_constant(value)
        self._carried = self._placement.externals(SURVIVORS, forecasts)
        self._early_inputs, self._late_inputs = self._inputs(ROOT), self._inputs(SURVIVORS)
        self.inputs = frozenset(name for _, name in self._early_inputs + self._late_inputs)
        self.buffers = Buffers(dag)
        self._first = self._steps(ROOT, {*filters, *self._carried}, free_at_end=filters)
        self._gathers = [(node, self._carry(node)) for node in self._carried]
        self.buffers.free(self._carried)
        self._late = self._steps(SURVIVORS, set(forecasts), free_at_end=())

    def _inputs(self, context: Context) -> list[tuple[int, str]]:
        found = [(node, self._dag.nodes[node]) for node in self._placement.members(context)]
        return [(node, input_.name) for node, input_ in found if isinstance(input_, Input)]

    def _steps(self, context: Context, keep: set[int], free_at_end: Sequence[int]) -> list[Step]:
        """The steps of one context; `keep` outlives them."""
        nodes, branched = self._dag.nodes, self._placement.branched
        computed = [node for node in self._placement.members(context) if type(nodes[node]) is not Input]
        read = self._placement.reads | {node: self._reads(node) for node in computed if node in branched}
        last = {needed: node for node in computed for needed in read[node]} | dict.fromkeys(keep, -1)
        steps = Steps(self._dag, self.buffers, computed, self._between)
        for node in computed:
            done = [needed for needed in read[node] if last[needed] == node]
            if node in branched:
                steps.add_free(branch_step(self._dag, self._placement, node), done)
            else:
                steps.add(node, read[node], done)
        self.buffers.free(node for node in free_at_end if node not in self._carried)
        return steps.finish()

    def _reads(self, node: int) -> tuple[int, ...]:
        """What an `IF` needs, its branches included."""
        branches = self._placement.branches(node)
        inner = (read for branch in branches for read in self._placement.externals(branch, ()))
        return (*self._placement.reads[node], *inner)

    def _carry(self, node: int) -> int | None:
        """A buffer for the survivors of a node that the first steps computed."""
        kind = self._dag.types[node]
        return self.buffers.take_for(kind) if kind in (Kind.NUMBER, Kind.LOGICAL) else None

    def run_filters(self, space: Space, inputs: Mapping[str, Floats], n: int) -> list[Column]:
        """Evaluate what the filters need on all `n` trials.

        Raises:
            Departure, FloatingPointError: the block is not for the fast path.
        """
        frame = space.frame(self._template, n)
        for node, name in self._early_inputs:
            frame.values[node] = inputs[name]
        for step in self._first:
            step(frame)
        return [_column(frame.values[node], n) for node in self._filters]

    def run_forecasts(self, space: Space, inputs: Mapping[str, Floats], survivors: NDArray[np.intp]) -> list[Column]:
        """Evaluate what the forecasts need beyond that, on the survivors of the same block.

        Raises:
            Departure, FloatingPointError: the block is not for the fast path.
        """
        frame = space.survivors(survivors.size)
        for node, buffer in self._gathers:
            frame.values[node] = _gathered(frame, node, buffer, survivors)
        for node, name in self._late_inputs:
            frame.values[node] = inputs[name][survivors]
        for step in self._late:
            step(frame)
        return [_column(frame.values[node], survivors.size) for node in self._forecasts]


class Space:
    """The memory of one thread: buffers for blocks of up to `block` trials, and the frame of the block at hand.

    Attributes:
        underflow: to be told where NumPy raises that flag.
    """

    def __init__(self, plan: Plan, block: int) -> None:
        self._buffers = plan.buffers.allocate(block)
        self.underflow = Underflow()
        self._frame = Frame([], [], 0, self.underflow)

    def frame(self, template: list[Any], n: int) -> Frame:
        """A fresh frame for `n` trials."""
        self._frame = Frame(template.copy(), [buffer[:n] for buffer in self._buffers], n, self.underflow)
        return self._frame

    def survivors(self, m: int) -> Frame:
        """The same values, for `m` of the trials."""
        self._frame = Frame(self._frame.values, [buffer[:m] for buffer in self._buffers], m, self.underflow)
        return self._frame


def _gathered(frame: Frame, node: int, buffer: int | None, survivors: NDArray[np.intp]) -> Any:
    found = frame.values[node]
    if isinstance(found, Value):
        return found.take(survivors)
    if buffer is None:
        return found[survivors]
    return np.take(found, survivors, out=frame.buffers[buffer], mode="clip")


def _column(found: Any, n: int) -> Column:
    if isinstance(found, Value):
        return column_of(found, n)
    return Column(np.broadcast_to(found, (n,)))
