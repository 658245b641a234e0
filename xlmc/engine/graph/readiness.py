"""The order in which nodes are computed: one in which few values wait at a time.

In the order in which they are made, whole columns of a sheet that steps through time come one after another, and every
row of one waits for those of the next. Here a node follows as soon as one of those that it reads is there and few of
the others are missing, which are computed before it; first in, first out. So the columns of a row come together, and
how many values wait does not depend on the number of rows. But values that are read late may come too early: so it is
the better of the two orders.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Container, Iterable, Mapping, Sequence
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
    """Put the nodes in the better order.

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
    needs = {node: [used for used in reads[node] if used in own] for node in nodes}
    readers: dict[int, list[int]] = {node: [] for node in nodes}
    for node in nodes:
        for used in set(needs[node]):
            readers[used].append(node)
    order: list[int] = []
    done: set[int] = set()
    for first in nodes:
        waiting = deque([first])
        while waiting:
            wanted = waiting.popleft()
            if wanted in done:
                continue
            for node in (wanted,) if done.issuperset(needs[wanted]) else _missing(wanted, needs, done, few):
                order.append(node)
                done.add(node)
                if len(readers[node]) <= _MANY:
                    waiting.extend(readers[node])
    return order


def _missing(node: int, needs: Reads, done: Container[int], few: int) -> Iterable[int]:
    """Return the nodes to compute for a node, itself the last; none where they are more than a few."""
    result: dict[int, None] = {}
    open_ = [node]
    while open_:
        at = open_[-1]
        for used in needs[at]:
            if used not in done and used not in result:
                open_.append(used)
                break
        else:
            open_.pop()
            result[at] = None
        if len(open_) + len(result) > few:
            return ()
    return result


def most_waiting(order: Sequence[int], reads: Reads, keep: Iterable[int]) -> int:
    """Return the most values of these nodes that wait at a time to be read."""
    own = set(order)
    waiting, most = own.intersection(keep), 0
    for node in reversed(order):  # what waits before a node is what waits after it, and what it reads
        waiting.discard(node)
        for used in reads[node]:
            if used in own:
                waiting.add(used)
        if len(waiting) >= most:
            most = len(waiting) + 1
    return most
