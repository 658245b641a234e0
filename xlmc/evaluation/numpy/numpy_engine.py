"""The fast path: plain float and bool arrays, one ufunc a node, results in buffers that are used again.

A block runs with floating-point flags armed. Where one is raised, or a guard says that Excel and IEEE part, or a
node's value turns out not to be a plain number, the block is evaluated again by `TrackingEvaluator`: errors cost
nothing where there are none. Nor do numbers too small for Excel: the step that raises their flag makes 0 of them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import FormulaError
from xlmc.evaluation.block_size import array_bytes, fitting_block
from xlmc.evaluation.engine import Column, Evaluator, Target
from xlmc.evaluation.graph.dag import Dag
from xlmc.evaluation.numpy.plan import Plan, Space
from xlmc.evaluation.numpy.steps import Departure
from xlmc.evaluation.passes.bounds import Bounds
from xlmc.evaluation.reference.tracking import TrackingEvaluator
from xlmc.functions.values import Floats

if TYPE_CHECKING:
    from xlmc.evaluation.graph.lower import Lowering

__all__ = ["NumpyProgram"]


_LARGEST_BLOCK: Final = 1 << 15
_SMALLEST_BLOCK: Final = 1 << 8
_MOST_BYTES: Final = 1 << 25
"""Of all buffers: what the caches of today's processors hold."""


class NumpyProgram:
    """The graph of nodes, ready to run on NumPy. It can be pickled, and so can its evaluators, without their memory.

    Args:
        filters, forecasts: the places of nodes.
        may_err: the inputs whose draws may be errors (NaNs), which raise no flag.
        between: name of an input -> the bounds that it will be given within; none are known of the others.
        array_bytes: what arrays and texts take in a trial.

    Attributes:
        largest_block: 32,768, or the largest power of two whose buffers take no more than 32 MB: they stay in caches.
            It is smaller where arrays or texts would take too much memory.
    """

    def __init__(
        self,
        dag: Dag,
        filters: Sequence[int],
        forecasts: Sequence[int],
        may_err: frozenset[str],
        between: Mapping[str, Bounds] | None = None,
        array_bytes: int = 0,
    ) -> None:
        self._made_of = dag, filters, forecasts, may_err, between, array_bytes
        self._plan = Plan(dag, filters, forecasts, between)
        self._may_err = may_err & self._plan.inputs
        self.largest_block = _LARGEST_BLOCK
        while (
            self.largest_block > _SMALLEST_BLOCK and self.largest_block * self._plan.buffers.trial_bytes > _MOST_BYTES
        ):
            self.largest_block //= 2
        self.largest_block = fitting_block(self.largest_block, array_bytes, self._plan.buffers.trial_bytes)

    @classmethod
    def of(
        cls,
        lowering: Lowering,
        filters: Sequence[Target],
        forecasts: Sequence[Target],
        may_err: frozenset[str],
        between: Mapping[str, Bounds] | None = None,
    ) -> NumpyProgram:
        """The program of targets."""
        first, late = ([lowering.target(target) for target in targets] for targets in (filters, forecasts))
        return cls(lowering.dag, first, late, may_err, between, array_bytes(lowering, first, late))

    def __reduce__(self) -> tuple[Any, ...]:
        return NumpyProgram, self._made_of

    def evaluator(self, block: int) -> Evaluator:
        """See `Program`."""
        dag, filters, forecasts, *_ = self._made_of
        tracking = TrackingEvaluator(dag, filters, forecasts)
        return _NumpyEvaluator(self, block, self._plan, tracking, self._may_err)


class _NumpyEvaluator:
    def __init__(
        self, program: NumpyProgram, block: int, plan: Plan, tracking: TrackingEvaluator, may_err: frozenset[str]
    ) -> None:
        self._made_of = program, block
        self._plan, self._space, self._tracking, self._may_err = plan, Space(plan, block), tracking, may_err
        self._inputs: Mapping[str, Floats] = {}
        self._n = 0
        self._departed = False

    def _armed(self) -> np.errstate:
        """The state in which a block departs where a number is lost, and one too small for Excel is told of."""
        return np.errstate(divide="raise", over="raise", invalid="raise", under="call", call=self._space.underflow)

    def __reduce__(self) -> tuple[Any, ...]:
        return NumpyProgram.evaluator, self._made_of

    def filters(self, inputs: Mapping[str, Floats], n: int) -> list[Column]:
        self._inputs, self._n = inputs, n
        self._departed = not all(np.isfinite(inputs[name]).all() for name in self._may_err)
        if not self._departed:
            try:
                with self._armed():
                    return self._plan.run_filters(self._space, inputs, n)
            except (FloatingPointError, Departure, FormulaError):
                self._departed = True
        return self._tracking.filters(inputs, n)

    def forecasts(self, survivors: NDArray[np.intp]) -> list[Column]:
        if not self._departed:
            try:
                with self._armed():
                    return self._plan.run_forecasts(self._space, self._inputs, survivors)
            except (FloatingPointError, Departure, FormulaError):
                self._tracking.filters(self._inputs, self._n)
        return self._tracking.forecasts(survivors)
