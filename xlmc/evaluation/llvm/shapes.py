"""Loops of one shape: those that differ in their arrays and their constants alone, which one native code serves.

On a sheet that steps through time the nodes repeat themselves, row after row. They are cut where they do, so that the
loops of all rows are of one shape, and compiling takes no longer however many rows there are.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from xlmc.evaluation.graph.dag import Dag
from xlmc.evaluation.graph.nodes import Select
from xlmc.evaluation.llvm.loop_rules import Literal, LoopRule, Operand

__all__ = ["Shape", "cut", "shape_of"]

_FEWEST: Final = 4
"""Periods that are worth looking for."""

_ROWS: Final = 150
"""The most nodes of a part that has several rows: a longer part takes longer to compile, and runs no faster."""

_TRIED: Final = 3
"""The most frequent gaps between nodes that are alike: one of them is the period, where there is one."""


class Shape(NamedTuple):
    """What native code depends on, and what it does not.

    Attributes:
        key: equal for loops that the same code serves.
        slots: (node, position of the operand) -> index of a number.
        numbers: the constants, which the code reads from memory.
    """

    key: tuple[object, ...]
    slots: Mapping[tuple[int, int], int]
    numbers: tuple[float, ...]


def shape_of(
    dag: Dag, rules: Mapping[int, LoopRule], loads: Sequence[tuple[Operand, object]], stores: Sequence[int]
) -> Shape:
    """The shape of a loop.

    Args:
        dag: of its nodes.
        rules: of its nodes, in order.
        loads: what it reads, and all else that the code depends on of each.
        stores: the nodes that it writes.
    """
    own = {node: at for at, node in enumerate(rules)}
    outside = {operand: at for at, (operand, _) in enumerate(loads)}
    slots: dict[tuple[int, int], int] = {}
    numbers: list[float] = []

    def part_of(node: int, position: int, part: Operand | Literal) -> object:
        if isinstance(part, Operand):
            if part.node in own:
                return own[part.node], part.kind
            found = part if part in outside else Operand(part.node, dag.types[part.node])
            return "load", outside[found], part.kind
        if isinstance(part.value, bool):
            return "truth", part.value
        slots[node, position] = len(numbers)
        numbers.append(float(part.value))
        return "number"

    key = [
        (
            *(rule.emit, rule.makes, rule.absorbs, isinstance(dag.nodes[node], Select), dag.types[node]),
            tuple(part_of(node, position, part) for position, part in enumerate(rule.operands)),
            tuple(part_of(node, -1, part) for part in rule.beside),
        )
        for node, rule in rules.items()
    ]
    written = tuple(own[node] for node in stores)
    return Shape((tuple(key), tuple(attributes for _, attributes in loads), written), slots, tuple(numbers))


def cut(dag: Dag, nodes: Sequence[int], rules: Mapping[int, LoopRule], longest: int) -> list[Sequence[int]]:
    """The nodes in parts of at most `longest`; where they repeat themselves, the parts do, too."""
    if len(nodes) <= longest:
        return [nodes]
    start, period, end = _repetition(dag, nodes, rules, longest)
    if not period:
        return _portions(nodes, longest)
    size = max(1, _ROWS // period) * period
    rows = [nodes[at : min(at + size, end)] for at in range(start, end, size)]
    return [
        *_portions(nodes[:start], longest),
        *(portion for row in rows for portion in _portions(row, longest)),
        *_portions(nodes[end:], longest),
    ]


def _portions(nodes: Sequence[int], longest: int) -> list[Sequence[int]]:
    return [nodes[at : at + longest] for at in range(0, len(nodes), longest)]


def _repetition(dag: Dag, nodes: Sequence[int], rules: Mapping[int, LoopRule], longest: int) -> tuple[int, int, int]:
    """The longest repetition of nodes: its first node, the length of a period, and the node after its last. The period
    is 0 where they do not, or not often. What lies as far back as a part is long lies in another part.
    """
    at = {node: position for position, node in enumerate(nodes)}
    known: dict[object, int] = {}

    def likeness(node: int) -> int:
        distances = [
            at[node] - at.get(part.node, -longest) for part in rules[node].operands if isinstance(part, Operand)
        ]
        near = tuple(distance if distance < longest else 0 for distance in distances)
        return known.setdefault((rules[node].emit, dag.types[node], len(rules[node].operands), near), len(known))

    alike = np.array([likeness(node) for node in nodes])
    last: dict[int, int] = {}
    gaps: Counter[int] = Counter()
    for position, kind in enumerate(alike.tolist()):
        gaps[position - last.get(kind, position)] += 1
        last[kind] = position
    del gaps[0]
    runs = [(*_longest_run(alike, gap), gap) for gap, _ in gaps.most_common(_TRIED)]
    length, start, period = max(runs, default=(0, 0, 0))
    whole = length // period + 1 if period else 0
    return (start, period, start + whole * period) if whole >= _FEWEST else (0, 0, 0)


def _longest_run(alike: NDArray[np.intp], gap: int) -> tuple[int, int]:
    """How many nodes in a row are like the ones so far behind them, and the first of them."""
    same = np.concatenate([[False], alike[:-gap] == alike[gap:], [False]])
    edges = np.flatnonzero(same[1:] != same[:-1]).reshape(-1, 2)
    if not edges.size:
        return 0, 0
    longest = int(np.argmax(edges[:, 1] - edges[:, 0]))
    start, stop = edges[longest].tolist()
    return stop - start, start
