"""The call for a whole block, on tables written by hand: filters, counts, lists of survivors, columns and failures."""

from __future__ import annotations

import ctypes

import numpy as np
import pytest

pytest.importorskip("llvmlite")

from xlmc.engine.llvm.block_kernel import WORD, Layout, compile_kernel
from xlmc.engine.llvm.machine import machine
from xlmc.engine.llvm.uniforms import jump

CHUNK = 2 * WORD
GENERATOR = np.random.default_rng(8)
LOOP = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.POINTER(ctypes.c_void_p), ctypes.c_int64)


class Table:
    """The words of a table; `add` gives the position of what it adds."""

    def __init__(self):
        self.words, self.kept = [], []

    def add(self, *items):
        position = len(self.words)
        for item in items:
            if isinstance(item, np.ndarray):
                self.kept.append(item)
                item = item.ctypes.data
            self.words.append(item)
        return position

    def loops(self, *functions):
        """Loops that take the table's own pointer and the number of trials."""
        made = [LOOP(each) for each in functions]
        self.kept += made
        addresses = [ctypes.cast(each, ctypes.c_void_p).value for each in made]
        return self.add(len(made), *(word for address in addresses for word in (address, 0)))


def run(table, layout, chunks):
    words = np.array(table.words, np.int64)
    return compile_kernel(machine(), layout)(words.ctypes.data, chunks), words


def answers(passed):
    """The truth values of a filter, a chunk of them at the start of as many doubles, for it moves on by doubles."""
    chunks = passed.reshape(-1, CHUNK)
    laid = np.zeros((len(chunks), 8 * CHUNK), np.uint8)
    laid[:, :CHUNK] = chunks
    return laid


def passing(kind, chunks):
    n = chunks * CHUNK
    return {
        "all": np.ones(n, bool), "none": np.zeros(n, bool), "half": GENERATOR.random(n) < 0.5,
        "few": GENERATOR.random(n) < 0.02, "one word": np.arange(n) % CHUNK >= WORD,
        "ends": np.isin(np.arange(n) % WORD, [0, WORD - 1]),
    }[kind]  # fmt: skip


@pytest.mark.parametrize("chunks", [1, 3])
@pytest.mark.parametrize(
    "kinds", [("all",), ("none",), ("half",), ("one word",), ("ends",), ("half", "half"), ("half", "few", "all"),
              ("one word", "half", "ends")],
)  # fmt: skip
def test_survivors_counts_and_columns(kinds, chunks):
    """Rejections of each pair of filters, of each alone, and the columns of those that pass them all."""
    n, k = chunks * CHUNK, len(kinds)
    passed = [passing(kind, chunks) for kind in kinds]
    survivors, trials = np.full(CHUNK, -1, np.int64), np.full(n, -1, np.int64)
    counts = np.zeros(k * (k + 1) // 2 + k, np.int64)
    sources = [GENERATOR.random(n), GENERATOR.random(n)]
    targets = [np.zeros(n), np.zeros(n)]
    table = Table()
    none = table.add(0)
    filters = tuple(table.add(answers(each)) for each in passed)
    gathers = table.add(2, sources[0], targets[0], sources[1], targets[1])
    layout = Layout(
        CHUNK, none, none, none, -1, filters, (*filters, gathers + 1, gathers + 3), (), table.add(survivors),
        table.add(trials), table.add(counts), gathers,
    )  # fmt: skip
    kept, _ = run(table, layout, chunks)
    together = np.logical_and.reduce(passed)
    expected = np.flatnonzero(together)
    assert kept == expected.size
    assert trials[:kept].tolist() == expected.tolist()
    for source, target in zip(sources, targets, strict=True):
        assert target[:kept].tolist() == source[expected].tolist()
        assert not target[kept:].any()
    lost = [~each for each in passed]
    pairs = [(lost[i] & lost[j]).sum() for i in range(k) for j in range(i + 1)]
    times = np.sum(lost, axis=0)
    assert counts.tolist() == [*pairs, *((each & (times == 1)).sum() for each in lost)]


def test_loops_of_all_trials_and_of_survivors():
    """Each is called once a chunk: those that draw and that filter for all of it, the last for the survivors."""
    called = []

    def noting(name, wrong=0):
        def loop(_, n):
            called.append((name, n))
            return wrong

        return loop

    passed = np.arange(2 * CHUNK) % 3 == 0
    table = Table()
    fills = table.loops(noting("fill"))
    first = table.loops(noting("first"), noting("second"))
    late = table.loops(noting("late"))
    filters = (table.add(answers(passed)),)
    layout = Layout(
        CHUNK, fills, first, late, -1, filters, filters, (), table.add(np.zeros(CHUNK, np.int64)),
        table.add(np.zeros(2 * CHUNK, np.int64)), table.add(np.zeros(2, np.int64)), table.add(0),
    )  # fmt: skip
    kept, _ = run(table, layout, 2)
    each = [int(passed[:CHUNK].sum()), int(passed[CHUNK:].sum())]
    assert kept == sum(each)
    chunk = [("fill", CHUNK), ("first", CHUNK), ("second", CHUNK)]
    assert called == [*chunk, ("late", each[0]), *chunk, ("late", each[1])]


@pytest.mark.parametrize("at", ["first", "late"])
def test_a_trial_that_must_be_computed_again_ends_it(at):
    """In the second of three chunks; what the loops that draw give is no such number."""
    called = []

    def failing(_, n):
        called.append(n)
        return int(len(called) == 2)

    table = Table()
    fills, fine, failing_ = table.loops(lambda _, n: 5), table.loops(lambda _, n: 0), table.loops(failing)
    first, late = (failing_, fine) if at == "first" else (fine, failing_)
    whole = table.add(np.arange(CHUNK))
    layout = Layout(CHUNK, fills, first, late, -1, (), (), (), whole, 0, 0, table.add(0))
    assert run(table, layout, 3)[0] == -1
    assert called == [CHUNK, CHUNK]


def test_without_filters_all_are_kept():
    source, target = GENERATOR.random(3 * CHUNK), np.zeros(3 * CHUNK)
    table = Table()
    none, gathers = table.add(0), table.add(1, source, target)
    layout = Layout(CHUNK, none, none, none, -1, (), (gathers + 1,), (), table.add(np.arange(CHUNK)), 0, 0, gathers)
    assert run(table, layout, 3)[0] == 3 * CHUNK
    assert target.tolist() == source.tolist()


def test_addresses_move_on():
    """By a chunk of doubles, by the doubles of the trials kept, and the jump of the draws to the next chunk's first."""
    passed = np.arange(3 * CHUNK) % 4 == 0
    state = np.array([1, 0, 0, 0], np.uint64)
    table = Table()
    none, filters = table.add(0), (table.add(answers(passed)),)
    by_chunk, by_accepted = table.add(1000), table.add(5000)
    layout = Layout(
        CHUNK, none, none, none, table.add(state), filters, (*filters, by_chunk), (by_accepted,),
        table.add(np.zeros(CHUNK, np.int64)), table.add(np.zeros(3 * CHUNK, np.int64)),
        table.add(np.zeros(2, np.int64)), table.add(0),
    )  # fmt: skip
    kept, words = run(table, layout, 3)
    assert words[by_chunk] == 1000 + 3 * 8 * CHUNK
    assert words[by_accepted] == 5000 + 8 * kept
    halves = [int(low) | int(high) << 64 for low, high in state.reshape(2, 2)]
    assert tuple(halves) == jump(3 * CHUNK)
