"""The steps of a program in order. Nearly all are ufuncs of plain numbers, run in one loop from one table.

A line of the table costs little to make and to run; what does not fit into a line gets a step of its own.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence, Set
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.cache_lines import aligned_array
from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant, IfErrorNode, Select, uses
from xlmc.engine.graph.number_lookups import key_of, lookup_of
from xlmc.engine.numpy.looked_up import LookedUp
from xlmc.engine.numpy.sine_pairs import sines_with_cosines
from xlmc.engine.numpy.steps import Frame, LeaveFastPath, Step, is_elementwise_ufunc, make_step
from xlmc.engine.passes.bounds import NodeBounds
from xlmc.excel.functions import Kind
from xlmc.excel.functions.budget import work_arrays
from xlmc.excel.functions.fifteen_digits import SNAP_TO_ZERO, Comparison, SnapToZero, copy_sum, never_cancels
from xlmc.excel.functions.lookup.search_and_pick import Pick, Search
from xlmc.excel.functions.math.trigonometry import Within, sine_and_cosine
from xlmc.excel.functions.registry import Elementwise
from xlmc.excel.functions.values import Value

__all__ = ["Buffers", "Steps", "find_indices"]

_Line = tuple[Elementwise | Callable[..., Any] | None, int, int, int, int, Any]
"""(ufunc, node, first, second, buffer, guard): the ufunc of `values[first]` and `values[second]` (-1 for none) goes to
`values[node]`, in that buffer, where the guard, if any, holds. Without a ufunc it is the choice between `first` and
`second` by the logical node that stands for the guard."""


class Buffers:
    """Assigns buffers to nodes while a program is made; `allocate` makes the arrays."""

    def __init__(self, dag: Dag) -> None:
        self._dag = dag
        self._types: list[Kind] = []
        self._idle: defaultdict[Kind, list[int]] = defaultdict(list)
        self._in_use: dict[int, int] = {}

    def take(self, node_id: int) -> int | None:
        """Return a buffer for the node's value; None if it makes its own array."""
        node, kind = self._dag.nodes[node_id], self._dag.types[node_id]
        if isinstance(node, IfErrorNode):
            self._in_use.pop(node.value, None)  # this node has the same array: its buffer is never given back
            return None
        if (kind is not Kind.NUMBER and kind is not Kind.LOGICAL) or not isinstance(node, (Apply, Select)):
            return None
        self._in_use[node_id] = buffer = self.take_for(kind)
        return buffer

    def take_for(self, kind: Kind) -> int:
        """Take a buffer of that kind, until `give_back`."""
        if self._idle[kind]:
            return self._idle[kind].pop()
        self._types.append(kind)
        return len(self._types) - 1

    def free(self, nodes: Iterable[int]) -> list[int]:
        """Give back the buffers of values that nothing reads any more; return the nodes that are in no buffer."""
        in_use, loose = self._in_use, []
        for node in nodes:
            buffer = in_use.pop(node, None)
            if buffer is None:
                loose.append(node)
            else:
                self._idle[self._types[buffer]].append(buffer)
        return loose

    def exchange(self, done: Iterable[int], node: int, loose: list[int]) -> int | None:
        """Do `free`, appending to `loose` the nodes in no buffer; then `take`, for a number or a logical."""
        in_use, idle = self._in_use, self._idle
        for gone in done:
            buffer = in_use.pop(gone, None)
            if buffer is None:
                loose.append(gone)
            else:
                idle[self._types[buffer]].append(buffer)
        kind = self._dag.types[node]
        ready = idle[kind]
        in_use[node] = taken = ready.pop() if ready else self.take_for(kind)
        return taken

    def give_back(self, buffer: int) -> None:
        """Give back a buffer that nothing reads any more."""
        self._idle[self._types[buffer]].append(buffer)

    @property
    def trial_bytes(self) -> int:
        """The bytes of one trial in all buffers."""
        return sum(1 if kind is Kind.LOGICAL else 8 for kind in self._types)

    def allocate(self, block: int) -> list[NDArray[Any]]:
        """Make the arrays, `(block,)` each, on cache lines of their own."""
        return [
            aligned_array(block, np.dtype(np.bool_ if kind is Kind.LOGICAL else np.float64)) for kind in self._types
        ]


def find_indices(
    dag: Dag,
    nodes: Sequence[int],
    read: Mapping[int, Sequence[int]],
    keep: Collection[int],
    looked_up: Mapping[int, LookedUp],
) -> set[int]:
    """Find the positions of lookups that nothing but picks reads: they need not be numbers of their own.

    Args:
        dag: of the nodes.
        nodes: the nodes to be computed.
        read: what each reads.
        keep: what is read after them.
        looked_up: the nodes that are picked from tables.
    """
    lookups = {node: lookup_of(dag, of) for node in nodes if type(of := dag.nodes[node]) is Apply}
    result = {node for node, lookup in lookups.items() if type(lookup) is Search}.difference(keep)
    for node in nodes if result else ():
        if node not in looked_up and type(lookups.get(node)) is not Pick:
            result.difference_update(read[node])
    return result


