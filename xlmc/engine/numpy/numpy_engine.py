"""The fast path: plain float and bool arrays, one ufunc a node, results in buffers that later nodes use again.

A block runs with floating-point flags armed. Where one is raised, or a guard says that Excel differs from IEEE, or a
node's value turns out not to be a plain number, the block is evaluated again by `TrackingEvaluator`: errors cost
nothing where there are none. Nor do numbers too small for Excel: the step that raises their flag makes 0 of them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Column, Evaluator, Target, column_of
from xlmc.engine.graph.graph import Dag, constants
from xlmc.engine.graph.nodes import Input
from xlmc.engine.graph.readiness import most_waiting, order_by_need
from xlmc.engine.graph.trial_sets import ALL_TRIALS, TrialSet
from xlmc.engine.numpy.branches import SURVIVORS, Placement, branch_step
from xlmc.engine.numpy.looked_up import LookedUp, find_looked_up
from xlmc.engine.numpy.sequence import Buffers, Steps, find_indices
from xlmc.engine.numpy.steps import Frame, LeaveFastPath, Step, plain_constant, reads
from xlmc.engine.passes.bounds import NodeBounds
from xlmc.engine.tracking import TrackingEvaluator, array_bytes, fitting_block
from xlmc.errors import FormulaError
from xlmc.excel.functions import Kind
from xlmc.excel.functions.denormals import Underflow
from xlmc.excel.functions.values import Floats, Value

if TYPE_CHECKING:
    from xlmc.engine.graph.lowering import Lowering

__all__ = ["NumpyProgram"]


_LARGEST_BLOCK: Final = 1 << 15
_SMALLEST_BLOCK: Final = 1 << 8
_MOST_BYTES: Final = 1 << 25
"""The most bytes of all buffers: what the caches of today's processors hold."""

_MOST_WAITING: Final = _MOST_BYTES // (8 * _LARGEST_BLOCK)
_FEW_WAITING: Final = _MOST_WAITING - _MOST_WAITING // 4
"""Values that wait at a time in a largest block: as many as there is room for, and as many as there surely is room for,
whatever else needs a buffer meanwhile."""


