"""Runs a block by one native call: what the call takes from Python, and what it gives back.

It does so only for models that consist of loops alone; a block in which a trial must be computed again is run in the
usual way. Where the trials that count end within a chunk, that chunk has a call of its own.
"""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from math import gcd
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.cache_lines import aligned_array
from xlmc.engine.engine import AcceptedBlock, BlockMemory, Linear
from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Input
from xlmc.engine.llvm.block_kernel import WORD, Layout, compile_kernel
from xlmc.engine.llvm.loop_rules import Literal, Operand, literal
from xlmc.engine.llvm.machine import machine
from xlmc.engine.llvm.memory import Memory, Slot
from xlmc.engine.llvm.phase import Loop, Phase
from xlmc.engine.llvm.uniforms import filler
from xlmc.excel.functions import Kind
from xlmc.excel.functions.values import Floats

__all__ = ["BlockParts", "NativeBlockRunner", "block_parts"]

_CHUNK: Final = 2048
"""Trials at a time: few enough for the second-level cache, enough that the calls of the loops cost nothing."""

_FEWEST_IN_CHUNK: Final = 256
_MOST_BYTES: Final = 1 << 23
"""The bytes of a chunk's arrays, draws among them, above which a chunk has fewer trials. Measured on books of 12 to
1,000 assumptions: below it the number of trials hardly matters."""

_MOST_FILTERS: Final = 16
"""The most filters: every pair of them is counted."""

_PATIENCE: Final = 4
"""If more than one block in this many must be run step by step, whole blocks are not tried any more."""


Counts = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class BlockParts:
    """A model of loops alone: the loops on all trials and on the survivors, and the nodes that are its results.

    Attributes:
        slots: the memory of the nodes that the loops write.
        filters: the node of each filter; None for one that keeps every trial.
        forecasts: the node of each forecast, or the number that it always is.
    """

    dag: Dag
    first: tuple[Loop, ...]
    late: tuple[Loop, ...]
    slots: Mapping[int, Slot]
    filters: tuple[int | None, ...]
    forecasts: tuple[int | Literal, ...]

    @property
    def rejecting(self) -> dict[int, int]:
        """Position of a filter that may reject trials -> its node."""
        return {position: node for position, node in enumerate(self.filters) if node is not None}

    @property
    def of_kept(self) -> frozenset[int]:
        """The nodes that are written on the trials that are kept: all are where nothing is rejected."""
        loops = self.late if self.rejecting else (*self.first, *self.late)
        return frozenset(node for loop in loops for node in loop.stores)


def block_parts(
    dag: Dag, first: Phase, late: Phase, filters: Sequence[int], forecasts: Sequence[int], block: int
) -> BlockParts | None:
    """Return the parts of a model that can be run in whole blocks; None if it cannot."""
    early_loops, late_loops = first.loops, late.loops
    if early_loops is None or late_loops is None:
        return None
    if len(filters) > _MOST_FILTERS or block % WORD or sys.byteorder != "little":
        return None
    logical = {node for node in first.slots if dag.types[node] is Kind.LOGICAL}
    numbers = {node for node in (*first.slots, *late.slots) if dag.types[node] is Kind.NUMBER}
    numbers |= {node for node in forecasts if isinstance(dag.nodes[node], Input)}
    asked = [None if _find_literal(dag, node, Kind.LOGICAL) == Literal(True) else node for node in filters]
    given = [_find_literal(dag, node, Kind.NUMBER) or node for node in forecasts]
    if not {*asked} <= {None, *logical} or not {each for each in given if isinstance(each, int)} <= numbers:
        return None
    return BlockParts(dag, early_loops, late_loops, first.slots | late.slots, tuple(asked), tuple(given))


def _trials_in_chunk(arrays: int) -> int:
    """Round to a power of two."""
    trials = _CHUNK
    while trials > _FEWEST_IN_CHUNK and 8 * trials * arrays > _MOST_BYTES:
        trials //= 2
    return trials


def _find_literal(dag: Dag, node: int, kind: Kind) -> Literal | None:
    """Return the constant that a node is, if it is one of that kind."""
    return literal(dag, Operand(node, kind)) if dag.types[node] is kind else None


