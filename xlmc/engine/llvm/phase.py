"""The nodes that are computed on one set of trials: on all of them, or on the survivors of the filters.

They are computed stage by stage: by loops, and between them what the loops cannot compute.
"""

from __future__ import annotations

import ctypes
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Column, Compilable, column_of
from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.node_values import evaluate_node, in_own_memory
from xlmc.engine.graph.nodes import Apply, Constant, IfErrorNode, Input, Node, Range, Select
from xlmc.engine.llvm.loop import SIDE_BY_SIDE, Load, compile_loop
from xlmc.engine.llvm.loop_rules import PLAIN, Operand
from xlmc.engine.llvm.machine import Machine, NativeLoop
from xlmc.engine.llvm.memory import Memory
from xlmc.engine.llvm.stages import LoopPlan, Stages
from xlmc.engine.numpy.steps import Frame, LeaveFastPath, make_step, plain_constant
from xlmc.excel.functions import Kind
from xlmc.excel.functions.denormals import Underflow
from xlmc.excel.functions.operators import ALL_BITS
from xlmc.excel.functions.values import Floats, Value

__all__ = ["Loop", "Phase", "Trials"]

_MOST_FAILURES: Final = 8
"""Blocks in which a node outside of loops could not be computed with plain numbers; then that is not tried any more."""

_FEWEST: Final = 4
"""Stages of which some may be of one shape; the constants of fewer are part of the code, but for limits of filters."""

_RARE: Final = 128
"""One trial after another takes a loop up to eight times as long: of so many nodes, one may be computed so."""

_MORE_SIDE_BY_SIDE: Final = 4
"""Vectors of trials at once where there are registers for them: 5 to 20 % faster, and half as long again to compile."""

_SHORT: Final = 192
"""The most nodes of a loop that gains by it: longer ones, and those that pick trials, do not (measured on examples and
templates)."""

_LIMITS: Final = tuple(ALL_BITS[relation] for relation in (">=", "<=", ">", "<"))


class Trials:
    """The values of nodes in a set of trials.

    Args:
        wider: the set that these trials were chosen from, by `survivors`; what was computed there is taken from there.

    Attributes:
        n: how many trials.
        arrays: what loops read and write: doubles, and truth values for LOGICAL nodes, `(n,)`.
        values: what was computed outside of loops.
        wrong: `(n,)` 1 where the trial must be computed again.
    """

    def __init__(
        self, dag: Dag, n: int, wrong: NDArray[np.uint8], wider: Trials | None, survivors: NDArray[np.intp]
    ) -> None:
        self.n, self.wrong, self.wider, self.survivors = n, wrong, wider, survivors
        self.arrays: dict[int, NDArray[Any]] = {}
        self.values: dict[int, Value] = {}
        self._dag = dag
        self._converted: dict[Operand, Floats] = {}

    def array(self, operand: Operand) -> NDArray[Any]:
        """Return what a loop reads of these trials: contiguous, `(n,)`; a `Value` as doubles, with NaN for errors."""
        if operand.node in self.arrays:
            return self.arrays[operand.node]
        if operand not in self._converted:
            self._converted[operand] = self._as_doubles(operand)
        return self._converted[operand]

    def _as_doubles(self, operand: Operand) -> Floats:
        value = self.values[operand.node]
        numbers, errors = self._dag.to_numbers(value) if operand.kind is Kind.NUMBER else value.to_logicals()
        doubles = np.where(errors > 0, np.nan, numbers)
        return np.ascontiguousarray(np.broadcast_to(doubles, (self.n,)), np.float64)

    def value(self, node_id: int) -> Value:
        """Return a node's value, whatever it is. In a trial that must be computed again it may be another error."""
        node = self._dag.nodes[node_id]
        if isinstance(node, Constant):
            return node.value
        if node_id not in self.values:
            self.values[node_id] = self._as_value(node_id)
        return self.values[node_id]

    def _as_value(self, node: int) -> Value:
        if node in self.arrays:
            array = self.arrays[node]
            return Value.of_logicals(array) if array.dtype == np.bool_ else Value.of_numbers(array)
        assert self.wider is not None
        return self.wider.value(node).take(self.survivors)

    def plain(self, node_id: int) -> NDArray[Any] | float | bool | None:
        """Return a node's numbers or truth values, `(n,)`, or the one that it always is; None if only a
        `Value` tells.
        """
        node = self._dag.nodes[node_id]
        if isinstance(node, Constant):
            known = plain_constant(node.value)
            return known if isinstance(known, float | bool) else None
        if node_id not in self.arrays and self.wider is not None and node_id in self.wider.arrays:
            self.arrays[node_id] = self.wider.arrays[node_id][self.survivors]
        return self.arrays.get(node_id)

    def forget(self, nodes: Iterable[int]) -> None:
        """Give back the memory of values that nothing reads any more."""
        for node in nodes:
            self.arrays.pop(node, None)
            self.values.pop(node, None)
            for kind in (Kind.NUMBER, Kind.LOGICAL):
                self._converted.pop(Operand(node, kind), None)

    def column(self, node: int, fallible: bool) -> Column:
        """Return a node as a result: numbers alone for draws without errors, or from a loop, whose errors `wrong`
        marks.
        """
        if not fallible and node in self.arrays:
            return Column(self.arrays[node])
        known = self._dag.nodes[node]
        if isinstance(known, Constant) and self._dag.types[node] in PLAIN and self._dag.sizes[node] is None:
            return Column(np.broadcast_to(known.value.numbers, (self.n,)))
        if not fallible and self.wider is not None and node in self.wider.arrays:
            return Column(self.wider.arrays[node][self.survivors])
        return column_of(self.value(node), self.n)


