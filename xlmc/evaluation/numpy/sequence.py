"""The steps of a plan in a row. Nearly all are ufuncs of plain numbers, run in one loop from one table.

A line of the table costs little to make and to run; what does not fit one gets a step of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from xlmc.evaluation.graph.dag import Apply, Constant, Dag, Select, uses
from xlmc.evaluation.numpy.buffers import Buffers
from xlmc.evaluation.numpy.steps import Departure, Frame, Step, is_elementwise_ufunc, make_step
from xlmc.evaluation.passes.bounds import Bounds, of_constant
from xlmc.functions import Kind
from xlmc.functions.fifteen_digits import SETTLED, Settled, keep, never_cancels
from xlmc.functions.math.trigonometry import Within, sine_and_cosine
from xlmc.functions.registry import Elementwise
from xlmc.functions.values import Value

__all__ = ["Steps"]


_Line = tuple[Elementwise | Callable[..., Any] | None, int, int, int, int, Any]
"""(ufunc, place, first, second, buffer, guard): the ufunc of `values[first]` and `values[second]` (-1 for none) goes to
`values[place]`, in that buffer, where the guard, if any, holds. Without a ufunc it is the choice between `first` and
`second` by the logical at the place that stands for the guard."""


class Steps:
    """Collects the steps of nodes in order, with the buffers that they write to.

    Args:
        dag: of the nodes.
        buffers: to take from.
        places: the nodes to come.
        between: node -> its bounds, where they are known: a guard that they answer is not asked.
    """

    def __init__(
        self, dag: Dag, buffers: Buffers, places: Iterable[int], between: Mapping[int, Bounds] | None = None
    ) -> None:
        self._made: list[Step] = []
        self._dag, self._buffers = dag, buffers
        self._lines: list[_Line] = []
        self._loose: list[int] = []
        self._pairs = _sines_with_cosines(dag, places)
        self._had: set[int] = set()
        self._between = between or {}

    def add(self, place: int, read: Sequence[int], done: list[int]) -> None:
        """The step of a node.

        Args:
            place: of the node.
            read: what it reads.
            done: what nothing reads after it.
        """
        node, types = self._dag.nodes[place], self._dag.types
        if place in self._pairs:
            if place not in self._had:
                self._add_pair(*self._pairs[place])
            self._free(done)
            return
        if (
            type(node) is Apply
            and node.function.takes_plainly == len(node.arguments)
            and (types[node.arguments[0]] is types[node.arguments[-1]] is Kind.NUMBER)
        ):
            function, used = node
            if function.name == SETTLED.name:
                done.sort(key=used[0].__eq__)  # the memory that was given back last is taken: nothing is copied then
            buffer = self._buffers.exchange(done, place, self._loose)  # it may write over what it reads
            if buffer is not None:
                second = used[1] if len(used) == 2 else -1
                ufunc = self._settled(node) if function.name == SETTLED.name else function.ufunc
                self._lines.append((ufunc, place, used[0], second, buffer, self._guard(place)))
                return
        elif is_elementwise_ufunc(self._dag, place):
            self._free(done)
            buffer = self._buffers.take(place)
        else:
            buffer = self._buffers.take(place)
            self._free(done)
            if buffer is not None and self._tabled(place, read, buffer):
                return
        self._append(make_step(self._dag, place, buffer))

    def add_free(self, step: Step, done: Iterable[int]) -> None:
        """A step that has memory of its own; nothing reads `done` after it."""
        self._free(done)
        self._append(step)

    def _free(self, done: Iterable[int]) -> None:
        """Give back buffers; let go, after the next step, of values that are in none."""
        self._loose += self._buffers.free(done)

    def _append(self, step: Step) -> None:
        self._close()
        self._made.append(step)
        gone = [place for place in self._loose if type(self._dag.nodes[place]) is not Constant]
        if gone:
            self._made.append(_letting_go(gone))
        self._loose.clear()

    def finish(self) -> list[Step]:
        """All of them."""
        self._close()
        return self._made

    def _tabled(self, place: int, read: Sequence[int], buffer: int) -> bool:
        """A choice between numbers, or a fold of numbers, as lines."""
        node, types = self._dag.nodes[place], self._dag.types
        if types[place] is not Kind.NUMBER:
            return False
        if type(node) is Select:
            plain = types[node.yes] is types[node.no] is Kind.NUMBER and types[node.condition] is Kind.LOGICAL
            if plain:
                self._lines.append((None, place, node.yes, node.no, buffer, node.condition))
            return plain
        if type(node) is not Apply or not node.function.takes_sets or len(read) < 2:
            return False
        ufunc = node.function.ufunc
        if ufunc is None or node.function.parameters[0].kind is not Kind.NUMBER:
            return False
        if not all(types[cell] is Kind.NUMBER for cell in read):
            return False
        self._lines.append((ufunc, place, read[0], read[1], buffer, None))
        self._lines += [(ufunc, place, place, cell, buffer, None) for cell in read[2:]]
        return True

    def _add_pair(self, sine: int, cosine: int) -> None:
        """The sine and the cosine of one angle in one step."""
        (angle,) = uses(self._dag.nodes[sine])
        first, second = self._buffers.take(sine), self._buffers.take(cosine)
        if first is None or second is None:
            self._append(make_step(self._dag, sine, None))
            self._append(make_step(self._dag, cosine, None))
        else:
            work = self._buffers.take_for(Kind.NUMBER)
            self._buffers.give_back(work)
            self._append(_pair(angle, self._guard(sine), (sine, cosine), (first, second, work)))
        self._had |= {sine, cosine}

    def _guard(self, place: int) -> Callable[..., bool] | None:
        """The guard of an `Apply`; None where there is none to ask."""
        node = self._dag.nodes[place]
        assert type(node) is Apply
        guard = node.function.guard
        if guard is None or not isinstance(guard, Within):
            return guard
        known = self._between.get(node.arguments[0])
        return None if known is not None and guard.surely(*known) else guard

    def _settled(self, node: Apply) -> Callable[..., object]:
        """What makes of a formula's last sum what Excel makes of it: nothing, where that is known to be the sum."""
        total, first = node.arguments
        added = self._dag.nodes[total]
        second = self._bounds(added.arguments[1]) if type(added) is Apply and added.function.name == "+" else None
        of_total, of_first = self._bounds(total), self._bounds(first)
        if of_first is None:
            return Settled()
        if of_total is not None and never_cancels(of_total, of_first, second):
            return keep
        return Settled(max(abs(of_first[0]), abs(of_first[1])))

    def _bounds(self, place: int) -> Bounds | None:
        return self._between.get(place) or of_constant(self._dag, place)

    def _close(self) -> None:
        if self._lines:
            self._made.append(_run(self._lines))
            self._lines = []