class NativeBlockRunner:
    """A `BlockRunner`, for one thread.

    Args:
        names, draw, linear: see `RunsWholeBlocks`; with `linear` a call makes the draws, too, a chunk at a time.
        block: trials, a multiple of 64.
    """

    def __init__(
        self,
        parts: BlockParts,
        names: Sequence[str],
        draw: Callable[[int], Mapping[str, Floats]],
        linear: Linear | None,
        block: int,
    ) -> None:
        self._parts, self._draw, self._names = parts, draw, tuple(names)
        self._rejecting, self._of_kept = parts.rejecting, parts.of_kept
        self._runs = self._careful = 0
        self._chunk = gcd(_trials_in_chunk(len(self._names) + len(set(parts.slots.values()))), block)
        rows = _aligned_rows(len(self._names), self._chunk + 8)[:, : self._chunk]  # apart, for the cache's sake
        self._fill = None if linear is None else filler(linear.streams, linear.maps, rows)
        self._rows = dict(zip(self._names, rows, strict=True))
        self._memory = Memory(parts.slots, self._chunk)
        self._trials, self._survivors = np.arange(block), np.arange(self._chunk)
        self._accepted = np.empty(block, np.int64)
        self._block_memory = BlockMemory(
            None,
            dict(zip(self._names, _aligned_rows(len(self._names), block), strict=True)),
            [*_aligned_rows(len(parts.forecasts), block)],
        )
        self._wrong = np.zeros((2, self._chunk), np.uint8)
        f = len(self._rejecting)
        self._counts = np.zeros(f * (f + 1) // 2 + f, np.int64)
        rows_of, columns_of = np.maximum(*np.indices((f, f))), np.minimum(*np.indices((f, f)))
        self._pairs = rows_of * (rows_of + 1) // 2 + columns_of
        self._column = {node: at for at, node in reversed([*enumerate(parts.forecasts)]) if isinstance(node, int)}
        self._forecast_targets: list[tuple[int, int]] = []
        self._draw_targets: dict[str, int] = {}
        self._write_table()

    def __call__(
        self, start: int, trials: int, inputs: bool, block_memory: Callable[[], BlockMemory] | None
    ) -> AcceptedBlock | None:
        """See `BlockRunner`."""
        if _PATIENCE * self._careful > max(self._runs, _PATIENCE):
            return None
        self._runs += 1
        self._words[:] = self._table
        drawn: Mapping[str, Floats] | None = None
        if self._fill is not None:
            self._fill.go_to(start)
        else:
            drawn = self._draw(start)
            rows = [np.ascontiguousarray(drawn[name], np.float64) for name in self._names]
            self._words[self._slots] = np.array([_address_of(row) for row in rows], np.uint64)[self._slot_rows]
        if inputs:
            self._words[self._gathers] += len(self._names)
        into = self._block_memory
        if block_memory is not None and not self._rejecting and trials == self._trials.size:
            given = block_memory()
            into = replace(given, forecasts=[*given.forecasts, *self._block_memory.forecasts[len(given.forecasts) :]])
            targets = list(self._targets(into))
            addresses = np.array([_address_of(array) for _, array in targets], np.uint64)
            self._words[np.array([at for at, _ in targets], np.intp)] = addresses
        result = self._run_chunks(trials)
        if result is None:
            self._careful += 1
            self._wrong.fill(0)
            return None
        return self._result(start, inputs, into, drawn, *result)

    def _run_chunks(self, trials: int) -> tuple[int, Counts, Counts] | None:
        """How many of the first trials are kept; of the filters that may reject, what pairs do, and each alone.

        None if a trial must be computed again.
        """
        chunks, rest = divmod(trials, self._chunk)
        self._counts.fill(0)
        m = self._run(self._address, chunks) if chunks else 0
        if m < 0:
            return None
        pairs, alone = self._counts[self._pairs], self._counts[self._counts.size - len(self._rejecting) :].copy()
        if rest:
            self._words[self._listed] += np.uint64(m * self._trials.itemsize)
            more = self._run(self._address, 1)
            if more < 0:
                return None
            if self._rejecting:
                self._trials[m : m + more] += chunks * self._chunk
                more = int(np.searchsorted(self._trials[m : m + more], trials))
                rejected = self._rejected(rest)
                pairs += rejected @ rejected.T
                alone += rejected[:, rejected.sum(axis=0) == 1].sum(axis=1)
            else:
                more = rest
            m += more
        return m, pairs, alone

    def _rejected(self, n: int) -> Counts:
        """1 where a filter rejects, of the first `n` trials of the last chunk: `(f, n)`."""
        nodes = self._rejecting.values()
        return np.array([self._memory.of(node, self._chunk)[:n] == 0 for node in nodes]).astype(np.int64)

    def _targets(self, block_memory: BlockMemory) -> Iterable[tuple[int, Floats]]:
        """Yield each position in the argument table of a column's address, and that column in `block_memory`."""
        yield from ((at, block_memory.forecasts[number]) for at, number in self._forecast_targets)
        yield from ((self._draw_targets[name], array) for name, array in block_memory.draws.items())

    def _result(
        self,
        start: int,
        inputs: bool,
        block_memory: BlockMemory,
        drawn: Mapping[str, Floats] | None,
        m: int,
        pairs: Counts,
        alone: Counts,
    ) -> AcceptedBlock:
        parts = self._parts
        accepted = self._accepted if block_memory.accepted is None else block_memory.accepted
        f = len(parts.filters)
        together, only = pairs, alone
        if len(self._rejecting) < f:
            rejecting = np.array([*self._rejecting], np.intp)
            together, only = np.zeros((f, f), np.int64), np.zeros(f, np.int64)
            together[np.ix_(rejecting, rejecting)], only[rejecting] = pairs, alone
        return AcceptedBlock(
            np.add(self._trials[:m], start, out=accepted[:m]),
            {name: block_memory.draws[name][:m] for name in self._names} if inputs else {},
            [
                np.broadcast_to(float(each.value), m)
                if isinstance(each, Literal)
                else block_memory.forecasts[self._column[each]][:m]
                for each in parts.forecasts
            ],
            together,
            only,
            drawn,
        )

    def _write_table(self) -> None:
        """Write the argument table that every block starts from, and compile the code that reads it."""
        parts, fill = self._parts, self._fill
        table = _TableWriter()
        draws = [] if fill is None else [(call.address, _address_of(arguments)) for call, arguments in fill.calls]
        fills = table.add_pairs(draws)
        jump = -1 if fill is None else table.add(_address_of(fill.jump))
        first, late = (
            table.add_pairs([(loop.call.address, 0) for loop in loops]) for loops in (parts.first, parts.late)
        )
        filters = [table.add(_address_of(self._memory.of(node, self._chunk))) for node in self._rejecting.values()]
        survivors, trials, counts = (table.add(_address_of(a)) for a in (self._survivors, self._trials, self._counts))
        lists = []
        for begin, loops, wrong in zip((first, late), (parts.first, parts.late), self._wrong, strict=True):
            for number, loop in enumerate(loops):
                nodes = [*(load.operand.node for load in loop.loads), *loop.stores]
                lists.append((begin + 2 * number + 2, self._add_list(table, nodes, wrong, loop.numbers)))
        gathered = [node for node in self._column if node not in self._of_kept]
        self._listed = trials
        self._gathers = gathers = table.add(len(gathered))
        for node in gathered:
            self._add_address(table, node)
            self._add_forecast_address(table, node)
        for name in self._names:
            self._add_draw_address(table, name)
            self._draw_targets[name] = table.add(_address_of(self._block_memory.draws[name]))
        self._table = np.array(table.words, np.uint64)
        self._words = self._table.copy()
        self._address = _address_of(self._words)
        for at, begin in lists:
            self._table[at] = self._address + 8 * begin
        drawn = sorted(table.draws)
        self._slots = np.array(drawn, np.intp)
        row_of = {name: row for row, name in enumerate(self._names)}
        self._slot_rows = np.array([row_of[table.draws[slot]] for slot in drawn], np.intp)
        by_chunk = () if fill is not None else tuple(drawn)
        self._run = compile_kernel(
            machine(),
            Layout(
                *(self._chunk, fills, first, late, jump, tuple(filters)),
                *(by_chunk, tuple(table.by_accepted), survivors, trials, counts, gathers),
            ),
        )

    def _add_list(self, table: _TableWriter, nodes: Iterable[int], wrong: NDArray[np.uint8], numbers: Floats) -> int:
        """Add the addresses that a loop takes; give the position where they begin."""
        begin = len(table.words)
        for node in nodes:
            self._add_address(table, node)
        table.add(_address_of(self._survivors), _address_of(wrong), _address_of(numbers))
        return begin

    def _add_address(self, table: _TableWriter, node_id: int) -> None:
        """Add the address of a node's array."""
        node = self._parts.dag.nodes[node_id]
        if isinstance(node, Input):
            self._add_draw_address(table, node.name)
        elif node_id in self._column and node_id in self._of_kept:
            table.by_accepted.append(self._add_forecast_address(table, node_id))
        else:
            table.add(_address_of(self._memory.of(node_id, self._chunk)))

    def _add_forecast_address(self, table: _TableWriter, node: int) -> int:
        """Add the address that a forecast is written to; give its position."""
        number = self._column[node]
        at = table.add(_address_of(self._block_memory.forecasts[number]))
        self._forecast_targets.append((at, number))
        return at

    def _add_draw_address(self, table: _TableWriter, name: str) -> None:
        table.draws[table.add(_address_of(self._rows[name]))] = name


class _TableWriter:
    """The argument table while it is written.

    Attributes:
        draws: position -> the assumption whose draws are there.
        by_accepted: positions of results that are written one after another.
    """

    def __init__(self) -> None:
        self.words: list[int] = []
        self.draws: dict[int, str] = {}
        self.by_accepted: list[int] = []

    def add(self, *words: int) -> int:
        """Add words; give the position where they begin."""
        self.words += words
        return len(self.words) - len(words)

    def add_pairs(self, pairs: Sequence[tuple[int, int]]) -> int:
        """Add how many pairs there are, and their words; give the position where this begins."""
        return self.add(len(pairs), *chain.from_iterable(pairs))


def _aligned_rows(k: int, n: int) -> Floats:
    """Make an array `(k, n)`, whose rows begin with lines of the cache where n is a multiple of 8.

    A vector of AVX-512 is a line long: to read one that lies in two lines takes twice as long.
    """
    return aligned_array(k * n, np.dtype(np.float64)).reshape(k, n)


def _address_of(array: Any) -> int:
    """Return the address of an array, NumPy's or of ctypes."""
    if isinstance(array, ctypes.Array):
        return ctypes.addressof(array)
    if array.size and array.flags.writeable:  # NumPy's own way takes five times as long
        return ctypes.addressof(ctypes.c_char.from_buffer(array))
    address: int = array.__array_interface__["data"][0]
    return address
