"""Peak memory and cost per trial of long runs of the case study, each in a fresh process.

`python benchmarks/memory.py [TRIALS …]`, by default 10⁷ and 10⁸. Flat memory and a ratio of 1 are the aim: what a run
keeps of a trial, and what it costs, must not depend on how many there are.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

HERE = Path(__file__).resolve().parent
CASE_STUDY = HERE.parent / "examples" / "intersection.xlsx"
TRIALS = (10_000_000, 100_000_000)


def measure(trials: Sequence[int] = TRIALS, engine: str = "numpy", jobs: int = 1) -> dict[str, Any]:
    """Every run in a process of its own; the ratio is of the longest's cost per trial to the shortest's."""
    command = [sys.executable, __file__, "--engine", engine, "--jobs", str(jobs), "--only"]
    paths = os.pathsep.join(filter(None, (str(HERE.parent), os.environ.get("PYTHONPATH"))))
    runs = []
    for count in trials:
        done = subprocess.run(
            [*command, str(count)], check=True, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": paths}
        )
        runs.append(json.loads(done.stdout))
    costs = [run["seconds"] / run["trials"] for run in runs]
    peaks = [run["peak"] for run in runs]
    return {"engine": engine, "jobs": jobs, "runs": runs, "cost": costs[-1] / costs[0], "memory": peaks[-1] / peaks[0]}


def one(trials: int, engine: str, jobs: int) -> dict[str, Any]:
    """One run in this process: seconds, and the peak resident memory in bytes before and after it."""
    import xlmc

    model = xlmc.load(CASE_STUDY)
    model.simulate(200_000, 1, engine=engine, jobs=jobs)
    before, start = _peak(), perf_counter()
    run = model.simulate(trials, 1, engine=engine, jobs=jobs)
    seconds = perf_counter() - start
    return {"trials": trials, "accepted": run.accepted, "seconds": seconds, "before": before, "peak": _peak()}


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
    parser.add_argument("--only", type=int, help="make this one run in this process and print what it took")
    chosen = parser.parse_args()
    if chosen.only:
        print(json.dumps(one(chosen.only, chosen.engine, chosen.jobs)))
        return
    found = measure(chosen.trials, chosen.engine, chosen.jobs)
    print(f"{'trials':>13}{'accepted':>12}{'seconds':>10}{'ns a trial':>12}{'peak memory, MB':>17}{'loaded, MB':>12}")
    for run in found["runs"]:
        cost, peak, before = 1e9 * run["seconds"] / run["trials"], run["peak"] / 1e6, run["before"] / 1e6
        print(
            f"{run['trials']:>13,}{run['accepted']:>12,}{run['seconds']:>10.2f}{cost:>12.1f}{peak:>17.0f}{before:>12.0f}"
        )
    print(f"cost of a trial, longest over shortest run: {found['cost']:.3f}; peak memory: {found['memory']:.2f}")


if __name__ == "__main__":
    main()
