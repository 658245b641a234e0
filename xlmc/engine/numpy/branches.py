"""Which trials each node is evaluated on: all of them, the survivors of the filters, or those of one branch of an `IF`.

One set holds all trials, `SURVIVORS` those that every filter accepts, and each branch of an `IF` has the set of trials
that take it. A node goes to the narrowest set that holds all of its uses. A branch that can raise no error is not worth
a set of its own and is evaluated with its parent; one that could err is evaluated on the trials that take it, and on no
other.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from copy import copy
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant, Input, Select
from xlmc.engine.graph.trial_sets import ALL_TRIALS, DEEPEST_BRANCHES, TrialSet, common_set
from xlmc.engine.numpy.steps import Frame, Step, make_step, reads
from xlmc.excel.functions import Kind
from xlmc.excel.functions.values import Value

__all__ = ["SURVIVORS", "Placement", "branch_step"]

SURVIVORS: Final = TrialSet(ALL_TRIALS, depth=1)


class Placement:
    """The set of trials of every varying node that `first` (all trials) and `late` (survivors) need on the fast path.

    Attributes:
        reads: by node, the nodes whose values its step needs.
        branched: the `IF`s with branches that hold nodes of their own.
    """

    def __init__(self, dag: Dag, first: Sequence[int], late: Sequence[int]) -> None:
        self._dag = dag
        self.reads: dict[int, tuple[int, ...]] = {}
        sets = self._sets(first, late)
        hoisted = _find_safe_branches(dag, sets)
        self._members: defaultdict[TrialSet, list[int]] = defaultdict(list)
        for node in reversed(sets):  # they were found from the last to the first
            trials = sets[node]
            self._members[hoisted.get(trials, trials)].append(node)
        self._inner: defaultdict[TrialSet, list[TrialSet]] = defaultdict(list)
        self._branches: defaultdict[int, list[TrialSet]] = defaultdict(list)
        for trials in dict.fromkeys(outer for inner in self._members for outer in inner.outwards()):
            if trials.parent is not None and trials is not SURVIVORS:
                self._inner[trials.parent].append(trials)
                self._branches[trials.select].append(trials)
        self.branched = frozenset(self._branches)

    def reading_less(self, reads: Mapping[int, tuple[int, ...]], results: Iterable[int]) -> Placement:
        """Return the same sets where nodes read others than they did, without those that no node and no result needs
        then.
        """
        less = copy(self)
        less.reads, needed = {**self.reads, **reads}, set(results)
        for node in sorted(less.reads, reverse=True):
            if node in needed:
                needed.update(less.reads[node])
        less._members = defaultdict(list)
        for trials, members in self._members.items():
            less._members[trials] = [node for node in members if node in needed]
        return less

    def members(self, trials: TrialSet) -> list[int]:
        """Return the nodes of a set itself, in order."""
        return self._members.get(trials, [])

    def branches(self, node: int) -> list[TrialSet]:
        """Return the branches of an `IF` that hold nodes of their own."""
        return self._branches.get(node, [])

    def externals(self, trials: TrialSet | None, results: Iterable[int]) -> list[int]:
        """Return the varying nodes that a set, its inner sets included, takes from outside it; None has no nodes."""
        inside = set() if trials is None else set(self._inside(trials))
        read = {used for node in inside for used in self.reads[node]} | set(results)
        return sorted(node for node in read - inside if not isinstance(self._dag.nodes[node], Constant))

    def _inside(self, trials: TrialSet) -> Iterator[int]:
        yield from self.members(trials)
        for inner in self._inner.get(trials, ()):
            yield from self._inside(inner)

    def _sets(self, first: Sequence[int], late: Sequence[int]) -> dict[int, TrialSet]:
        """Find the set of each needed node, from the last node to the first."""
        nodes, types = self._dag.nodes, self._dag.types
        wanted: list[TrialSet | None] = [None] * len(nodes)
        for node_ids, trials in ((first, ALL_TRIALS), (late, SURVIVORS)):
            for node_id in node_ids:
                wanted[node_id] = common_set(wanted[node_id], trials)
        result: dict[int, TrialSet] = {}
        for node_id in range(len(nodes) - 1, -1, -1):
            at = wanted[node_id]
            node = nodes[node_id]
            if at is None or type(node) is Constant:
                continue
            if type(node) is Input:
                at = next(outer for outer in at.outwards() if outer.select < 0)  # draws are there for all trials
            result[node_id] = at
            self.reads[node_id] = read = reads(self._dag, node_id)
            if type(node) is Select and at.depth < DEEPEST_BRANCHES and _divides(types[node_id], types[node.condition]):
                edges = [(node.condition, at), (node.yes, at.taking(node_id, 1)), (node.no, at.taking(node_id, 0))]
                for used, inner in edges:
                    wanted[used] = common_set(wanted[used], inner)
                continue
            for used in read:
                if wanted[used] is not at:
                    wanted[used] = common_set(wanted[used], at)
        return result


def _divides(result: Kind, condition: Kind) -> bool:
    """Whether condition and result are plain arrays, so that trials can be split and results put together again."""
    return {result, condition} <= {Kind.NUMBER, Kind.LOGICAL}


def _find_safe_branches(dag: Dag, sets: dict[int, TrialSet]) -> dict[TrialSet, TrialSet]:
    """Return the branches in which nothing can err -> the nearest set around each that is kept."""
    used_sets = {ALL_TRIALS, SURVIVORS}
    for node, trials in sets.items():
        if trials not in used_sets and not _is_safe(dag, node):
            used_sets.update(trials.outwards())
    return {
        trials: next(outer for outer in trials.outwards() if outer in used_sets)
        for trials in set(sets.values()) - used_sets
    }


def _is_safe(dag: Dag, node_id: int) -> bool:
    node = dag.nodes[node_id]
    if dag.types[node_id] is Kind.ANY:
        return False
    return not isinstance(node, Apply) or node.function.facts.never_errs


def branch_step(dag: Dag, placement: Placement, node: int) -> Step:
    """Make the step of an `IF` with at least one branch in a set of its own."""
    select = dag.nodes[node]
    assert isinstance(select, Select)
    sets = {trials.branch: trials for trials in placement.branches(node)}
    yes = _Branch(dag, placement, sets.get(1), select.yes)
    no = _Branch(dag, placement, sets.get(0), select.no)
    dtype = np.bool_ if dag.types[node] is Kind.LOGICAL else np.float64

    def step(frame: Frame) -> None:
        condition = _truth(frame.values[select.condition])
        out: NDArray[Any] = np.empty(frame.n, dtype)
        for branch, taken in ((yes, condition), (no, ~condition)):
            index = np.flatnonzero(taken)
            if index.size:
                out[index] = branch.run(frame, index)
        frame.values[node] = out

    return step


def _truth(condition: NDArray[Any]) -> NDArray[np.bool_]:
    return np.asarray(condition if condition.dtype == np.bool_ else condition != 0)


class _Branch:
    """The steps of a branch; none where it has no set of its own, and its result was computed before."""

    def __init__(self, dag: Dag, placement: Placement, trials: TrialSet | None, result: int) -> None:
        self._result = result
        self._outside = placement.externals(trials, [result])
        members = [] if trials is None else placement.members(trials)
        self._steps = [_member_step(dag, placement, node) for node in members]

    def run(self, frame: Frame, index: NDArray[np.intp]) -> Any:
        """Compute the branch's value on the trials of `index`; while it runs, values from outside are cut to these
        trials.
        """
        values = frame.values
        whole = [values[node] for node in self._outside]
        for node, value in zip(self._outside, whole, strict=True):
            values[node] = value.take(index) if isinstance(value, Value) else value[index]
        inner = Frame(values, (), index.size, frame.underflow)
        for step in self._steps:
            step(inner)
        result = values[self._result]
        for node, value in zip(self._outside, whole, strict=True):
            values[node] = value
        return result


def _member_step(dag: Dag, placement: Placement, node: int) -> Step:
    return branch_step(dag, placement, node) if placement.branches(node) else make_step(dag, node, None)
