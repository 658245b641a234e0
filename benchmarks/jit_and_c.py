"""What a trial costs the engine `jit` and the same model in C, in processor time: `python benchmarks/jit_and_c.py`.

Both run in turn, each round in processes of their own, so that the measurement may share a machine; the least of seven
runs of a process counts. It prints the medians over rounds, and that of the ratios in the same round.

`perf record -D 6000 python benchmarks/jit_and_c.py --profile case` records seconds of one book in the engine alone.
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
from typing import Final

TRIALS: Final = 1 << 22
RUNS: Final = 7
ROOT: Final = Path(__file__).resolve().parents[1]
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
    found = []
    for _ in range(RUNS):
        start = time.process_time()
        run()
        found.append(time.process_time() - start)
    return min(found) / TRIALS * 1e9


def main() -> None:
    """Measure both, or repeat one for a profiler."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
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
            rounds = [[_process(way, book, made) for way in WAYS] for _ in range(chosen.rounds)]
            times = [median(column) for column in zip(*rounds, strict=True)]
            costs = ", ".join(f"{way} {each:.2f} ns" for way, each in zip(WAYS, times, strict=True))
            print(f"{book}: {costs}; jit has {median(c / jit for jit, c in rounds):.2f} of C's speed")


def _process(way: str, book: str, folder: str) -> float:
    command = [sys.executable, __file__, "--one", way, book, folder]
    return float(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


if __name__ == "__main__":
    main()
