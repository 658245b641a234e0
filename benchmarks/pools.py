"""xlmc's own processes against those of libraries, with `-j 2`: `python benchmarks/pools.py -o FILE.json`.

All ways share the blocks of a run alike: this process runs blocks too, and the other one is sent small batches. What
differs is who starts the other process, keeps it between runs and carries its answers: xlmc (`own`), loky's
`get_reusable_executor` (`loky`) or `concurrent.futures.ProcessPoolExecutor`, spawned (`futures`). `by_pool` is what
would stand in the place of `by_processes`; it does not end the other process with the run, nor hide Ctrl-C from it.

In a round, a fresh process for each case runs all ways in turn, several times: with the other process waiting (`warm`)
and with one started in the run (`anew`). The last case is whole programs: from the start of Python to its end, with
one run each. Speeds are compared within a turn, with one job and with `own`; loky must be installed.
"""

from __future__ import annotations

import argparse
import json
import pickle
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path
from statistics import quantiles
from time import perf_counter
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import machine
from books import make_books

ONE, OWN, LOKY, FUTURES = "one job", "own", "loky", "futures"
WAYS = (OWN, LOKY, FUTURES)
FIRST = ("case-study", "numpy", 4_194_304)
"""The shortest run that starts a process of itself."""

CASES = {
    "case-study, numpy": ("case-study", "numpy", 8_388_608),
    "skid, numpy": ("skid", "numpy", 16_777_216),
    "cells-1000, numpy": ("cells-1000", "numpy", 131_072),
    "case-study, formulas": ("case-study", "formulas", 128),
    "case-study, whole program": FIRST,
}
"""Book, engine, and as many trials as take one job one second or more."""


def by_pool(pool: Executor, portable: Any, own: Any, others: int, blocks: int, tasks: Iterable[Any]) -> Iterator[Any]:
    """The blocks in the order of their tasks."""
    from xlmc.errors import SimulationError
    from xlmc.montecarlo.loop.scheduling.batches import Answers, Sharing, Worker

    packed, answers = pickle.dumps(portable, protocol=5), Answers()

    class Remote(Worker):
        """Takes as many batches as one process; which process runs them is the pool's affair."""

        def _take(self, tasks: Any) -> None:
            pool.submit(run_there, packed, tasks).add_done_callback(self._tell)

        def _tell(self, future: Future[Any]) -> None:
            if future.cancelled():
                return
            error = future.exception()
            if isinstance(error, BrokenExecutor):
                error = SimulationError(f"a process ended before its time: {error}")
            answers.put((self, error or future.result()))

    remotes = [Remote() for _ in range(others)]
    for remote in remotes:
        remote._take([])
    yield from Sharing(own, remotes, answers, blocks, tasks).in_order()


_runners: dict[bytes, Any] = {}


def run_there(packed: bytes, tasks: Any) -> Any:
    """In the other process: the blocks, or None where there are no tasks but only a runner to be made."""
    from xlmc.montecarlo.loop.scheduling.batches import run_batch

    if packed not in _runners:
        _runners.clear()
        _runners[packed] = pickle.loads(packed).runner()
    return run_batch(_runners[packed], tasks) if tasks else None


class Pools:
    """The processes of all three ways, kept between runs."""

    def __init__(self) -> None:
        self._futures: Executor | None = None

    def choose(self, way: str) -> None:
        """Have the runs that follow use it."""
        from xlmc.montecarlo.loop.scheduling import worker_pool
        from xlmc.montecarlo.loop.scheduling.processes import by_processes

        worker_pool.by_processes = (
            by_processes if way == OWN else lambda *given: by_pool(self._pool(way, given[2]), *given)
        )

    def _pool(self, way: str, others: int) -> Executor:
        if way == LOKY:
            from loky import get_reusable_executor

            pool: Executor = get_reusable_executor(max_workers=others, timeout=60)
            return pool
        if self._futures is None:
            from concurrent.futures import ProcessPoolExecutor
            from multiprocessing import get_context

            self._futures = ProcessPoolExecutor(others, get_context("spawn"))
        return self._futures

    def end(self, way: str) -> None:
        """So that its next run starts a process."""
        if way == OWN:
            from xlmc.montecarlo.loop.scheduling.processes import idle_pool

            idle_pool.end()
        else:
            self._pool(way, 1).shutdown(wait=True)
            self._futures = None if way == FUTURES else self._futures


def first_in_line() -> None:
    """Where we may: have this session, and those of processes that it starts, go before all others.

    Linux shares processors between sessions first, so that one that has a session of its own gets more of a busy
    machine than one that has not, whatever their niceness: xlmc's processes have, and those of the libraries have not.
    """
    start = subprocess.Popen.__init__

    def hurry(pid: object) -> None:
        with suppress(OSError):
            Path(f"/proc/{pid}/autogroup").write_text("-15", encoding="ascii")

    def started(process: Any, *given: Any, **named: Any) -> None:
        start(process, *given, **named)
        hurry(process.pid)

    hurry("self")
    # xlmc starts its processes in sessions of their own, by Popen and nothing else; the libraries' stay in this one.
    subprocess.Popen.__init__ = started  # type: ignore[method-assign]


