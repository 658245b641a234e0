"""The nodes that are computed on one set of trials: on all of them, or on the survivors of the filters.

They are divided into stages: loops, and between them what the loops cannot compute.
"""

from __future__ import annotations

import ctypes
from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.evaluation.engine import Column, column_of
from xlmc.evaluation.graph.dag import Dag
from xlmc.evaluation.graph.nodes import Apply, Constant, IfErrorNode, Input, Range, Select, evaluate_node, in_own_memory
from xlmc.evaluation.graph.readiness import order_by_need
from xlmc.evaluation.llvm.loop import SIDE_BY_SIDE, Load, compile_loop
from xlmc.evaluation.llvm.loop_rules import LoopRule, Operand
from xlmc.evaluation.llvm.machine import Machine, NativeLoop
from xlmc.evaluation.llvm.memory import Memory, assign_slots
from xlmc.evaluation.llvm.shapes import Shape, cut, shape_of
from xlmc.functions import Kind
from xlmc.functions.denormals import tiny_to_zero
from xlmc.functions.operators import ALL_BITS
from xlmc.functions.values import Floats, Value

__all__ = ["Loop", "Phase", "Trials"]

_LONGEST: Final = 250
"""The most nodes of one loop; the time to compile grows faster than the loop."""

_FEWEST: Final = 4
"""Stages of which some may be of one shape; the constants of fewer are part of the code, but for limits of filters."""

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
        """What a loop reads of these trials: contiguous, `(n,)`; a `Value` as doubles, with NaN for errors."""
        if operand.node in self.arrays:
            return self.arrays[operand.node]
        if operand not in self._converted:
            self._converted[operand] = self._as_doubles(operand)
        return self._converted[operand]

    def _as_doubles(self, operand: Operand) -> Floats:
        value = self.values[operand.node]
        numbers, errors = value.to_numbers() if operand.kind is Kind.NUMBER else value.to_logicals()
        doubles = np.where(errors > 0, np.nan, numbers)
        return np.ascontiguousarray(np.broadcast_to(doubles, (self.n,)), np.float64)

    def value(self, node_id: int) -> Value:
        """A node's value, whatever it is. In a trial that must be computed again it may be another error."""
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

    def numbers(self, node_id: int) -> Floats | float | None:
        """A node's plain numbers, `(n,)`, or the number that it always is; None where a `Value` must be asked."""
        node = self._dag.nodes[node_id]
        if self._dag.types[node_id] is not Kind.NUMBER or self._dag.sizes[node_id] is not None:
            return None
        if isinstance(node, Constant):
            return float(node.value.numbers[0])
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
        """A node as a result: numbers alone for draws without errors, or from a loop, whose errors `wrong` marks."""
        if not fallible and node in self.arrays:
            return Column(self.arrays[node])
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


@dataclass(frozen=True, slots=True, eq=False)
class _Plan:
    """A loop to be compiled: the rules of its nodes in order, the arrays it reads, and the nodes it writes."""

    rules: Mapping[int, LoopRule]
    loads: tuple[Load, ...]
    stores: tuple[int, ...]

    def shape(self, dag: Dag) -> Shape:
        loads = [(load.operand, (load.operand.kind, load.stored, load.picked, load.fallible)) for load in self.loads]
        return shape_of(dag, self.rules, loads, self.stores)