class NumpyProgram:
    """The graph of nodes, ready to run on NumPy. It can be pickled, and so can its evaluators, without their memory.

    Args:
        filters, forecasts: nodes.
        may_err: the inputs whose draws may be errors (NaNs), which raise no flag.
        bounds: of the nodes, as far as they are known.
        array_bytes: what arrays and texts take in a trial.

    Attributes:
        may_err: of those inputs, the ones that it reads.
        largest_block: 32,768, or the largest power of two whose buffers take no more than 32 MB: they stay in caches.
            It is smaller where arrays or texts would take too much memory.
    """

    def __init__(
        self,
        dag: Dag,
        filters: Sequence[int],
        forecasts: Sequence[int],
        may_err: frozenset[str],
        bounds: NodeBounds,
        array_bytes: int,
    ) -> None:
        self._made_of = dag, filters, forecasts, may_err, bounds, array_bytes
        self._dag, self._filters, self._forecasts, self._bounds = dag, filters, forecasts, bounds
        # Where no filter can reject a trial, nothing needs to be picked from the survivors.
        self._placement = Placement(dag, filters, forecasts) if filters else Placement(dag, forecasts, ())
        self._looked_up: dict[int, LookedUp] = {}
        self._orders: dict[TrialSet, Sequence[int]] = {}
        self._look_up_functions()
        self._template: list[Any] = [None] * len(dag.nodes)
        for node, value in constants(dag):
            self._template[node] = plain_constant(value)
        self._carried = self._placement.externals(SURVIVORS, forecasts)
        self._early_inputs, self._late_inputs = self._inputs(ALL_TRIALS), self._inputs(SURVIVORS)
        inputs = frozenset(name for _, name in self._early_inputs + self._late_inputs)
        self._buffers = Buffers(dag)
        self._first = self._steps(ALL_TRIALS, {*filters, *self._carried}, free_at_end=filters)
        self._gathers = [(node, self._carry(node)) for node in self._carried]
        self._buffers.free(self._carried)
        self._late = self._steps(SURVIVORS, set(forecasts), free_at_end=())
        self.may_err = may_err & inputs
        self.largest_block = _LARGEST_BLOCK
        while self.largest_block > _SMALLEST_BLOCK and self.largest_block * self._buffers.trial_bytes > _MOST_BYTES:
            self.largest_block //= 2
        self.largest_block = fitting_block(self.largest_block, array_bytes, self._buffers.trial_bytes)

    @classmethod
    def of(
        cls,
        lowering: Lowering,
        filters: Sequence[Target],
        forecasts: Sequence[Target],
        may_err: frozenset[str],
        bounds: NodeBounds | None = None,
    ) -> NumpyProgram:
        """Make the program of targets."""
        first, late = ([lowering.target(target) for target in targets] for targets in (filters, forecasts))
        known = bounds or NodeBounds(lowering.dag, {})
        computed = lowering.dag.upstream([*first, *late], partial(reads, lowering.dag))
        return cls(lowering.dag, first, late, may_err, known, array_bytes(lowering, first, late, computed))

    def __reduce__(self) -> tuple[Any, ...]:
        return NumpyProgram, self._made_of

    def evaluator(self, block: int) -> Evaluator:
        """See `Program`."""
        dag, filters, forecasts, *_ = self._made_of
        return _NumpyEvaluator(self, block, TrackingEvaluator(dag, filters, forecasts))

    def allocate(self, block: int) -> list[NDArray[Any]]:
        """Make the arrays that the steps write to, for blocks of up to `block` trials."""
        return self._buffers.allocate(block)

    def run_filters(self, space: _Space, inputs: Mapping[str, Floats], n: int) -> list[Column]:
        """Evaluate what the filters need on all `n` trials.

        Raises:
            LeaveFastPath, FloatingPointError: the block is not for the fast path.
        """
        frame = space.frame(self._template, n)
        for node, name in self._early_inputs:
            frame.values[node] = inputs[name]
        for step in self._first:
            step(frame)
        return [_column(frame.values[node], n) for node in self._filters]

    def run_forecasts(self, space: _Space, inputs: Mapping[str, Floats], survivors: NDArray[np.intp]) -> list[Column]:
        """Evaluate what the forecasts need beyond that, on the survivors of the same block.

        Raises:
            LeaveFastPath, FloatingPointError: the block is not for the fast path.
        """
        all_survive = survivors.size == space.n
        frame = space.survivors(survivors.size)
        for node, buffer in () if all_survive and not self._late else self._gathers:
            frame.values[node] = _gather(frame, node, buffer, survivors)
        for node, name in self._late_inputs:
            frame.values[node] = inputs[name] if all_survive else inputs[name][survivors]
        for step in self._late:
            step(frame)
        return [_column(frame.values[node], survivors.size) for node in self._forecasts]

    def _inputs(self, trials: TrialSet) -> list[tuple[int, str]]:
        result = [(node, self._dag.nodes[node]) for node in self._placement.members(trials)]
        return [(node, input_.name) for node, input_ in result if isinstance(input_, Input)]

    def _steps(self, trials: TrialSet, keep: set[int], free_at_end: Sequence[int]) -> list[Step]:
        """Make the steps of one set of trials; the values of `keep` are read after them."""
        branched = self._placement.branched
        computed, read = self._in_order(trials, keep)
        last = {needed: node for node in computed for needed in read[node]} | dict.fromkeys(keep, -1)
        indices = find_indices(self._dag, computed, read, keep, self._looked_up)
        steps = Steps(self._dag, self._buffers, computed, self._bounds, self._looked_up, indices)
        for node in computed:
            done = [needed for needed in read[node] if last[needed] == node]
            if node in branched:
                steps.add_free(branch_step(self._dag, self._placement, node), done)
            else:
                steps.add(node, read[node], done)
        self._buffers.free(node for node in free_at_end if node not in self._carried)
        return steps.finish()

    def _in_order(self, trials: TrialSet, keep: set[int]) -> tuple[Sequence[int], dict[int, tuple[int, ...]]]:
        """List the nodes of a set that are computed, in order, and what each node reads."""
        nodes, branched = self._dag.nodes, self._placement.branched
        members = [node for node in self._placement.members(trials) if type(nodes[node]) is not Input]
        read = self._placement.reads | {node: self._reads(node) for node in members if node in branched}
        if trials not in self._orders:
            self._orders[trials] = order_by_need(members, read, keep, _MOST_WAITING)
        left = set(members)
        return [node for node in self._orders[trials] if node in left], read

    def _look_up_functions(self) -> None:
        """Look up what are functions of a number of a table, where blocks are of the largest size either way."""
        sets = [self._placement.members(trials) for trials in (ALL_TRIALS, SURVIVORS)]
        result = find_looked_up(self._dag, sets)
        if not result:
            return
        before, results = self._placement, [*self._filters, *self._forecasts]
        if self._waiting() <= _FEW_WAITING:
            self._placement = before.reading_less({node: (each.position,) for node, each in result.items()}, results)
            if self._waiting() <= _FEW_WAITING:
                self._looked_up = result
            else:
                self._placement = before

    def _waiting(self) -> int:
        """How many values wait at a time, at most."""
        carried = self._placement.externals(SURVIVORS, self._forecasts)
        waiting = len(carried)
        for trials, keep in ((ALL_TRIALS, {*self._filters, *carried}), (SURVIVORS, set(self._forecasts))):
            waiting += most_waiting(*self._in_order(trials, keep), keep)
        return waiting

    def _reads(self, node: int) -> tuple[int, ...]:
        """Return the nodes that an `IF` needs, its branches included."""
        branches = self._placement.branches(node)
        inner = (read for branch in branches for read in self._placement.externals(branch, ()))
        return (*self._placement.reads[node], *inner)

    def _carry(self, node: int) -> int | None:
        """Return a buffer for the survivors' values of a node that the first steps computed."""
        kind = self._dag.types[node]
        return self._buffers.take_for(kind) if kind in (Kind.NUMBER, Kind.LOGICAL) else None


