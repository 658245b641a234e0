"""The arrays that loops and steps write to: as many as hold values that are still to be read."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Hashable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.cache_lines import aligned_array
from xlmc.engine.graph.graph import Dag
from xlmc.excel.functions import Kind

__all__ = ["Memory", "Slot", "assign_slots"]


class Slot(NamedTuple):
    """An array, for one node after another.

    Attributes:
        late: whether it is for the survivors.
        logical: whether it holds truth values.
        number: which of those it is.
    """

    late: bool
    logical: bool
    number: int


def assign_slots(
    dag: Dag, stages: Sequence[tuple[Iterable[int], Sequence[int]]], keep: Collection[int], *, late: bool
) -> dict[int, Slot]:
    """Node -> its slot. A slot is taken again after the stage that is the last to read it.

    Args:
        dag: of the nodes.
        stages: the nodes that each reads from others, and those that it writes, in order.
        keep: the nodes that are read afterwards.
        late: whether they are for the survivors.
    """
    last = {node: at for at, (read, _) in enumerate(stages) for node in read}
    ends: defaultdict[int, list[int]] = defaultdict(list)
    slots: dict[int, Slot] = {}
    idle: dict[bool, list[Slot]] = {False: [], True: []}
    made = {False: 0, True: 0}
    for at, (_, written) in enumerate(stages):
        for node in written:
            logical = dag.types[node] is Kind.LOGICAL
            if not idle[logical]:
                idle[logical].append(Slot(late, logical, made[logical]))
                made[logical] += 1
            slots[node] = idle[logical].pop()
            if node not in keep:
                ends[last.get(node, at)].append(node)
        for node in ends.pop(at, ()):
            idle[slots[node].logical].append(slots[node])
    return slots


class Memory:
    """Arrays that loops write to, by node, `(block,)`; for one thread.

    Attributes:
        addresses: of the arrays that loops read and write.
        failures: node -> blocks in which it could not be computed with plain numbers.
    """

    def __init__(self, slots: Mapping[int, Slot], block: int) -> None:
        arrays: dict[Slot, NDArray[Any]] = {
            slot: aligned_array(block, np.dtype(np.bool_ if slot.logical else np.float64))
            for slot in set(slots.values())
        }
        self._arrays = {node: arrays[slot] for node, slot in slots.items()}
        self.addresses = _Addresses()
        self.failures: Counter[int] = Counter()

    def of(self, node: int, n: int) -> NDArray[Any]:
        """Return the first `n` elements of a node's array."""
        array = self._arrays[node]
        return array if n == array.size else array[:n]


class _Addresses:
    """The addresses of arrays, looked up once for arrays that come with every block: the look-up takes NumPy a while.

    It holds, and keeps alive, the array last seen under each key. For one thread.
    """

    def __init__(self) -> None:
        self._seen: dict[Hashable, tuple[NDArray[Any], int]] = {}

    def of(self, key: Hashable, array: NDArray[Any]) -> int:
        """Return the address of the first element."""
        seen = self._seen.get(key)
        if seen is not None and seen[0] is array:
            return seen[1]
        address: int = array.__array_interface__["data"][0]
        self._seen[key] = array, address
        return address
