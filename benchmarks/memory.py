"""Peak memory and cost per trial of long runs of the case study, each in a fresh process.

`python benchmarks/memory.py [TRIALS …]`, by default 10⁷ and 10⁸. Flat memory and a ratio of 1 are the aim: what a run
keeps of a trial, and what it costs, must not depend on how many there are.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

HERE = Path(__file__).resolve().parent
CASE_STUDY = HERE.parent / "examples" / "intersection.xlsx"
TRIALS = (10_000_000, 100_000_000)
ROUNDS = 3


def measure(
    trials: Sequence[int] = TRIALS, engine: str = "numpy", jobs: int = 1, rounds: int = ROUNDS
) -> dict[str, Any]:
    """Runs in processes of their own, in turn: the medians over the rounds.

    Shorter runs are repeated until they are as many trials as the longest, so that what else the machine does slows all
    alike. The ratios are of the longest to the shortest, that of costs the median of those in the same round.
    """
    result = [[_measured(count, max(trials) // count, engine, jobs) for count in trials] for _ in range(rounds)]
    costs = [round_[-1]["seconds"] / round_[0]["seconds"] * trials[0] / trials[-1] for round_ in result]
    runs = [
        runs_of[0] | {key: statistics.median(run[key] for run in runs_of) for key in ("seconds", "before", "peak")}
        for runs_of in zip(*result, strict=True)
    ]
    memory = runs[-1]["peak"] / runs[0]["peak"]
    return {
        "engine": engine,
        "jobs": jobs,
        "rounds": rounds,
        "runs": runs,
        "cost": statistics.median(costs),
        "memory": memory,
    }


def _measured(trials: int, times: int, engine: str, jobs: int) -> dict[str, Any]:
    """See `one`."""
    command = [sys.executable, __file__, "--engine", engine, "--jobs", str(jobs), "--times", str(times), "--only"]
    paths = os.pathsep.join(filter(None, (str(HERE.parent), os.environ.get("PYTHONPATH"))))
    environment = {**os.environ, "PYTHONPATH": paths}
    done = subprocess.run([*command, str(trials)], check=True, capture_output=True, text=True, env=environment)
    result: dict[str, Any] = json.loads(done.stdout)
    return result


def one(trials: int, times: int, engine: str, jobs: int) -> dict[str, Any]:
    """Runs in this process: the seconds of each, and the peak resident memory in bytes before and after them."""
    import xlmc

    model = xlmc.load(CASE_STUDY)
    model.simulate(200_000, 1, engine=engine, jobs=jobs)
    before, start = _peak(), perf_counter()
    for _ in range(times):
        accepted = model.simulate(trials, 1, engine=engine, jobs=jobs).accepted
    seconds = (perf_counter() - start) / times
    return {"trials": trials, "accepted": accepted, "seconds": seconds, "before": before, "peak": _peak()}


def _peak() -> int:
    """The most memory that this process has held at once, bytes: Linux counts kilobytes, macOS bytes."""
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description="Peak memory and cost per trial of long runs of the case study.")
    parser.add_argument("trials", nargs="*", type=int, default=list(TRIALS))
    parser.add_argument("--engine", default="numpy")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", type=int, help="make runs of so many trials in this process and print what they took")
    parser.add_argument("--times", type=int, default=1, help="how many of them")
    chosen = parser.parse_args()
    if chosen.only:
        print(json.dumps(one(chosen.only, chosen.times, chosen.engine, chosen.jobs)))
        return
    result = measure(chosen.trials, chosen.engine, chosen.jobs)
    print(f"{'trials':>13}{'accepted':>12}{'seconds':>10}{'ns a trial':>12}{'peak memory, MB':>17}{'loaded, MB':>12}")
    for run in result["runs"]:
        cost, peak, before = 1e9 * run["seconds"] / run["trials"], run["peak"] / 1e6, run["before"] / 1e6
        print(
            f"{run['trials']:>13,}{run['accepted']:>12,}{run['seconds']:>10.2f}{cost:>12.1f}{peak:>17.0f}{before:>12.0f}"
        )
    print(f"cost of a trial, longest over shortest run: {result['cost']:.3f}; peak memory: {result['memory']:.2f}")


if __name__ == "__main__":
    main()
