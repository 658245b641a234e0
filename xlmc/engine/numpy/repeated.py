"""Targets that are computed again and again, for other values of one input: what does not depend on it, once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Target
from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.lowering import Lowering
from xlmc.engine.graph.nodes import Constant, Input
from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.engine.numpy.steps import reads
from xlmc.engine.passes.bounds import NodeBounds
from xlmc.engine.tracking import array_bytes
from xlmc.excel.functions import Kind

__all__ = ["RepeatedProgram", "RepeatedTargets"]

_MOST_UNREACHED: Final = 64
"""Numbers that are kept at a time; of more, reading them takes as long as computing them."""

Floats = NDArray[np.float64]
Trials = NDArray[np.intp]
RepeatedTargets = Callable[[Floats, Trials | None], tuple[list[Floats], ...]]
"""Takes the input `(m,)` and the trials `(m,)` that it is for, None for all; gives, for some of them after the other,
the targets, NaN for no number."""


@dataclass(frozen=True, slots=True)
class RepeatedProgram:
    """Programs of targets as a function of one input.

    Attributes:
        changing: that input.
        dag, targets: the nodes of `rest`.
        whole: the program of the targets.
        unreached: the program of the numbers that they need and the input does not reach; None where there are none.
        names: of these numbers, as inputs of `rest`.
        rest: the program of the targets, given these numbers; else `whole`.
        inputs: what `rest` reads, but for `changing`.
    """

    changing: str
    dag: Dag
    targets: tuple[int, ...]
    whole: NumpyProgram
    unreached: NumpyProgram | None
    names: tuple[str, ...]
    rest: NumpyProgram
    inputs: tuple[str, ...]

    @classmethod
    def of(cls, lowering: Lowering, targets: Sequence[Target], changing: str) -> RepeatedProgram:
        """Compile them."""
        nodes, dag = [lowering.target(each) for each in targets], lowering.dag
        computed = dag.upstream(nodes, partial(reads, dag))
        size = array_bytes(lowering, nodes, [], computed)
        whole = NumpyProgram(dag, nodes, [], frozenset(), NodeBounds(dag, {}), size)
        names = {node: f"\0held {node}" for node in _unreached(dag, nodes, computed, changing)}
        if not 0 < len(names) <= _MOST_UNREACHED:
            return cls(changing, dag, (*nodes,), whole, None, (), whole, _inputs(dag, nodes, changing))
        first = NumpyProgram(dag, [*names], [], frozenset(), NodeBounds(dag, {}), size)
        given = dag.with_inputs(names)
        rest = NumpyProgram(given, nodes, [], frozenset(), NodeBounds(given, {}), size)
        return cls(changing, given, (*nodes,), whole, first, (*names.values(),), rest, _inputs(given, nodes, changing))

    def evaluated(self, given: Mapping[str, Floats], n: int) -> RepeatedTargets:
        """Return the targets as a function of the input and the trial, of other inputs `(n,)` each; for one thread."""
        known = self.read(given, n)
        program, read = (self.whole, given) if known is None else (self.rest, known)
        block = min(program.largest_block, max(n, 1))
        evaluator = program.evaluator(block)
        chosen: tuple[Trials | None, Mapping[str, Floats]] = None, read

        def targets(at: Floats, trials: Trials | None) -> tuple[list[Floats], ...]:
            nonlocal chosen
            if trials is not chosen[0]:  # the same trials are asked for again and again
                chosen = trials, read if trials is None else {name: column[trials] for name, column in read.items()}
            result: list[list[Floats]] = []
            for start in range(0, at.size, block):
                part = slice(start, min(start + block, at.size))
                inputs = {name: column[part] for name, column in chosen[1].items()}
                inputs[self.changing] = at[part]
                columns = evaluator.filters(inputs, part.stop - part.start)
                result.append([column.as_floats(copy=at.size > block) for column in columns])
            return tuple(result)

        return targets

    def read(self, given: Mapping[str, Floats], n: int) -> dict[str, Floats] | None:
        """Compute what `rest` reads beside the input, `(n,)` each; None if it is no number in a trial."""
        known = dict(given)
        if self.unreached is None:
            return {name: known[name] for name in self.inputs}
        block = min(self.unreached.largest_block, max(n, 1))
        evaluator = self.unreached.evaluator(block)
        result = [np.empty(n) for _ in self.names]
        for start in range(0, n, block):
            part = slice(start, min(start + block, n))
            columns = evaluator.filters({name: column[part] for name, column in given.items()}, part.stop - part.start)
            if any(column.codes is not None for column in columns):
                return None
            for whole, column in zip(result, columns, strict=True):
                whole[part] = column.values
        known |= zip(self.names, result, strict=True)
        return {name: known[name] for name in self.inputs}


def _unreached(dag: Dag, targets: Sequence[int], computed: Sequence[int], changing: str) -> list[int]:
    """Return the nodes of numbers that one input does not reach, of which only others that it does not reach are made.

    Args:
        dag: of the nodes.
        targets: nodes.
        computed: the nodes that vary and that the targets need, in order.
        changing: the input.
    """
    reached: set[int] = set()
    for node in computed:
        if dag.nodes[node] == Input(changing) or not reached.isdisjoint(reads(dag, node)):
            reached.add(node)
    result: set[int] = set()
    left, seen = [*targets], set[int]()
    while left:
        node = left.pop()
        if node in seen or isinstance(dag.nodes[node], Constant | Input):
            continue
        seen.add(node)
        if node not in reached and dag.types[node] is Kind.NUMBER and dag.sizes[node] is None:
            result.add(node)
        else:
            left += reads(dag, node)
    return sorted(result)


def _inputs(dag: Dag, targets: Sequence[int], changing: str) -> tuple[str, ...]:
    """Return the names of the inputs that targets need, errors among what they need included."""
    nodes = (dag.nodes[node] for node in dag.upstream(targets))
    return tuple(node.name for node in nodes if isinstance(node, Input) and node.name != changing)