class _NumpyEvaluator:
    def __init__(self, program: NumpyProgram, block: int, tracking: TrackingEvaluator) -> None:
        self._made_of = program, block
        self._program, self._space, self._tracking = program, _Space(program, block), tracking
        self._inputs: Mapping[str, Floats] = {}
        self._n = 0
        self._left_fast_path = False

    def _armed(self) -> np.errstate:
        """Raise an error where a number is lost; report one that is too small for Excel."""
        return np.errstate(divide="raise", over="raise", invalid="raise", under="call", call=self._space.underflow)

    def __reduce__(self) -> tuple[Any, ...]:
        return NumpyProgram.evaluator, self._made_of

    def filters(self, inputs: Mapping[str, Floats], n: int) -> list[Column]:
        self._inputs, self._n = inputs, n
        self._left_fast_path = not all(np.isfinite(inputs[name]).all() for name in self._program.may_err)
        if not self._left_fast_path:
            try:
                with self._armed():
                    return self._program.run_filters(self._space, inputs, n)
            except (FloatingPointError, LeaveFastPath, FormulaError):
                self._left_fast_path = True
        return self._tracking.filters(inputs, n)

    def forecasts(self, survivors: NDArray[np.intp]) -> list[Column]:
        if not self._left_fast_path:
            try:
                with self._armed():
                    return self._program.run_forecasts(self._space, self._inputs, survivors)
            except (FloatingPointError, LeaveFastPath, FormulaError):
                self._tracking.filters(self._inputs, self._n)
        return self._tracking.forecasts(survivors)


class _Space:
    """The memory of one thread: buffers for blocks of up to `block` trials, and the frame of the current block.

    Attributes:
        underflow: is called where NumPy raises that flag.
    """

    def __init__(self, program: NumpyProgram, block: int) -> None:
        self._buffers = program.allocate(block)
        self.underflow = Underflow()
        self._frame = Frame([], [], 0, self.underflow)

    def frame(self, template: list[Any], n: int) -> Frame:
        """Make a fresh frame for `n` trials."""
        self._frame = Frame(template.copy(), [buffer[:n] for buffer in self._buffers], n, self.underflow)
        return self._frame

    @property
    def n(self) -> int:
        """The trials of the current frame."""
        return self._frame.n

    def survivors(self, m: int) -> Frame:
        """Return a frame with the same values, for `m` of the trials."""
        self._frame = Frame(self._frame.values, [buffer[:m] for buffer in self._buffers], m, self.underflow)
        return self._frame


def _gather(frame: Frame, node: int, buffer: int | None, survivors: NDArray[np.intp]) -> Any:
    value = frame.values[node]
    if isinstance(value, Value):
        return value.take(survivors)
    if buffer is None:
        return value[survivors]
    if survivors.size == value.size:
        out = frame.buffers[buffer]
        np.copyto(out, value)
        return out
    return np.take(value, survivors, out=frame.buffers[buffer], mode="clip")


def _column(value: Any, n: int) -> Column:
    if isinstance(value, Value):
        return column_of(value, n)
    known = isinstance(value, np.ndarray) and value.shape == (n,)
    return Column(value if known else np.broadcast_to(value, (n,)))