def in_turn(path: str, engine: str, trials: int, turns: int) -> dict[str, list[float]]:
    """Seconds of every way, in this process."""
    from xlmc.montecarlo.definitions.run_options import RunOptions
    from xlmc.montecarlo.model.loading import load
    from xlmc.montecarlo.simulation.simulate import run_model

    model, pools = load(path), Pools()

    def timed(way: str) -> float:
        pools.choose(way)
        settings = {"jobs": 1} if way == ONE else {"jobs": 2, "scheduler": "processes"}
        start = perf_counter()
        run = run_model(model, RunOptions.of(trials=trials, seed=1, engine=engine, **settings))
        taken = perf_counter() - start
        digests.add(b"".join(values.tobytes() for values in run.forecasts.values()))
        return taken

    digests: set[bytes] = set()
    for way in (ONE, *WAYS):
        timed(way)
    seconds: dict[str, list[float]] = {}
    for turn in range(turns):
        seconds.setdefault(ONE, []).append(timed(ONE))
        for way in WAYS[turn % 3 :] + WAYS[: turn % 3]:
            seconds.setdefault(f"{way}, warm", []).append(timed(way))
            pools.end(way)
            seconds.setdefault(f"{way}, anew", []).append(timed(way))
    for way in WAYS:
        pools.end(way)
    if len(digests) > 1:
        raise RuntimeError("the ways differ in their results")
    return seconds


def once(path: str, engine: str, trials: int, way: str) -> None:
    """One run; nothing is ended, as a program leaves it."""
    Pools().choose(way)
    import xlmc

    xlmc.load(path).simulate(trials, 1, engine=engine, jobs=2, scheduler="processes")


def program(*given: Any) -> dict[str, list[float]]:
    """A fresh process that does `in_turn` or `once`, and what it prints."""
    command = [sys.executable, str(Path(__file__).resolve()), "--child", json.dumps(given)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    if done.stderr:
        print(done.stderr, file=sys.stderr)
    answer: dict[str, list[float]] = json.loads(done.stdout or "{}")
    return answer


def measure(path: Path, case: Sequence[Any], turns: int) -> dict[str, list[float]]:
    """Seconds of every way, in a fresh process, or each in many."""
    if case != FIRST:
        return program("in_turn", str(path), *case[1:], turns)
    seconds: dict[str, list[float]] = {}
    for turn in range(turns):
        for way in WAYS[turn % 3 :] + WAYS[: turn % 3]:
            start = perf_counter()
            program("once", str(path), *case[1:], way)
            seconds.setdefault(way, []).append(perf_counter() - start)
    return seconds


def speeds(rounds: Sequence[dict[str, list[float]]]) -> dict[str, dict[str, list[float]]]:
    """Way -> base -> how many times as fast as the base in the same turn: quartiles over the turns of all rounds."""
    result: dict[str, dict[str, list[float]]] = {}
    for way in (each for each in rounds[0] if each not in (ONE, OWN)):
        bases = {"one job": ONE, "own": f"{OWN}{way[way.find(',') :]}" if "," in way else OWN}
        for name, base in bases.items():
            if base in rounds[0] and base != way:
                pairs = [pair for each in rounds for pair in zip(each[base], each[way], strict=True)]
                ratios = quantiles((there / here for there, here in pairs), n=4, method="inclusive")
                result.setdefault(way, {})[name] = [round(ratio, 2) for ratio in ratios]
    return result


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--turns", type=int, default=9)
    parser.add_argument("--cases", nargs="*", choices=list(CASES), default=list(CASES))
    parser.add_argument("-o", "--output", type=Path)
    parser.add_argument("--child", help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    first_in_line()
    if chosen.child:
        name, *given = json.loads(chosen.child)
        result = {"in_turn": in_turn, "once": once}[name](*given)
        if result:
            print(json.dumps(result))
        return
    seconds: dict[str, list[dict[str, list[float]]]] = {}
    with tempfile.TemporaryDirectory() as folder:
        paths = make_books(Path(folder), sorted({book for book, *_ in CASES.values()}))
        for round_ in range(chosen.rounds):
            for name in chosen.cases:
                case = CASES[name]
                seconds.setdefault(name, []).append(measure(paths[case[0]], case, chosen.turns))
                print(f"round {round_ + 1}, {name}: {speeds(seconds[name])}", flush=True)
                if chosen.output:
                    _write(chosen.output, seconds)


def _write(path: Path, seconds: dict[str, list[dict[str, list[float]]]]) -> None:
    described = machine.describe()
    described["packages"] |= {"loky": version("loky")}
    result = {name: {"speeds": speeds(rounds), "seconds": rounds} for name, rounds in seconds.items()}
    path.write_text(json.dumps({"machine": described, "found": result}, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    import pools  # by its name, under which another process finds `run_there`

    pools.main()