class Steps:
    """Collects the steps of nodes in order, with the buffers that they write to.

    Args:
        dag: of the nodes.
        buffers: to take from.
        nodes: the nodes to come.
        bounds: of the nodes: a guard that they answer is not asked.
        looked_up: the nodes that are picked from tables.
        indices: the positions that are kept as `Search.indices`.
    """

    def __init__(
        self,
        dag: Dag,
        buffers: Buffers,
        nodes: Iterable[int],
        bounds: NodeBounds,
        looked_up: Mapping[int, LookedUp],
        indices: Set[int],
    ) -> None:
        self._made: list[Step] = []
        self._dag, self._buffers = dag, buffers
        self._lines: list[_Line] = []
        self._loose: list[int] = []
        self._pairs = sines_with_cosines(dag, [node for node in nodes if node not in looked_up])
        self._paired: set[int] = set()
        self._bounds, self._looked_up, self._indices = bounds, looked_up, indices

    def add(self, node_id: int, read: Sequence[int], done: list[int]) -> None:
        """Add the step of a node.

        Args:
            node_id: of the node.
            read: what it reads.
            done: what nothing reads after it.
        """
        node, types = self._dag.nodes[node_id], self._dag.types
        if node_id in self._pairs:
            if node_id not in self._paired:
                self._add_pair(*self._pairs[node_id])
            self._free(done)
            return
        if node_id in self._looked_up:
            if self._add_lookup(node_id, *self._looked_up[node_id], done):
                return
        elif (
            type(node) is Apply
            and node.function.fast_arity == len(node.arguments)
            and (types[node.arguments[0]] is types[node.arguments[-1]] is Kind.NUMBER)
        ):
            function, used = node
            if function.name == SNAP_TO_ZERO.name:
                done.sort(key=used[0].__eq__)  # the memory that was given back last is taken: nothing is copied then
            buffer = self._buffers.exchange(done, node_id, self._loose)  # it may write over what it reads
            if buffer is not None:
                second = used[1] if len(used) == 2 else -1
                self._lines.append((self._function(node), node_id, used[0], second, buffer, self._guard(node_id)))
                return
        elif type(node) is Apply and (lookup := lookup_of(self._dag, node)) is not None:
            if self._add_lookup(node_id, lookup, key_of(node), done):
                return
        elif is_elementwise_ufunc(self._dag, node_id):
            self._free(done)
            buffer = self._buffers.take(node_id)
        else:
            buffer = self._buffers.take(node_id)
            self._free(done)
            if buffer is not None and self._add_lines(node_id, read, buffer):
                return
        self._append(make_step(self._dag, node_id, buffer))

    def add_free(self, step: Step, done: Iterable[int]) -> None:
        """Add a step that has memory of its own; nothing reads `done` after it."""
        self._free(done)
        self._append(step)

    def _free(self, done: Iterable[int]) -> None:
        """Give back buffers; values that are in none are dropped after the next step."""
        self._loose += self._buffers.free(done)

    def _append(self, step: Step) -> None:
        self._close_table()
        self._made.append(step)
        gone = [node for node in self._loose if type(self._dag.nodes[node]) is not Constant]
        if gone:
            self._made.append(_drop_values(gone))
        self._loose.clear()

    def finish(self) -> list[Step]:
        """All steps."""
        self._close_table()
        return self._made

    def _add_lines(self, node_id: int, read: Sequence[int], buffer: int) -> bool:
        """Add a choice between numbers, or a fold of numbers, as lines; False where the node is neither."""
        node, types = self._dag.nodes[node_id], self._dag.types
        if types[node_id] is not Kind.NUMBER:
            return False
        if type(node) is Select:
            plain = types[node.yes] is types[node.no] is Kind.NUMBER and types[node.condition] is Kind.LOGICAL
            if plain:
                self._lines.append((None, node_id, node.yes, node.no, buffer, node.condition))
            return plain
        if node_id in self._dag.folded:
            self._lines.append((np.positive, node_id, read[0], -1, buffer, None))
            return True
        if type(node) is not Apply or not node.function.takes_sets or len(read) < 2:
            return False
        ufunc = node.function.ufunc
        if ufunc is None or node.function.parameters[0].kind is not Kind.NUMBER:
            return False
        if not all(types[cell] is Kind.NUMBER for cell in read):
            return False
        self._lines.append((ufunc, node_id, read[0], read[1], buffer, None))
        self._lines += [(ufunc, node_id, node_id, cell, buffer, None) for cell in read[2:]]
        return True

    def _add_lookup(self, node_id: int, lookup: Search | Pick, of: int, done: list[int]) -> bool:
        """Add a search of the key `of`, or a pick at the position `of`; False where there is no buffer for it."""
        if isinstance(lookup, Pick) and of in self._indices:
            buffer = self._buffers.take(node_id)
            self._free(done)
        else:
            buffer = self._buffers.exchange(done, node_id, self._loose)
        if buffer is None:
            return False
        if isinstance(lookup, Search):
            search = lookup.indices if node_id in self._indices else lookup
            self._lines.append((search, node_id, of, -1, buffer, lookup.finds))
        else:
            self._lines.append((lookup.at if of in self._indices else lookup, node_id, of, -1, buffer, None))
        return True

    def _add_pair(self, sine: int, cosine: int) -> None:
        """Add the sine and the cosine of one angle as one step."""
        (angle,) = uses(self._dag.nodes[sine])
        first, second = self._buffers.take(sine), self._buffers.take(cosine)
        if first is None or second is None:
            self._append(make_step(self._dag, sine, None))
            self._append(make_step(self._dag, cosine, None))
        else:
            work = self._buffers.take_for(Kind.NUMBER)
            self._buffers.give_back(work)
            self._append(_pair(angle, self._guard(sine), (sine, cosine), (first, second, work)))
        self._paired |= {sine, cosine}

    def _guard(self, node_id: int) -> Callable[..., bool] | None:
        """Return the guard of an `Apply`; otherwise None."""
        node = self._dag.nodes[node_id]
        assert type(node) is Apply
        guard = node.function.guard
        if guard is None or not isinstance(guard, Within):
            return guard
        known = self._bounds.of(node.arguments[0])
        return None if known is not None and guard.surely(*known) else guard

    def _function(self, node: Apply) -> Elementwise | Callable[..., object] | None:
        """Return what computes a function of plain numbers, as fast as their bounds allow where they are known."""
        function = node.function
        if function.name == SNAP_TO_ZERO.name:
            return self._last_sum(node)
        if isinstance(function.ufunc, Comparison):
            return function.ufunc.within(*map(self._bounds.of, node.arguments))
        return function.ufunc

    def _last_sum(self, node: Apply) -> Callable[..., object]:
        """Return the function for the last sum of a formula; it keeps every sum where bounds show that none is dust."""
        total, first = node.arguments
        added, of = self._dag.nodes[total], self._bounds.of
        operator = added.function.name if type(added) is Apply else ""
        second = of(uses(added)[1]) if operator in ("+", "-") else None
        of_total, of_first, plus = of(total), of(first), second if operator == "+" else None
        if of_total is not None and of_first is not None and never_cancels(of_total, of_first, plus):
            return copy_sum
        return SnapToZero.within(of_first, second)

    def _close_table(self) -> None:
        if self._lines:
            self._made.append(_run(self._lines))
            self._lines = []