@dataclass(frozen=True, slots=True, eq=False)
class Loop:
    """A stage as native code, with the arrays it reads, the nodes it writes, and constants that are no part of it."""

    call: NativeLoop
    loads: tuple[Load, ...]
    stores: tuple[int, ...]
    numbers: Floats


class Phase:
    """Computes the nodes of stages.

    Args:
        stages: the nodes.
        machine: compiles the loops.

    Attributes:
        slots: the memory of each node that a loop leaves behind.
    """

    def __init__(self, stages: Stages, machine: Machine) -> None:
        self._stages, self._dag, self._machine, self._may_err = stages, stages.dag, machine, stages.may_err
        made = self._make_loops([*stages.loop_plans()])
        self._steps: list[Loop | tuple[int, ...]] = [
            stage.nodes if stage.stores is None else next(made) for stage in stages.in_order
        ]
        self._last_read = stages.last_reads()
        outside = [() if isinstance(step, Loop) else step for step in self._steps]
        result = {node: _compiled(self._dag.nodes[node]) for nodes in outside for node in nodes}
        self._native = {node: each for node, each in result.items() if each is not None}
        plain = [node for node in result if node not in self._native and self._is_plain(node)]
        self._plain = {node: make_step(self._dag, node, 0) for node in plain}
        self.slots = stages.slots(
            [
                step.stores if isinstance(step, Loop) else tuple(node for node in step if node in self._plain)
                for step in self._steps
            ]
        )

    def _is_plain(self, node_id: int) -> bool:
        """Whether a node outside of loops is a number made of numbers and truth values, but of no fallible draw."""
        dag, node = self._dag, self._dag.nodes[node_id]
        if not isinstance(node, Apply) or dag.types[node_id] is not Kind.NUMBER or dag.sizes[node_id] is not None:
            return False
        given = [dag.nodes[argument] for argument in node.arguments]
        fallible = any(isinstance(each, Input) and each.name in self._may_err for each in given)
        return not fallible and all(dag.types[a] in PLAIN and dag.sizes[a] is None for a in node.arguments)

    def _make_loops(self, plans: Sequence[LoopPlan]) -> Iterator[Loop]:
        if len(plans) < _FEWEST:
            for plan in plans:
                limits = {slot: at for slot, at in plan.slots.items() if self._is_limit(slot[0])}
                positions = {slot: at for at, slot in enumerate(limits)}
                code = self._compile(plan, positions, self._side_by_side(plan))
                yield Loop(code, plan.loads, plan.stores, plan.numbers[[*limits.values()]])
            return
        known: dict[tuple[object, ...], int] = {}
        shapes = [known.setdefault(plan.shape, len(known)) for plan in plans]
        uses = Counter(shapes)
        alone = _side_by_side_alone([(len(plan.rules), uses[shape]) for plan, shape in zip(plans, shapes, strict=True)])
        compiled: dict[int, NativeLoop] = {}
        for plan, shape in zip(plans, shapes, strict=True):
            if shape not in compiled:
                compiled[shape] = self._compile(plan, plan.slots, alone if uses[shape] == 1 else SIDE_BY_SIDE)
            yield Loop(compiled[shape], plan.loads, plan.stores, plan.numbers)

    def _is_limit(self, node_id: int) -> bool:
        """Whether a node compares with a limit of a filter: one that is moved must not make other code."""
        node = self._dag.nodes[node_id]
        return isinstance(node, Apply) and node.function in _LIMITS

    def _side_by_side(self, plan: LoopPlan) -> int:
        """How many vectors of trials a loop computes at once if all constants are part of its code."""
        gains = len(plan.rules) <= _SHORT and not any(load.picked for load in plan.loads)
        return _MORE_SIDE_BY_SIDE if gains and self._machine.many_wide_registers else SIDE_BY_SIDE

    def _compile(
        self, plan: LoopPlan, numbers: Mapping[tuple[int, int], int], side_by_side: int = SIDE_BY_SIDE
    ) -> NativeLoop:
        """Write the code of a loop."""
        return compile_loop(self._dag, self._machine, plan.rules, plan.loads, plan.stores, numbers, side_by_side)

    @property
    def loops(self) -> tuple[Loop, ...] | None:
        """The stages, where all are loops."""
        loops = tuple(step for step in self._steps if isinstance(step, Loop))
        return loops if len(loops) == len(self._steps) else None

    def run(self, trials: Trials, memory: Memory) -> bool:
        """Compute all nodes; whether any trial must be computed again."""
        wrong = 0
        for at, step in enumerate(self._steps):
            if isinstance(step, Loop):
                wrong += self._run_loop(step, trials, memory)
            else:
                self._run_outside(step, trials, memory)
            trials.forget(self._last_read.get(at, ()))
        return wrong > 0

    def _run_loop(self, step: Loop, trials: Trials, memory: Memory) -> int:
        address, nodes = memory.addresses.of, []
        for load in step.loads:
            source = trials.wider if load.picked else trials
            assert source is not None
            nodes.append(address(load.operand.node, source.array(load.operand)))
        written = [memory.of(node, trials.n) for node in step.stores]
        nodes += [address(node, array) for node, array in zip(step.stores, written, strict=True)]
        nodes += [address("survivors", trials.survivors), address("wrong", trials.wrong), address(step, step.numbers)]
        wrong = step.call((ctypes.c_void_p * len(nodes))(*nodes), trials.n)
        trials.arrays.update(zip(step.stores, written, strict=True))
        return wrong

    def _run_outside(self, nodes: Sequence[int], trials: Trials, memory: Memory) -> None:
        for node_id in nodes:
            if node_id in self._plain and self._run_plain(node_id, trials, memory):
                continue
            node = self._native.get(node_id, self._dag.nodes[node_id])
            assert isinstance(node, Apply | Select | IfErrorNode | Range)
            with np.errstate(all="ignore"):
                known = {used: trials.value(used) for used in self._stages.reads[node_id]}
                trials.values[node_id] = in_own_memory(evaluate_node(node, known), known.values())

    def _run_plain(self, node_id: int, trials: Trials, memory: Memory) -> bool:
        """Compute a node as the engine `numpy` does; whether that could be done, and none of its numbers is an error.

        Where it often cannot, it is not tried any more: that costs time, and changes no number.
        """
        if memory.failures[node_id] > _MOST_FAILURES:
            return False
        known: dict[int, Any] = {}
        for used in self._stages.reads[node_id]:
            mask = trials.plain(used)
            if mask is None:
                return False
            known[used] = mask
        underflow = Underflow()
        frame = Frame(known, [memory.of(node_id, trials.n)], trials.n, underflow)
        try:
            with np.errstate(divide="raise", over="raise", invalid="raise", under="call", call=underflow):
                self._plain[node_id](frame)
        except (FloatingPointError, LeaveFastPath):
            memory.failures[node_id] += 1
            return False
        # Loops read doubles there, one a trial.
        trials.arrays[node_id] = np.ascontiguousarray(np.broadcast_to(known[node_id], (trials.n,)), np.float64)
        return True


def _compiled(node: Node) -> Node | None:
    """Return a node with the native code of its function's body; None if it has none."""
    if not isinstance(node, Apply) or not isinstance(node.function.body, Compilable):
        return None
    body = node.function.body.compiled()
    return None if body is None else Apply(replace(node.function, body=body), node.arguments)


def _side_by_side_alone(loops: Sequence[tuple[int, int]]) -> int:
    """How many vectors of trials a loop computes at once if its code serves no other.

    Beside many alike such code should be made soon rather than run fast, above all where little of the time goes there.

    Args:
        loops: the nodes of each, and how many loops have its code.
    """
    if max(uses for _, uses in loops) < _FEWEST:
        return SIDE_BY_SIDE
    alone = sum(nodes for nodes, uses in loops if uses == 1)
    return 0 if _RARE * alone <= sum(nodes for nodes, _ in loops) else 1
