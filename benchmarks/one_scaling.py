"""One engine with one job and with two, in turn, in this process: the task as JSON on stdin, seconds as JSON on stdout.

Beside them runs what the machine itself gives: this process and another one at once, each the same run with one job.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import IO, Any

from contest import measured

import xlmc
from xlmc.montecarlo.loop.scheduling.processes import idle_pool
from xlmc.montecarlo.simulation.simulate import BLOCK

ONE, TWO, ANEW, APART = "1", "2", "2 anew", "two programs"
MOST_TRIALS = 30_000_000
"""Somewhat above, accepted trials go to files, which is another measurement."""


def main() -> None:
    """Measure, or be the other process of one that measures."""
    given = json.loads(sys.stdin.readline())
    model = xlmc.load(given["path"])

    def run(trials: int, jobs: int = 1) -> None:
        model.simulate(trials, 1, engine=given["engine"], jobs=jobs)

    run(BLOCK)
    if given["other"]:
        for line in sys.stdin:
            run(int(line))
            _tell(sys.stdout, "done")
        return
    rate, _ = measured(run, BLOCK, given["seconds"])
    trials = BLOCK * max(1, round(min(MOST_TRIALS, rate * given["seconds"]) / BLOCK))
    other = _Other(given)
    ways: dict[str, Callable[[], None]] = {
        ONE: lambda: run(trials),
        TWO: lambda: run(trials, 2),
        APART: lambda: other.beside(run, trials),
    }
    if given["processes"]:
        ways[ANEW] = lambda: _anew(run, trials)
    seconds: dict[str, list[float]] = {way: [] for way in ways}
    for _ in range(given["turns"]):
        for way, do in ways.items():
            start = perf_counter()
            do()
            seconds[way].append(perf_counter() - start)
    other.end()
    _tell(sys.stdout, json.dumps({"trials": trials, "seconds": seconds}))


def _anew(run: Callable[[int, int], None], trials: int) -> None:
    """With a process that is started for this run."""
    idle_pool.end()
    run(trials, 2)


class _Other:
    """The other process."""

    def __init__(self, given: dict[str, Any]) -> None:
        command = [sys.executable, "-W", "ignore", str(Path(__file__).resolve())]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        assert self._process.stdin
        assert self._process.stdout
        self._in, self._out = self._process.stdin, self._process.stdout
        _tell(self._in, json.dumps(given | {"other": True}))
        _tell(self._in, str(BLOCK))
        self._wait()  # until it has loaded the book

    def _wait(self) -> None:
        if not self._out.readline():
            raise RuntimeError("the other process failed")

    def beside(self, run: Callable[[int], None], trials: int) -> None:
        """The same run here and there."""
        _tell(self._in, str(trials))
        run(trials)
        self._wait()

    def end(self) -> None:
        self._in.close()
        self._process.wait()
        self._out.close()


def _tell(pipe: IO[str], line: str) -> None:
    print(line, file=pipe, flush=True)


if __name__ == "__main__":
    main()