def _pair(angle: int, guard: Callable[..., bool] | None, nodes: tuple[int, int], buffers: tuple[int, int, int]) -> Step:
    sine, cosine = nodes

    def step(frame: Frame) -> None:
        values = frame.values
        if guard is not None and not guard(values[angle]):
            raise LeaveFastPath
        values[sine], values[cosine], work = (frame.buffers[buffer] for buffer in buffers)
        sine_and_cosine(values[angle], values[sine], values[cosine], work)

    return step


def _drop_values(nodes: list[int]) -> Step:
    def step(frame: Frame) -> None:
        for node in nodes:
            value, frame.values[node] = frame.values[node], None
            if isinstance(value, Value):
                frame.live -= value.nbytes

    return step


def _choose(condition: Any, yes: Any, no: Any, out: NDArray[Any]) -> NDArray[Any]:
    """Fill `out`, which must not be `no`, with `yes` where the condition holds, else with `no`.

    The bits of both are put together, for the processor predicts no branch that falls now this way, now that way.
    """
    chosen = np.count_nonzero(condition)
    if chosen in (0, out.size):
        np.copyto(out, yes if chosen else no)
        return out
    (work,) = work_arrays(out.size, 1)
    mask, bits = work.view(np.int64), out.view(np.int64)
    np.copyto(mask, np.negative(np.asarray(condition).view(np.int8)))  # all bits of a trial are 1, or all are 0
    chosen_bits, other = (np.asarray(numbers).view(np.int64) for numbers in (yes, no))
    if other.ndim == 0 and other == 0:
        np.bitwise_and(chosen_bits, mask, out=bits)
        return out
    np.bitwise_xor(chosen_bits, other, out=bits)
    np.bitwise_and(bits, mask, out=bits)
    np.bitwise_xor(bits, other, out=bits)
    return out


def _run(lines: list[_Line]) -> Step:
    def step(frame: Frame) -> None:
        values, buffers, underflow = frame.values, frame.buffers, frame.underflow
        for ufunc, node, first, second, buffer, guard in lines:
            if ufunc is None:
                values[node] = _choose(values[guard], values[first], values[second], buffers[buffer])
            elif second < 0:
                if guard is not None and not guard(values[first]):
                    raise LeaveFastPath
                values[node] = ufunc(values[first], out=buffers[buffer])
            else:
                if guard is not None and not guard(values[first], values[second]):
                    raise LeaveFastPath
                values[node] = ufunc(values[first], values[second], out=buffers[buffer])
            if underflow.raised:
                frame.flush(node)

    return step
