"""The order in which nodes are computed: one in which few values wait at a time.

In the order in which they are made, whole columns of a sheet that steps through time come one after another, and every
row of one waits for those of the next. Here a node follows as soon as one of those that it reads is there and few of
the others are missing, which are computed before it; first in, first out. So the columns of a row come together, and
how many values wait does not depend on the number of rows. But values that are read late may come too early: so it is
the better of the two orders.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Mapping, Sequence, Set
from typing import Final

__all__ = ["FEW", "most_waiting", "order_by_need"]

FEW: Final = 8
"""The few of a formula's nodes: on sheets that step through time any number from 4 to 32 does."""

_MANY: Final = 16
"""A value that more nodes read calls none of them: like a draw, it is there for all rows."""

Reads = Mapping[int, Sequence[int]]


def order_by_need(
    nodes: Sequence[int], reads: Reads, keep: Collection[int], enough: int, few: int = FEW
) -> Sequence[int]:
    """The nodes in the better order.

    Args:
        nodes: in the order in which they were made.
        reads: what each reads, other nodes included.
        keep: the nodes that are read afterwards.
        enough: an order in which no more values wait is good enough.
        few: a node is computed early if it is one of at most so many that are then still to be computed.
    """
    waiting = most_waiting(nodes, reads, keep)
    if waiting <= enough:
        return nodes
    early = _as_early_as_possible(nodes, reads, few)
    return early if most_waiting(early, reads, keep) < waiting else nodes


def _as_early_as_possible(nodes: Sequence[int], reads: Reads, few: int) -> list[int]:
    own = set(nodes)
    readers: dict[int, list[int]] = {node: [] for node in nodes}
    for node in nodes:
        for used in own.intersection(reads[node]):
            readers[used].append(node)
    found: dict[int, None] = {}
    for first in nodes:
        waiting = deque([first])
        while waiting:
            for node in _missing(waiting.popleft(), own, found.keys(), reads, few):
                found[node] = None
                if len(readers[node]) <= _MANY:
                    waiting.extend(readers[node])
    return list(found)


def _missing(node: int, own: Set[int], done: Set[int], reads: Reads, few: int) -> list[int]:
    """The nodes to compute for a node, itself the last; none where it is done, or where they are more than a few."""
    if node in done:
        return []
    found: dict[int, None] = {}
    open_ = [(node, iter(reads[node]))]
    while open_:
        at, rest = open_[-1]
        used = next((used for used in rest if used in own and used not in done and used not in found), None)
        if used is not None:
            open_.append((used, iter(reads[used])))
            if len(open_) + len(found) > few:
                return []
        else:
            open_.pop()
            found[at] = None
    return list(found)


def most_waiting(order: Sequence[int], reads: Reads, keep: Collection[int]) -> int:
    """The most values of these nodes that wait at a time to be read."""
    last = {used: node for node in order for used in reads[node]} | dict.fromkeys(keep, -1)
    ends = dict.fromkeys(order, 0)
    for node in order:
        reader = last.get(node, node)
        if reader in ends:
            ends[reader] += 1
    waiting = most = 0
    for node in order:
        waiting += 1
        most = max(most, waiting)
        waiting -= ends[node]
    return most