def _sines_with_cosines(dag: Dag, places: Iterable[int]) -> dict[int, tuple[int, int]]:
    """The sines and cosines of angles of which both are wanted: place -> (sine, cosine)."""
    found: dict[str, dict[int, int]] = {"SIN": {}, "COS": {}}
    for place in places:
        node = dag.nodes[place]
        if type(node) is Apply and node.function.name in found and dag.types[node.arguments[0]] is Kind.NUMBER:
            found[node.function.name][node.arguments[0]] = place
    both = [(found["SIN"][angle], found["COS"][angle]) for angle in found["SIN"].keys() & found["COS"].keys()]
    return {place: pair for pair in both for place in pair}


def _pair(
    angle: int, guard: Callable[..., bool] | None, places: tuple[int, int], buffers: tuple[int, int, int]
) -> Step:
    sine, cosine = places

    def step(frame: Frame) -> None:
        values = frame.values
        if guard is not None and not guard(values[angle]):
            raise Departure
        values[sine], values[cosine], work = (frame.buffers[buffer] for buffer in buffers)
        sine_and_cosine(values[angle], values[sine], values[cosine], work)

    return step


def _letting_go(places: list[int]) -> Step:
    def step(frame: Frame) -> None:
        for place in places:
            found, frame.values[place] = frame.values[place], None
            if isinstance(found, Value):
                frame.live -= found.nbytes

    return step


def _run(lines: list[_Line]) -> Step:
    def step(frame: Frame) -> None:
        values, buffers, underflow = frame.values, frame.buffers, frame.underflow
        for ufunc, place, first, second, buffer, guard in lines:
            if ufunc is None:
                out = buffers[buffer]
                np.copyto(out, values[second])
                np.copyto(out, values[first], where=values[guard])
                values[place] = out
            elif second < 0:
                if guard is not None and not guard(values[first]):
                    raise Departure
                values[place] = ufunc(values[first], out=buffers[buffer])
            else:
                if guard is not None and not guard(values[first], values[second]):
                    raise Departure
                values[place] = ufunc(values[first], values[second], out=buffers[buffer])
            if underflow.raised:
                frame.flush(place)

    return step
