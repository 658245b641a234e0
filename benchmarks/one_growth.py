"""One engine on one book, in this process: the task as JSON on stdin, seconds as JSON on stdout.

Measured apart: reading the workbook, making the program, the first block (with `jit`, compiling), and after these the
cost of a trial; or, for given numbers of trials, whole runs.
"""

from __future__ import annotations

import json
import sys
from time import perf_counter
from typing import Any

from contest import measured

import xlmc
from xlmc.engine.engines import ENGINES
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.simulation.simulate import BLOCK, run_model


def main() -> None:
    """Load, make the program, run."""
    given = json.loads(sys.stdin.readline())
    engine = given["engine"]
    assert engine in ENGINES
    start = perf_counter()
    model = load(given["path"])
    result: dict[str, Any] = {"version": xlmc.__version__, "loading": perf_counter() - start}
    start = perf_counter()
    program = model.program(engine)
    result["program"] = perf_counter() - start
    block = min(BLOCK, program.largest_block)

    def run(trials: int) -> None:
        run_model(model, RunOptions.of(trials=trials, seed=1, engine=engine))

    start = perf_counter()
    run(block)
    result["first"] = perf_counter() - start
    if given["trials"]:
        result["runs"] = [_shortest(run, trials) for trials in given["trials"]]
    else:
        rate, result["trials"] = measured(run, block, given["seconds"])
        result["a trial"] = 1 / rate
        result["block"] = block
    print(json.dumps(result), flush=True)


def _shortest(run: Any, trials: int) -> float:
    """Seconds of a run: the shortest of up to five in a second."""
    spent: list[float] = []
    while len(spent) < 5 and sum(spent) < 1:
        start = perf_counter()
        run(trials)
        spent.append(perf_counter() - start)
    return min(spent)


if __name__ == "__main__":
    main()
