"""What a trial costs the engine `jit` and the same model in C, in processor time: `python benchmarks/jit_and_c.py`.

Both run in turn, each round in processes of their own, so that the measurement may share a machine; the least of seven
runs of a process counts. It prints the medians over rounds, and that of the ratios in the same round.

`--parts` says instead where a trial's time goes. `perf record -D 6000 python benchmarks/jit_and_c.py --profile case`
records seconds of one book in the engine alone.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any, Final
from unittest.mock import patch

TRIALS: Final = 1 << 22
RUNS: Final = 7
ROOT: Final = Path(__file__).resolve().parents[1]
BLOCK: Final = 1 << 15
CHUNK: Final = {"case": 4096, "skid": 1024}
"""Trials at a time in C, the best of each book."""


def engine(book: str, folder: Path) -> Callable[[], object]:
    """Return a run of the engine."""
    from books import make_books

    import xlmc

    path = ROOT / "examples" / "intersection.xlsx" if book == "case" else make_books(folder, ["skid"])["skid"]
    model = xlmc.load(path)
    return lambda: model.simulate(TRIALS, 1, engine="jit")


def in_c(book: str, folder: Path) -> Callable[[], object]:
    """Return a run in C."""
    import hand_c
    import hand_written
    import hand_written_skid

    inputs, forecasts = (hand_written, 4) if book == "case" else (hand_written_skid, 1)
    library = folder / "hand.so"
    hand = hand_c.Hand(library if library.exists() else hand_c.build(folder), book, inputs.LOW, inputs.HIGH, forecasts)
    return lambda: hand.simulate(TRIALS, 1, CHUNK[book])


WAYS: Final = {"jit": engine, "C": in_c}


def least(run: Callable[[], object]) -> float:
    """Return the nanoseconds a trial takes."""
    run()
    result = []
    for _ in range(RUNS):
        start = time.process_time()
        run()
        result.append(time.process_time() - start)
    return min(result) / TRIALS * 1e9


def parts(book: str, folder: Path) -> str:
    """Say what draws cost, all other native code, and what is around it."""
    import numpy as np

    from xlmc.engine.llvm import uniforms
    from xlmc.engine.llvm.machine import NativeLoop

    call, given = NativeLoop.__call__, []
    native = 0.0

    def filler(streams: Any, maps: Any, rows: Any) -> Any:
        given.append((streams, maps))
        return uniforms.filler(streams, maps, rows)

    def timed(self: NativeLoop, addresses: Any, n: int) -> int:
        nonlocal native
        start = time.thread_time()
        result = call(self, addresses, n)
        native += time.thread_time() - start
        return result

    run, whole = engine(book, folder), []
    with patch("xlmc.engine.llvm.block_runner.filler", filler), patch.object(NativeLoop, "__call__", timed):
        run()
        for _ in range(RUNS):
            native, start = 0.0, time.process_time()
            run()
            whole.append((time.process_time() - start, native))
    rows = np.empty((len(given[0][0]), BLOCK))
    fill = uniforms.filler(*given[0], rows)
    drawn = []
    for _ in range(10 * RUNS):
        start = time.thread_time()
        fill(0)
        drawn.append(time.thread_time() - start)
    total, inside = (each / TRIALS * 1e9 for each in min(whole))
    draws = min(drawn) / BLOCK * 1e9
    return f"draws {draws:.1f} ns, rest of the native code {inside - draws:.1f}, what is around it {total - inside:.1f}"


def main() -> None:
    """Measure both, or the parts of a run, or repeat one for a profiler."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--parts", action="store_true", help="say where a trial's time goes in the engine")
    parser.add_argument("--profile", choices=CHUNK, help="run this book in the engine for 15 seconds")
    parser.add_argument("--one", nargs=3, metavar=("WAY", "BOOK", "FOLDER"), help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.one:
        way, book, folder = chosen.one
        print(least(WAYS[way](book, Path(folder))))
        return
    with tempfile.TemporaryDirectory() as made:
        if chosen.profile:
            run, start = engine(chosen.profile, Path(made)), time.monotonic()
            while time.monotonic() - start < 15.0:
                run()
            return
        for book in CHUNK:
            if chosen.parts:
                print(f"{book}: {parts(book, Path(made))}")
                continue
            rounds = [[_process(way, book, made) for way in WAYS] for _ in range(chosen.rounds)]
            times = [median(column) for column in zip(*rounds, strict=True)]
            costs = ", ".join(f"{way} {each:.2f} ns" for way, each in zip(WAYS, times, strict=True))
            print(f"{book}: {costs}; jit has {median(c / jit for jit, c in rounds):.2f} of C's speed")


def _process(way: str, book: str, folder: str) -> float:
    command = [sys.executable, __file__, "--one", way, book, folder]
    return float(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


if __name__ == "__main__":
    main()
