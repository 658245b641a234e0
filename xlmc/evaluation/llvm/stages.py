"""How nodes that are computed on one set of trials are divided: into loops, and between them what loops cannot compute.

Nothing is compiled yet.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Final

from xlmc.evaluation.graph.dag import Dag
from xlmc.evaluation.graph.nodes import Input
from xlmc.evaluation.graph.readiness import order_by_need
from xlmc.evaluation.llvm.loop import Load
from xlmc.evaluation.llvm.loop_rules import LoopRule, Operand
from xlmc.evaluation.llvm.memory import Slot, assign_slots
from xlmc.evaluation.llvm.shapes import Shape, cut, shape_of
from xlmc.functions import Kind

__all__ = ["LoopPlan", "Stage", "Stages"]

_LONGEST: Final = 250
"""The most nodes of one loop; the time to compile grows faster than the loop."""

_ENOUGH: Final = 4
"""An order of stages in which no more values wait is good enough."""


@dataclass(frozen=True, slots=True, eq=False)
class LoopPlan:
    """A loop to be compiled: the rules of its nodes in order, the arrays it reads, and the nodes it writes."""

    rules: Mapping[int, LoopRule]
    loads: tuple[Load, ...]
    stores: tuple[int, ...]

    def shape(self, dag: Dag) -> Shape:
        """What its code depends on."""
        loads = [(load.operand, (load.operand.kind, load.stored, load.picked, load.fallible)) for load in self.loads]
        return shape_of(dag, self.rules, loads, self.stores)


@dataclass(frozen=True, slots=True, eq=False)
class Stage:
    """Nodes that are computed together, in order.

    Attributes:
        read: the nodes of other stages that they need.
        stores: the nodes of a loop that others need, or that are wanted afterwards; None where this is no loop.
    """

    nodes: tuple[int, ...]
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
        early: the nodes that were computed before, on a wider set of trials; None where there are none.
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
        self.dag, self.reads, self.may_err, self.kept = dag, reads, may_err, frozenset(keep)
        self._rules, self._early = rules, early
        computed = [node for node in nodes if not isinstance(dag.nodes[node], Input)]
        groups = _in_order([(group, self._read_by(group)) for group in _groups(dag, computed, rules, reads)])
        wanted = self.kept.union(*(read for _, read in groups))
        self.in_order = [
            Stage(group, read, tuple(node for node in group if node in wanted) if group[0] in rules else None)
            for group, read in groups
        ]
        outside = [stage.nodes if stage.stores is None else () for stage in self.in_order]
        written = [stage.stores or () for stage in self.in_order]
        self.waiting = sum(len({*self.slots(each).values()}) for each in (written, outside))

    @property
    def only_loops(self) -> bool:
        """Whether all stages are loops."""
        return all(stage.stores is not None for stage in self.in_order)

    def slots(self, written: Sequence[Sequence[int]]) -> dict[int, Slot]:
        """The memory of the nodes that each stage writes."""
        stages = [(stage.read, nodes) for stage, nodes in zip(self.in_order, written, strict=True)]
        return assign_slots(self.dag, stages, self.kept, late=self._early is not None)

    def last_reads(self) -> dict[int, list[int]]:
        """The stage after which nothing reads them -> nodes that are computed outside of loops."""
        outside = {node for stage in self.in_order if stage.stores is None for node in stage.nodes} - self.kept
        last = {node: at for at, stage in enumerate(self.in_order) for node in outside.intersection(stage.read)}
        found: dict[int, list[int]] = {}
        for node, at in last.items():
            found.setdefault(at, []).append(node)
        return found

    def _read_by(self, group: Sequence[int]) -> frozenset[int]:
        return frozenset(chain.from_iterable(map(self.reads.__getitem__, group))).difference(group)

    def loop_plans(self) -> Iterator[LoopPlan]:
        """The loops of the stages that are loops."""
        for stage in self.in_order:
            if stage.stores is not None:
                rules = {node: self._rules[node] for node in stage.nodes}
                parts = (part for rule in rules.values() for part in (*rule.operands, *rule.beside))
                read = (part for part in parts if isinstance(part, Operand) and part.node in stage.read)
                loads = {load.operand: load for load in map(self._load, read)}
                yield LoopPlan(rules, tuple(loads.values()), stage.stores)

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
    dag: Dag, nodes: Sequence[int], rules: Mapping[int, LoopRule], reads: Mapping[int, Sequence[int]]
) -> list[tuple[int, ...]]:
    """The nodes, in order, in groups in order; those without a rule stand alone."""
    if nodes and all(node in rules for node in nodes):
        return [tuple(part) for part in cut(dag, nodes, rules, _LONGEST)]
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
    groups: list[tuple[int, ...]] = []
    for level in sorted(grouped):
        loop = level % 2 == 0
        parts = cut(dag, grouped[level], rules, _LONGEST) if loop else [[node] for node in grouped[level]]
        groups += [tuple(part) for part in parts]
    return groups


Group = tuple[tuple[int, ...], frozenset[int]]
"""Nodes, and those that they need from others."""


def _in_order(groups: Sequence[Group]) -> list[Group]:
    """The groups so that few wait at a time to be read; one may need as many others as it has nodes."""
    made = {node: at for at, (group, _) in enumerate(groups) for node in group}
    needs = {at: sorted({made[node] for node in read if node in made}) for at, (_, read) in enumerate(groups)}
    return [groups[at] for at in order_by_need(range(len(groups)), needs, (), _ENOUGH, few=2 * _LONGEST)]
