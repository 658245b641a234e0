"""The graph of nodes as compiled loops, and the evaluator that runs them block by block."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import BlockRunner, Column, Evaluator, Linear, Target
from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.lowering import Lowering
from xlmc.engine.graph.nodes import Input, Select
from xlmc.engine.graph.readiness import order_by_need
from xlmc.engine.llvm.block_runner import NativeBlockRunner, block_parts
from xlmc.engine.llvm.costs import loops_pay
from xlmc.engine.llvm.loop_rules import LoopRule, reads
from xlmc.engine.llvm.machine import machine
from xlmc.engine.llvm.memory import Memory
from xlmc.engine.llvm.native_tables import rules_of_looked_up
from xlmc.engine.llvm.operations import loop_rule_of
from xlmc.engine.llvm.phase import Phase, Trials
from xlmc.engine.llvm.stages import Stages
from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.engine.tracking import TrackingEvaluator, array_bytes, fitting_block
from xlmc.errors import FormulaError
from xlmc.excel.functions import Kind
from xlmc.excel.functions.values import Floats, constant

if TYPE_CHECKING:
    from xlmc.engine.engine import Program

__all__ = ["JitProgram", "fastest_program"]

_MOST_MEMORY: Final = 2**28
_MOST_IN_CACHES: Final = 2**25
"""The most bytes of all arrays: of a model that consists of loops alone, which take a few trials at a time, and of one
whose stages each pass over the whole block."""
_FEW_BETWEEN_LOOPS: Final = 64
_LARGEST_BLOCK: Final = 1 << 20
_SMALLEST_BLOCK: Final = 1 << 10

_MOST_IN_COLUMNS: Final = 1 << 26
"""The most bytes of a block's draws and forecasts."""


def fastest_program(
    lowering: Lowering, filters: Sequence[Target], forecasts: Sequence[Target], may_err: frozenset[str]
) -> Program:
    """Make the program of loops, or that of the engine `numpy` where loops do not pay."""
    dag = lowering.dag
    targets = [*map(lowering.target, filters), *(_as_number(dag, lowering.target(target)) for target in forecasts)]
    needed = _Needed.of(dag, targets)
    if loops_pay(dag, needed.nodes, needed.rules):
        return JitProgram(lowering, filters, forecasts, may_err, needed)
    return NumpyProgram.of(lowering, filters, forecasts, may_err)


class _Needed(NamedTuple):
    """The nodes that targets need where loops compute what they can.

    Attributes:
        nodes: themselves, each after those that it reads.
        rules: of those that loops compute.
        reads: what each reads.
    """

    nodes: list[int]
    rules: dict[int, LoopRule]
    reads: dict[int, tuple[int, ...]]

    @classmethod
    def of(cls, dag: Dag, targets: Sequence[int]) -> _Needed:
        """Those of these targets."""
        rules: dict[int, LoopRule] = {}
        result: dict[int, tuple[int, ...]] = {}

        def read(node: int) -> tuple[int, ...]:
            rule = loop_rule_of(dag, node)
            if rule is not None:
                rules[node] = rule
            result[node] = reads(dag, node, rule)
            return result[node]

        return cls(dag.upstream(targets, read), rules, result)

    def looking_up(self, dag: Dag) -> _Needed:
        """Return a lowering where functions of numbers of tables are looked up; some of its nodes may not be needed any
        more.
        """
        looked_up = rules_of_looked_up(dag, self.nodes, self.rules, machine())
        changed = {node: reads(dag, node, rule) for node, rule in looked_up.items()}
        return _Needed(self.nodes, self.rules | looked_up, self.reads | changed)


