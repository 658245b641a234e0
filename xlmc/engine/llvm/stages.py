"""How nodes that are computed on one set of trials are divided: into loops, and between them what loops cannot compute.

Nothing is compiled here.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Final, NamedTuple

import numpy as np

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Input
from xlmc.engine.graph.readiness import order_by_need
from xlmc.engine.llvm.loop import Load
from xlmc.engine.llvm.loop_rules import Literal, LoopRule, Operand, is_number
from xlmc.engine.llvm.memory import Slot, assign_slots
from xlmc.engine.llvm.shapes import LONGEST, Forms, cut
from xlmc.excel.functions import Kind
from xlmc.excel.functions.values import Floats

__all__ = ["LoopPlan", "Stage", "Stages"]

_ENOUGH: Final = 4
"""An order of stages in which no more values wait is good enough."""


@dataclass(frozen=True, slots=True, eq=False)
class LoopPlan:
    """A loop to be compiled: the rules of its nodes in order, the arrays it reads, and the nodes it writes.

    Attributes:
        shape: equal for loops that the same code serves if it reads numbers from memory.
    """

    rules: Mapping[int, LoopRule]
    loads: tuple[Load, ...]
    stores: tuple[int, ...]
    shape: tuple[object, ...]

    @property
    def slots(self) -> dict[tuple[int, int], int]:
        """(node, position of the operand) -> index of a number that the code may read from memory."""
        operands = ((node, *expression) for node, rule in self.rules.items() for expression in enumerate(rule.operands))
        numbers = ((node, position) for node, position, part in operands if is_number(part))
        return {slot: at for at, slot in enumerate(numbers)}

    @property
    def numbers(self) -> Floats:
        """These numbers."""
        parts = [part for rule in self.rules.values() for part in rule.operands if type(part) is Literal]
        return np.array([part.value for part in parts if is_number(part)], np.float64)


@dataclass(frozen=True, slots=True, eq=False)
class Stage:
    """Nodes that are computed together, in order.

    Attributes:
        forms: of the nodes of a loop, see `Forms`.
        read: the nodes of other stages that they need.
        stores: the nodes of a loop that others need, or that are wanted afterwards; None if this is no loop.
    """

    nodes: tuple[int, ...]
    forms: tuple[int, ...]
    read: frozenset[int]
    stores: tuple[int, ...] | None


class Stages:
    """The nodes in stages, in order.

    Args:
        dag: of the nodes.
        rules: of the nodes that loops can compute.
        reads: what each reads.
        nodes: to be computed, in order.
        keep: the nodes whose values are wanted afterwards.
        early: the nodes that were computed before, on a wider set of trials; otherwise None.
        may_err: the inputs whose draws may be errors.

    Attributes:
        reads: what each node reads.
        waiting: how many arrays and values wait at a time, of loops and of what is computed outside of them.
    """

    def __init__(
        self,
        dag: Dag,
        rules: Mapping[int, LoopRule],
        reads: Mapping[int, Sequence[int]],
        nodes: Sequence[int],
        keep: Iterable[int],
        early: frozenset[int] | None,
        may_err: frozenset[str],
    ) -> None:
        self.dag, self.reads, self.may_err, self.outputs = dag, reads, may_err, frozenset(keep)
        self._rules, self._early = rules, early
        computed = [node for node in nodes if not isinstance(dag.nodes[node], Input)]
        forms = Forms(rules, dag.types)
        groups = [_Group(*group, self._read_by(group[0])) for group in _groups(computed, rules, reads, forms)]
        wanted = self.outputs.union(*(group.read for group in groups))
        self.in_order = [
            Stage(*group, tuple(node for node in group.nodes if node in wanted) if group.forms else None)
            for group in _in_order(groups)
        ]
        outside = [stage.nodes if stage.stores is None else () for stage in self.in_order]
        written = [stage.stores or () for stage in self.in_order]
        self.waiting = sum(len({*self.slots(each).values()}) for each in (written, outside))

    @property
    def only_loops(self) -> bool:
        """Whether all stages are loops."""
        return all(stage.stores is not None for stage in self.in_order)

    def slots(self, written: Sequence[Sequence[int]]) -> dict[int, Slot]:
        """Return the memory of the nodes that each stage writes."""
        stages = [(stage.read, nodes) for stage, nodes in zip(self.in_order, written, strict=True)]
        return assign_slots(self.dag, stages, self.outputs, late=self._early is not None)

    def last_reads(self) -> dict[int, list[int]]:
        """Return the stage after which nothing reads them -> nodes that are computed outside of loops."""
        outside = {node for stage in self.in_order if stage.stores is None for node in stage.nodes} - self.outputs
        last = {node: at for at, stage in enumerate(self.in_order) for node in outside.intersection(stage.read)}
        result: dict[int, list[int]] = {}
        for node, at in last.items():
            result.setdefault(at, []).append(node)
        return result

    def _read_by(self, group: Sequence[int]) -> frozenset[int]:
        return frozenset(chain.from_iterable(map(self.reads.__getitem__, group))).difference(group)

    def loop_plans(self) -> Iterator[LoopPlan]:
        """Return the loops of the stages that are loops."""
        for stage in self.in_order:
            if stage.stores is not None:
                rules = {node: self._rules[node] for node in stage.nodes}
                parts = (part for rule in rules.values() for part in (*rule.operands, *rule.beside))
                read = [self._load(part) for part in parts if type(part) is Operand and part.node in stage.read]
                loads = tuple(dict.fromkeys(read))
                at = {load: position for position, load in enumerate(loads)}
                kinds = [(load.operand.kind, load.stored, load.picked, load.fallible) for load in loads]
                written = map(frozenset(stage.stores).__contains__, stage.nodes)
                shape = stage.forms, tuple([at[load] for load in read]), tuple(kinds), tuple(written)
                yield LoopPlan(rules, loads, stage.stores, shape)

    def _load(self, part: Operand) -> Load:
        """How a node from outside is read."""
        node = self.dag.nodes[part.node]
        is_input = isinstance(node, Input)
        picked = self._early is not None and (is_input or part.node in self._early)
        if isinstance(node, Input):
            return Load(Operand(part.node, Kind.NUMBER), Kind.NUMBER, picked, node.name in self.may_err)
        if part.node in self._rules:
            own = self.dag.types[part.node]
            return Load(Operand(part.node, own), own, picked, False)  # it was checked when it was written
        return Load(part, Kind.NUMBER, picked, True)


def _groups(
    nodes: Sequence[int], rules: Mapping[int, LoopRule], reads: Mapping[int, Sequence[int]], forms: Forms
) -> Iterator[tuple[tuple[int, ...], tuple[int, ...]]]:
    """Group the nodes, in order, each with their forms; those without a rule stand alone, without one."""
    if nodes and all(node in rules for node in nodes):
        yield from _cut(nodes, forms)
        return
    levels: dict[int, int] = {}
    for node in nodes:
        in_loop = node in rules
        levels[node] = 0 if in_loop else 1  # loops stand on even levels
        for used in reads[node]:
            if used in levels:
                after = levels[used] + ((used in rules) != in_loop)
                levels[node] = max(levels[node], after)
    grouped: defaultdict[int, list[int]] = defaultdict(list)
    for node in nodes:
        grouped[levels[node]].append(node)
    for level in sorted(grouped):
        loop = level % 2 == 0
        yield from _cut(grouped[level], forms) if loop else (((node,), ()) for node in grouped[level])


def _cut(nodes: Sequence[int], forms: Forms) -> Iterator[tuple[tuple[int, ...], tuple[int, ...]]]:
    """Return the nodes of loops, with their forms."""
    result = forms.of(nodes)
    for part in cut(result):
        yield tuple(nodes[part]), result[part]


class _Group(NamedTuple):
    """See `Stage`."""

    nodes: tuple[int, ...]
    forms: tuple[int, ...]
    read: frozenset[int]


def _in_order(groups: Sequence[_Group]) -> list[_Group]:
    """Order the groups so that few wait at a time to be read; one may need as many others as it has nodes."""
    made = {node: at for at, group in enumerate(groups) for node in group.nodes}
    needs = {at: sorted({made[node] for node in group.read if node in made}) for at, group in enumerate(groups)}
    return [groups[at] for at in order_by_need(range(len(groups)), needs, (), _ENOUGH, few=2 * LONGEST)]
