"""Hostile input for xlmc: broken workbooks, spliced formulas, odd tables, edited runs.

`python benchmarks/fuzz.py --minutes 10` gives each of ten kinds of input its share of ten minutes and prints what
was found; `--kind formulas --seed 7 --only 1234` repeats one input, and shows it. Every input is a function of kind,
seed and number. Each runs in a child process that may take 30 s of processor time and 1 GB.
"""

from __future__ import annotations

import os

for _library in ("OPENBLAS", "OMP", "MKL"):  # a thread each would take address space, which is limited
    os.environ.setdefault(f"{_library}_NUM_THREADS", "1")

os.environ["RUST_BACKTRACE"] = "0"  # where python-calamine fails: a backtrace takes a second

import argparse
import itertools
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE)]

from fuzzing import KINDS, warm_up
from fuzzing.campaign import HEADINGS, Summary, campaign
from fuzzing.child import Outcome
from fuzzing.inputs import generator


def main() -> None:
    """Run campaigns; exit code 1 where they found something."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--minutes", type=float, default=1.0, help="of all kinds together")
    parser.add_argument("--inputs", type=int, help="of each kind; by default as many as the time allows")
    parser.add_argument("--kind", choices=KINDS, action="append", help="may be given again; by default all")
    parser.add_argument("--seed", type=int, default=999)
    parser.add_argument("--only", type=int, metavar="K", help="the input of that number alone")
    parser.add_argument("--jobs", type=int, default=1, help="kinds at a time")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="save the first input of every finding there")
    given = parser.parse_args()
    warm_up()
    kinds = given.kind or list(KINDS)
    minutes = given.minutes * min(given.jobs, len(kinds)) / len(kinds)
    print(HEADINGS, flush=True)
    with ThreadPoolExecutor(given.jobs) as pool:
        summaries = list(pool.map(lambda kind: _campaign(kind, given, 60 * minutes), kinds))
    for summary in summaries:
        _show(summary, given.seed)
    sys.exit(any(summary.faults for summary in summaries))


def _campaign(kind: str, given: argparse.Namespace, seconds: float) -> Summary:
    numbers = itertools.count() if given.inputs is None else range(given.inputs)
    KINDS[kind].make(generator(kind, given.seed, 0))  # what this reads and keeps, every child has then
    until = time.monotonic() + seconds
    if given.only is not None:
        numbers, until = [given.only], float("inf")
        made = KINDS[kind].make(generator(kind, given.seed, given.only))
        print(f"{kind} {given.seed}/{given.only}: {made.said}  {' '.join(made.steps)}")
        if given.keep:
            _keep(given.keep / f"{kind}-{given.seed}-{given.only}-{made.name}", made.data)
    seen: set[str] = set()

    def result(outcome: Outcome) -> None:
        if outcome.finding is not None and outcome.finding.key not in seen:
            seen.add(outcome.finding.key)
            print(f"{kind} {given.seed}/{outcome.number}: {outcome.finding.key}", flush=True)
            if given.keep:
                _keep(given.keep / f"{kind}-{given.seed}-{outcome.number}-{outcome.name}", outcome.data)

    summary = campaign(kind, KINDS[kind], given.seed, numbers, until, result)
    print(summary.line(), flush=True)
    return summary


def _keep(path: Path, data: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)


def _show(summary: Summary, seed: int) -> None:
    for key, result in sorted(summary.faults.items(), key=lambda each: -each[1].count):
        first = result.first
        print(f"\n{summary.kind}: {key}, {result.count:,} times")
        print(f"    --kind {summary.kind} --seed {seed} --only {first.number}")
        print(f"    {first.said[:400]}")
        if first.finding is not None:
            print("    " + first.finding.detail.replace("\n", "\n    "))


if __name__ == "__main__":
    main()