class _Division:
    """The nodes of a program in stages: those of all trials, and those of the survivors alone.

    Args:
        lowering: of the nodes.
        needed: of the filters and forecasts.
        filters, forecasts: nodes.
        may_err: the inputs whose draws may be errors.

    Attributes:
        inputs: the names of the inputs, by their nodes.
        largest_block: see `JitProgram`.
    """

    def __init__(
        self,
        lowering: Lowering,
        needed: _Needed,
        filters: Sequence[int],
        forecasts: Sequence[int],
        may_err: frozenset[str],
    ) -> None:
        dag, read = lowering.dag, needed.reads
        # Where no filter can reject a trial, nothing needs to be picked from the survivors.
        first = dag.upstream(filters or forecasts, read.__getitem__)
        early = frozenset(first)
        further = dag.upstream(forecasts, read.__getitem__) if filters else []
        late = [node for node in further if node not in early]
        carried = {used for node in late for used in read[node]} | set(forecasts)
        keep, wanted = {*filters, *(carried & early)}, set(forecasts)
        # Loops take the nodes in order: in one in which they leave few values to each other.
        in_order = order_by_need(first, read, keep, _FEW_BETWEEN_LOOPS)
        self.first = Stages(dag, needed.rules, read, in_order, keep, None, may_err)
        in_order = order_by_need(late, read, wanted, _FEW_BETWEEN_LOOPS)
        self.late = Stages(dag, needed.rules, read, in_order, wanted, early, may_err)
        self.inputs = _inputs(dag, [*first, *late])
        self._array_bytes = array_bytes(lowering, filters, forecasts, needed.nodes)
        self.largest_block = self._largest_block(len(self.inputs) + len(forecasts))

    def _largest_block(self, columns: int) -> int:
        """Return the largest block whose arrays fit into the memory, draws and forecasts among them: so many
        columns.
        """
        arrays = self.first.waiting + self.late.waiting
        memory = _MOST_MEMORY if self.first.only_loops and self.late.only_loops else _MOST_IN_CACHES
        block = _LARGEST_BLOCK
        while block > _SMALLEST_BLOCK and (block * 8 * arrays > memory or block * 8 * columns > _MOST_IN_COLUMNS):
            block //= 2
        return fitting_block(block, self._array_bytes, 8 * arrays)


class JitProgram:
    """The graph of nodes, compiled for this machine.

    Args:
        may_err: the inputs whose draws may be errors (NaNs).
        needed: of the filters and forecasts; found where it is not given.

    Attributes:
        largest_block: the largest block, a power of two, whose arrays take no more than 256 MB; 32 MB where functions
            outside of loops pass over them. It is smaller where there are hundreds of assumptions and forecasts.
    """

    def __init__(
        self,
        lowering: Lowering,
        filters: Sequence[Target],
        forecasts: Sequence[Target],
        may_err: frozenset[str],
        needed: _Needed | None = None,
    ) -> None:
        self.dag, self.may_err = lowering.dag, may_err
        self.filter_nodes = [lowering.target(target) for target in filters]
        self.forecast_nodes = [_as_number(lowering.dag, lowering.target(target)) for target in forecasts]
        needed = needed or _Needed.of(self.dag, [*self.filter_nodes, *self.forecast_nodes])
        division = _Division(lowering, needed.looking_up(self.dag), self.filter_nodes, self.forecast_nodes, may_err)
        self.largest_block, self.inputs = division.largest_block, division.inputs
        self.first, self.late = Phase(division.first, machine()), Phase(division.late, machine())
        self.slots = self.first.slots | self.late.slots

    @cached_property
    def careful_inputs(self) -> dict[int, str]:
        """The names of the inputs that the careful path reads, by their nodes."""
        return _inputs(self.dag, self.dag.upstream([*self.filter_nodes, *self.forecast_nodes]))

    def evaluator(self, block: int) -> Evaluator:
        """See `Program`."""
        return _JitEvaluator(self, block)


def _as_number(dag: Dag, node: int) -> int:
    """Return a forecast's node, or one that gives 1 and 0 instead of truth values: loops write forecasts as numbers."""
    if dag.types[node] is not Kind.LOGICAL or dag.sizes[node] is not None:
        return node
    return dag.add(Select(node, dag.constant(constant(1.0)), dag.constant(constant(0.0))))


def _inputs(dag: Dag, nodes: Sequence[int]) -> dict[int, str]:
    """Return the names of the inputs among the nodes."""
    return {node_id: node.name for node_id in nodes if isinstance(node := dag.nodes[node_id], Input)}