class Phase:
    """Computes the nodes of `nodes`.

    Args:
        needed: the nodes that one's computation needs.
        keep: the nodes whose values are wanted afterwards.
        early: the nodes that were computed before, on a wider set of trials; None where this is the first phase.
        may_err: the inputs whose draws may be errors.

    Attributes:
        slots: the memory of each node that a loop leaves behind.
        outside: how many values that are computed outside of loops wait at a time.
    """

    def __init__(
        self,
        dag: Dag,
        machine: Machine,
        rules: Mapping[int, LoopRule],
        needed: Callable[[int], Sequence[int]],
        nodes: Sequence[int],
        keep: Iterable[int],
        early: frozenset[int] | None,
        may_err: frozenset[str],
    ) -> None:
        self._dag, self._machine, self._rules, self._needed, self._may_err = dag, machine, rules, needed, may_err
        self._early = early
        computed = [node for node in nodes if not isinstance(dag.nodes[node], Input)]
        parts = _in_order(_stages(dag, computed, rules, needed), self._read_from_outside)
        read = [self._read_from_outside(stage) for stage in parts]
        wanted = set(keep).union(*read)
        plans = [
            self._plan(stage, found, wanted) if stage.loop else None for stage, found in zip(parts, read, strict=True)
        ]
        made = self._make_loops([plan for plan in plans if plan is not None])
        self._steps: list[Loop | tuple[int, ...]] = [
            stage.nodes if plan is None else next(made) for stage, plan in zip(parts, plans, strict=True)
        ]
        kept, late = frozenset(keep), early is not None
        written = [step.stores if isinstance(step, Loop) else () for step in self._steps]
        self.slots = assign_slots(dag, list(zip(read, written, strict=True)), kept, late=late)
        self._last_read = _last_reads(parts, read, kept)
        outside = [() if isinstance(step, Loop) else step for step in self._steps]
        self.outside = len(set(assign_slots(dag, list(zip(read, outside, strict=True)), kept, late=late).values()))

    def _read_from_outside(self, stage: _LoopStage) -> set[int]:
        return set(chain.from_iterable(map(self._needed, stage.nodes))).difference(stage.nodes)

    def _plan(self, stage: _LoopStage, read: set[int], wanted: set[int]) -> _Plan:
        rules = {node: self._rules[node] for node in stage.nodes}
        loads: dict[Operand, Load] = {}
        for rule in rules.values():
            for part in (*rule.operands, *rule.beside):
                if isinstance(part, Operand) and part.node in read:
                    load = self._load(part)
                    if load is not None:
                        loads[load.operand] = load
        return _Plan(rules, tuple(loads.values()), tuple(node for node in stage.nodes if node in wanted))

    def _make_loops(self, plans: Sequence[_Plan]) -> Iterator[Loop]:
        if len(plans) < _FEWEST:
            for plan in plans:
                shape = plan.shape(self._dag)
                limits = [slot for slot in shape.slots if self._is_limit(slot[0])]
                numbers = np.array([shape.numbers[shape.slots[slot]] for slot in limits])
                places = {slot: at for at, slot in enumerate(limits)}
                yield Loop(self._compile(plan, places), plan.loads, plan.stores, numbers)
            return
        shapes = [plan.shape(self._dag) for plan in plans]
        uses = Counter(shape.key for shape in shapes)
        repeats = max(uses.values()) >= _FEWEST
        compiled: dict[tuple[object, ...], NativeLoop] = {}
        for plan, shape in zip(plans, shapes, strict=True):
            if shape.key not in compiled:
                compiled[shape.key] = self._compile(plan, shape.slots, once=repeats and uses[shape.key] == 1)
            yield Loop(compiled[shape.key], plan.loads, plan.stores, np.array(shape.numbers))

    def _is_limit(self, node_id: int) -> bool:
        """Whether a node compares with a limit of a filter: one that is moved must not make other code."""
        node = self._dag.nodes[node_id]
        return isinstance(node, Apply) and node.function in _LIMITS

    def _compile(self, plan: _Plan, numbers: Mapping[tuple[int, int], int], once: bool = False) -> NativeLoop:
        """The code of a loop; the code of one that runs once beside many alike is soon made, and a little slower."""
        side_by_side = 1 if once else SIDE_BY_SIDE
        return compile_loop(self._dag, self._machine, plan.rules, plan.loads, plan.stores, numbers, side_by_side)

    def _load(self, part: Operand) -> Load | None:
        """How a node from outside is read; None for a constant."""
        node = self._dag.nodes[part.node]
        if isinstance(node, Constant):
            return None
        is_input = isinstance(node, Input)
        picked = self._early is not None and (is_input or part.node in self._early)
        if isinstance(node, Input):
            return Load(Operand(part.node, Kind.NUMBER), Kind.NUMBER, picked, node.name in self._may_err)
        if part.node in self._rules:
            own = self._dag.types[part.node]
            return Load(Operand(part.node, own), own, picked, False)  # it was checked when it was written
        return Load(part, Kind.NUMBER, picked, True)

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
                self._run_outside(step, trials)
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

    def _run_outside(self, nodes: Sequence[int], trials: Trials) -> None:
        for node_id in nodes:
            node = self._dag.nodes[node_id]
            assert isinstance(node, Apply | Select | IfErrorNode | Range)
            with np.errstate(all="ignore"):
                numbers = _apply_ufunc(node, trials) if isinstance(node, Apply) else None
                if numbers is not None:
                    trials.arrays[node_id] = numbers
                    continue
                known = {used: trials.value(used) for used in self._needed(node_id)}
                trials.values[node_id] = in_own_memory(evaluate_node(node, known), known.values())


