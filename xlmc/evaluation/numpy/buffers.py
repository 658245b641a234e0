"""Arrays that steps write to, taken and given back as the values in them come and go."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.evaluation.graph.dag import Apply, Dag, Rescue, Select
from xlmc.functions import Kind

__all__ = ["Buffers"]

_LINE = 64


class Buffers:
    """Assigns buffers to nodes while a plan is made; `allocate` makes the arrays."""

    def __init__(self, dag: Dag) -> None:
        self._dag = dag
        self._types: list[Kind] = []
        self._idle: defaultdict[Kind, list[int]] = defaultdict(list)
        self._held: dict[int, int] = {}

    def take(self, place: int) -> int | None:
        """A buffer for the node's value; None where it makes its own array."""
        node, kind = self._dag.nodes[place], self._dag.types[place]
        if isinstance(node, Rescue):
            self._held.pop(node.value, None)  # the value lives on under another name: its buffer is never given back
            return None
        if (kind is not Kind.NUMBER and kind is not Kind.LOGICAL) or not isinstance(node, (Apply, Select)):
            return None
        self._held[place] = buffer = self.take_for(kind)
        return buffer

    def take_for(self, kind: Kind) -> int:
        """A buffer of that kind, until `give_back`."""
        if self._idle[kind]:
            return self._idle[kind].pop()
        self._types.append(kind)
        return len(self._types) - 1

    def free(self, places: Iterable[int]) -> list[int]:
        """Give back the buffers of values that nothing reads any more; those that are in no buffer."""
        held, loose = self._held, []
        for place in places:
            buffer = held.pop(place, None)
            if buffer is None:
                loose.append(place)
            else:
                self._idle[self._types[buffer]].append(buffer)
        return loose

    def exchange(self, done: Iterable[int], place: int, loose: list[int]) -> int | None:
        """`free`, what is in no buffer going to `loose`, and then `take` for a number or a logical."""
        held, idle = self._held, self._idle
        for gone in done:
            buffer = held.pop(gone, None)
            if buffer is None:
                loose.append(gone)
            else:
                idle[self._types[buffer]].append(buffer)
        kind = self._dag.types[place]
        ready = idle[kind]
        held[place] = taken = ready.pop() if ready else self.take_for(kind)
        return taken

    def give_back(self, buffer: int) -> None:
        """A buffer that nothing reads any more."""
        self._idle[self._types[buffer]].append(buffer)

    @property
    def trial_bytes(self) -> int:
        """What one trial takes in all of them."""
        return sum(1 if kind is Kind.LOGICAL else 8 for kind in self._types)

    def allocate(self, block: int) -> list[NDArray[Any]]:
        """The arrays, `(block,)` each, on cache lines of their own."""
        return [_array(block, np.dtype(np.bool_ if kind is Kind.LOGICAL else np.float64)) for kind in self._types]


def _array(block: int, dtype: np.dtype[Any]) -> NDArray[Any]:
    size = block * dtype.itemsize
    raw = np.empty(size + _LINE, np.uint8)
    start = -raw.ctypes.data % _LINE
    return raw[start : start + size].view(dtype)