class _JitEvaluator:
    def __init__(self, program: JitProgram, block: int) -> None:
        self._program, self._block = program, block
        self._memory = Memory(program.slots, block)
        self._tracking = TrackingEvaluator(program.dag, program.filter_nodes, program.forecast_nodes)
        self._all = np.empty(0, np.intp)
        self._trials = self._of_block({}, 0)
        self._draws: Mapping[str, Floats] = {}
        self._too_large = False

    def _of_block(self, inputs: Mapping[str, Floats], n: int) -> Trials:
        trials = Trials(self._program.dag, n, np.zeros(n, np.uint8), None, self._all)
        if n:
            for node, name in self._program.inputs.items():
                trials.arrays[node] = np.ascontiguousarray(inputs[name])
        return trials

    def block_runner(
        self, names: Sequence[str], draw: Callable[[int], Mapping[str, Floats]], linear: Linear | None
    ) -> BlockRunner | None:
        """See `RunsWholeBlocks`."""
        program = self._program
        parts = block_parts(
            program.dag, program.first, program.late, program.filter_nodes, program.forecast_nodes, self._block
        )
        return None if parts is None else NativeBlockRunner(parts, names, draw, linear, self._block)

    def filters(self, inputs: Mapping[str, Floats], n: int) -> list[Column]:
        """See `Evaluator`."""
        self._draws, self._trials = inputs, self._of_block(inputs, n)
        program = self._program
        try:
            program.first.run(self._trials, self._memory)
        except FormulaError:
            self._too_large = True
            return self._tracking.filters(inputs, n)
        self._too_large = False
        columns = self._columns(self._trials, program.filter_nodes)
        again = np.flatnonzero(self._trials.wrong)
        if again.size:
            columns = _correct(columns, again, self._tracking.filters(self._pick(again), again.size))
        return columns

    def forecasts(self, survivors: NDArray[np.intp]) -> list[Column]:
        """See `Evaluator`."""
        program, m = self._program, survivors.size
        survivors = np.ascontiguousarray(survivors, np.intp)
        if self._too_large:
            return self._tracking.forecasts(survivors)
        trials = Trials(program.dag, m, self._trials.wrong[survivors], self._trials, survivors)
        try:
            program.late.run(trials, self._memory)
        except FormulaError:
            self._tracking.filters(self._draws, self._trials.wrong.size)
            return self._tracking.forecasts(survivors)
        columns = self._columns(trials, program.forecast_nodes)
        again = np.flatnonzero(trials.wrong)
        if again.size:
            self._tracking.filters(self._pick(survivors[again]), again.size)
            columns = _correct(columns, again, self._tracking.forecasts(np.arange(again.size)))
        return columns

    def _columns(self, trials: Trials, nodes: Sequence[int]) -> list[Column]:
        """Return the results; of draws that may be errors the `Value`, for no loop has looked at them."""
        columns = []
        for node_id in nodes:
            node = self._program.dag.nodes[node_id]
            fallible = isinstance(node, Input) and node.name in self._program.may_err
            columns.append(trials.column(node_id, fallible))
        return columns

    def _pick(self, trials: NDArray[np.intp]) -> dict[str, Floats]:
        return {name: self._draws[name][trials] for name in self._program.careful_inputs.values()}


def _correct(columns: Sequence[Column], again: NDArray[np.intp], careful: Sequence[Column]) -> list[Column]:
    """Return the columns (n,) with the trials `again` (k,) as the careful path has them (k,)."""
    corrected = []
    for column, result in zip(columns, careful, strict=True):
        values = column.values.copy()
        codes = np.zeros(values.size, np.uint8) if column.codes is None else np.array(column.codes)
        values[again] = result.values
        codes[again] = 0 if result.codes is None else result.codes
        texts = column.texts
        if result.texts is not None:
            texts = np.full(values.size, "", object) if texts is None else np.array(texts)
            texts[again] = result.texts
        corrected.append(Column(values, codes if codes.any() else None, texts))
    return corrected