def _apply_ufunc(node: Apply, trials: Trials) -> Floats | None:
    """What the ufunc of a function of numbers gives, `(n,)`.

    None of a function that has none, where an argument is no plain number, where the guard does not hold, and where a
    result is an error.
    """
    function = node.function
    if not function.on_numbers or function.returns is not Kind.NUMBER or function.ufunc is None:
        return None
    given = [trials.numbers(argument) for argument in node.arguments]
    arguments = [each for each in given if each is not None]
    if len(arguments) < len(given) or len(arguments) != function.ufunc.nin:
        return None
    if function.guard is not None and not function.guard(*arguments):
        return None
    found: Floats = function.ufunc(*arguments)
    return tiny_to_zero(found) if np.isfinite(found).all() else None


@dataclass(frozen=True, slots=True)
class _LoopStage:
    """Nodes that are computed together, in order; `loop` says how."""

    nodes: tuple[int, ...]
    loop: bool


def _stages(
    dag: Dag, nodes: Sequence[int], rules: Mapping[int, LoopRule], needed: Callable[[int], Sequence[int]]
) -> list[_LoopStage]:
    """The nodes of `nodes`, in order, as stages in order; those without a rule stand outside of loops."""
    levels: dict[int, int] = {}
    for node in nodes:
        in_loop = node in rules
        levels[node] = 0 if in_loop else 1  # loops stand on even levels
        for used in needed(node):
            if used in levels:
                after = levels[used] + ((used in rules) != in_loop)
                levels[node] = max(levels[node], after)
    grouped: defaultdict[int, list[int]] = defaultdict(list)
    for node in nodes:
        grouped[levels[node]].append(node)
    stages = []
    for level in sorted(grouped):
        loop = level % 2 == 0
        parts = cut(dag, grouped[level], rules, _LONGEST) if loop else [[node] for node in grouped[level]]
        stages += [_LoopStage(tuple(part), loop) for part in parts]
    return stages


def _last_reads(
    stages: Sequence[_LoopStage], read: Sequence[Iterable[int]], keep: Collection[int]
) -> dict[int, list[int]]:
    """The stage after which nothing reads them -> nodes that are computed outside of loops."""
    outside = {node for stage in stages if not stage.loop for node in stage.nodes} - set(keep)
    last = {node: at for at, nodes in enumerate(read) for node in outside.intersection(nodes)}
    found: dict[int, list[int]] = {}
    for node, at in last.items():
        found.setdefault(at, []).append(node)
    return found


def _in_order(stages: Sequence[_LoopStage], read: Callable[[_LoopStage], Iterable[int]]) -> list[_LoopStage]:
    """The stages so that few wait at a time to be read; one may need as many others as it has nodes."""
    made = {node: at for at, stage in enumerate(stages) for node in stage.nodes}
    needs = {at: sorted({made[node] for node in read(stage) if node in made}) for at, stage in enumerate(stages)}
    return [stages[at] for at in order_by_need(range(len(stages)), needs, (), _FEWEST, few=2 * _LONGEST)]
