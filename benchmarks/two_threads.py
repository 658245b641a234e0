"""What a block of the case study costs with the engine `jit`, and what a second thread brings.

    python benchmarks/two_threads.py [ROUNDS]

Prints processor time per trial with one thread; of it, per block, the time outside of native code, in which no other
thread can run Python; and the ratio of trials per second with two threads to one, for bare threads and for `simulate`.
The fastest of many short rounds counts, one and two threads in turn: other work on the machine only ever slows.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from xlmc.blocks import Task, Worker
from xlmc.compile.jit.machine import NativeLoop
from xlmc.model import Model, load
from xlmc.scheduling.recipe import worker_of
from xlmc.simulate import BLOCK

BOOK = Path(__file__).parents[1] / "examples" / "intersection.xlsx"
BLOCKS = 24
TRIALS = 4_000_000


def main(rounds: int) -> None:
    model = load(BOOK)
    program = model.program("jit")
    workers = [worker_of(model, program, "jit", 999, BLOCK) for _ in range(2)]
    processor = _least(rounds, lambda: _run(workers[0]), time.thread_time)
    python = _least(rounds, lambda: _run(workers[0]), _PythonTime())
    print(f"processor time: {processor / BLOCKS / BLOCK * 1e9:.1f} ns a trial")
    outside, whole = ((seconds / BLOCKS * 1e6) for seconds in (python, processor))
    print(f"outside of native code: {outside:.0f} of {whole:.0f} µs a block")
    with ThreadPoolExecutor(2) as pool:
        one, two = _in_turn(rounds, lambda: _run(workers[0]), lambda: [*pool.map(_run, workers)])
    print(f"bare threads: {2 * one / two:.2f} ×")
    one, two = _in_turn(rounds, lambda: _simulate(model, 1), lambda: _simulate(model, 2))
    print(f"simulate, {TRIALS:,} trials: {one / two:.2f} × ({TRIALS / one:,.0f} and {TRIALS / two:,.0f} trials/s)")


class _PythonTime:
    """A clock of this thread that stands still in native code."""

    def __init__(self) -> None:
        self._native, call = 0.0, NativeLoop.__call__

        def timed(loop: NativeLoop, addresses: object, n: int) -> int:
            before = time.thread_time()
            found = call(loop, addresses, n)
            self._native += time.thread_time() - before
            return found

        self._timed, self._call = timed, call

    def __call__(self) -> float:
        """The time so far; it runs between every second reading and the next."""
        # A method is put in place of another, which is how to time it without a line in the engine.
        NativeLoop.__call__ = self._call if NativeLoop.__call__ is self._timed else self._timed  # type: ignore[method-assign]
        return time.thread_time() - self._native


def _run(worker: Worker) -> None:
    for block in range(10, 10 + BLOCKS):
        worker.run(Task(block * BLOCK, BLOCK, False))


def _simulate(model: Model, jobs: int) -> None:
    model.simulate(TRIALS, 1, engine="jit", jobs=jobs, scheduler="threads")


def _least(rounds: int, do: Callable[[], object], clock: Callable[[], float]) -> float:
    taken = []
    for _ in range(rounds):
        before = clock()
        do()
        taken.append(clock() - before)
    return min(taken)


def _in_turn(rounds: int, first: Callable[[], object], second: Callable[[], object]) -> tuple[float, float]:
    """The least seconds of each."""
    times = [[_least(1, do, time.perf_counter) for do in (first, second)] for _ in range(rounds)]
    one, two = (min(column) for column in zip(*times, strict=True))
    return one, two


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 15)
