"""The steps of a plan in a row: ufuncs of plain numbers, nearly all of them, run in one loop from one table."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from xlmc.compile.buffers import Buffers
from xlmc.compile.dag import Apply, Dag
from xlmc.compile.steps import Frame, Step, is_elementwise_ufunc, make_step
from xlmc.functions import Kind

__all__ = ["Steps"]


class _Line(NamedTuple):
    """`values[place] = ufunc(values[first], values[second], out=buffers[buffer])`; no `second` is -1."""

    ufunc: np.ufunc
    place: int
    first: int
    second: int
    buffer: int


class Steps:
    """Collects the steps of nodes in order, with the buffers that they write to."""

    def __init__(self, dag: Dag, buffers: Buffers) -> None:
        self._made: list[Step] = []
        self._dag, self._buffers = dag, buffers
        self._lines: list[_Line] = []

    def add(self, place: int, done: list[int]) -> None:
        """The step of a node, after which nothing reads the values of `done` any more."""
        line = self._is_line(place)
        early = line or is_elementwise_ufunc(self._dag, place)  # it may write over what it reads
        if early:
            self._buffers.free(done)
        buffer = self._buffers.take(place)
        if not early:
            self._buffers.free(done)
        if line and buffer is not None:
            self._lines.append(_line(self._dag, place, buffer))
        else:
            self.append(make_step(self._dag, place, buffer))

    def append(self, step: Step) -> None:
        """A step that has its memory already."""
        self._close()
        self._made.append(step)

    def finish(self) -> list[Step]:
        """All of them."""
        self._close()
        return self._made

    def _is_line(self, place: int) -> bool:
        node, types = self._dag.nodes[place], self._dag.types
        if type(node) is not Apply or not node.function.on_numbers or node.function.guard is not None:
            return False
        used = node.arguments
        ufunc = node.function.ufunc
        if ufunc is None or len(used) != ufunc.nin or len(used) > 2:
            return False
        return types[used[0]] is Kind.NUMBER and types[used[-1]] is Kind.NUMBER

    def _close(self) -> None:
        if self._lines:
            self._made.append(_run(self._lines))
            self._lines = []


def _line(dag: Dag, place: int, buffer: int) -> _Line:
    node = dag.nodes[place]
    assert isinstance(node, Apply)
    assert node.function.ufunc is not None
    used = node.arguments
    return _Line(node.function.ufunc, place, used[0], used[1] if len(used) == 2 else -1, buffer)


def _run(lines: list[_Line]) -> Step:
    def step(frame: Frame) -> None:
        values, buffers = frame.values, frame.buffers
        for ufunc, place, first, second, buffer in lines:
            if second < 0:
                values[place] = ufunc(values[first], buffers[buffer])
            else:
                values[place] = ufunc(values[first], values[second], buffers[buffer])

    return step
