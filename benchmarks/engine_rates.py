"""What a trial costs in the engines `numpy` and `jit` on every committed book and every benchmark book, side by side.

    python benchmarks/engine_rates.py [--books NAME ...] [--seconds 2] [--quick]

The benchmark's own books are called `benchmark skid` and so on. Each book has a process of its own, in which the
engines run in turn, the same number of trials each time, and keep what `model.simulate` keeps. The ratio is the median
of those of neighbouring runs, of processor time, so that other work on the machine slows both alike. The last column is
the rounds in which `jit` was the faster. Compiling is not in it.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any, NamedTuple

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parent / "tests" / "session")]

import books
from committed_books import BOOKS as COMMITTED

__all__ = ["Rates", "main", "measured", "paths"]

ENGINES = ("numpy", "jit")
ROUNDS = 9
FEWEST, MOST = 1 << 14, 1 << 22
"""Trials of a run: in fewer, seeding the streams and making what evaluates them would count."""

MADE = {f"benchmark {name}": name for name in books.BOOKS}
"""Name here of a benchmark's own book -> its name in `books`."""


class Rates(NamedTuple):
    """Nanoseconds of processor time that a trial costs, medians; and jit's speed as a multiple of numpy's, by round."""

    numpy: float
    jit: float
    ratios: tuple[float, ...]

    def line(self, name: str) -> str:
        """A row of the table."""
        ratio, faster = statistics.median(self.ratios), sum(r >= 1 for r in self.ratios)
        return f"| {name} | {self.numpy:,.1f} | {self.jit:,.1f} | {ratio:.2f} | {faster} of {len(self.ratios)} |"


def paths(folder: Path, names: Sequence[str] = ()) -> dict[str, Path]:
    """The books asked for, all by default: name -> path; `folder` holds those that are made."""
    asked = names or [*COMMITTED, *MADE]
    made = books.make_books(folder, [MADE[name] for name in asked if name in MADE])
    return {name: made[MADE[name]] if name in MADE else COMMITTED[name] for name in asked}


def measured(path: Path, seconds: float, rounds: int) -> Rates:
    """The rates of a book; `seconds` is what all runs of an engine take, about."""
    import xlmc

    model = xlmc.load(path)
    trials = FEWEST
    for engine in ENGINES:
        _spent(model, engine, trials)
    while trials < MOST and max(_spent(model, engine, trials) for engine in ENGINES) < seconds / rounds / 2:
        trials *= 2
    spent: dict[str, list[float]] = {engine: [] for engine in ENGINES}
    for number in range(rounds):
        for engine in ENGINES if number % 2 else reversed(ENGINES):
            spent[engine].append(_spent(model, engine, trials))
    ratios = tuple(by_numpy / by_jit for by_numpy, by_jit in zip(*spent.values(), strict=True))
    return Rates(*(1e9 * statistics.median(result) / trials for result in spent.values()), ratios)


def _spent(model: Any, engine: str, trials: int) -> float:
    start = time.process_time()
    model.simulate(trials, 1, engine=engine)
    return time.process_time() - start


def main(given: Sequence[str] | None = None) -> None:
    """Measure, and print a line a book."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--books", nargs="+", default=(), metavar="NAME", help="all by default")
    parser.add_argument("--seconds", type=float, default=2.0, help="of all runs of an engine on a book, about")
    parser.add_argument("--quick", action="store_true", help="show that it runs")
    chosen = parser.parse_args(given)
    seconds, rounds = (0.05, 1) if chosen.quick else (chosen.seconds, ROUNDS)
    print("| book | numpy, ns a trial | jit, ns a trial | jit's speed / numpy's | jit faster, rounds |")
    print("| --- | ---: | ---: | ---: | ---: |", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for name, path in paths(Path(folder), chosen.books).items():
            with ProcessPoolExecutor(1, get_context("spawn")) as pool:
                print(pool.submit(measured, path, seconds, rounds).result().line(name), flush=True)


if __name__ == "__main__":
    main()
