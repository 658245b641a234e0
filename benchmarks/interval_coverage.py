"""Do 95 % intervals hold the truth 95 times in 100, whatever the sampling method, with and without filters?

`python benchmarks/interval_coverage.py` makes 4,000 seeded runs of each problem by each method, and writes
`results/coverage.json` and the table of docs/sampling.md. Samplers and statistics are xlmc's own; the problems are
functions of three uniforms whose answers are known to 1e-5 of a standard deviation. No figure depends on the machine.

The bar: no cell lies below 94 % by more than chance allows at a family-wise level of 1 %, and none above 98.5 %.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from problems import PROBLEMS, STATISTICS, Problem
from scipy.special import bdtr
from tables import placed

import xlmc.montecarlo.statistics as xs
from xlmc.montecarlo.sampling.sampling_methods import METHODS
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan

__all__ = ["RUNS", "Cell", "faults", "measure", "one_run", "table"]

HERE = Path(__file__).resolve().parent
PAGE = HERE.parent / "docs" / "sampling.md"
RESULTS = HERE / "results" / "coverage.json"

RUNS = 4_000
LEAST, MOST, FAMILY = 0.94, 0.985, 0.01


class Cell(NamedTuple):
    """How often the intervals of one problem and method held the truth.

    Attributes:
        hits: of the runs, by STATISTICS.
        accepted: the fewest accepted trials of a run.
        per_replicate: the fewest accepted trials of a replicate; None where trials are independent.
        replicates, trials: of a run.
    """

    problem: str
    method: str
    hits: tuple[int, ...]
    accepted: int
    per_replicate: int | None
    replicates: int
    trials: int


def one_run(problem: Problem, plan: SamplingPlan, seed: int) -> xs.Sample:
    """The accepted trials of a run, as xlmc would have them."""
    u = np.empty((3, plan.trials))
    for margin, row in zip(plan.margins(seed, ("a", "b", "c")), u, strict=True):
        margin.uniforms(0, row)
    kept = np.flatnonzero(problem.keeps(u))
    return xs.Sample.of(problem.forecast(u[:, kept]), None, plan.replicate_of(kept))


def estimates(sample: xs.Sample) -> list[xs.Estimate]:
    """By STATISTICS."""
    return [xs.mean(sample), xs.standard_deviation(sample), xs.median(sample), *xs.central_interval(sample)]


def measure(name: str, method: str, runs: int, first: int = 0) -> Cell:
    """One problem by one method, with the seeds from `first` on."""
    problem = PROBLEMS[name]
    plan, truth = SamplingPlan.of(method, problem.trials), problem.truth()
    hits, accepted, fewest = np.zeros(len(STATISTICS), int), [], []
    for seed in range(first, first + runs):
        sample = one_run(problem, plan, seed)
        ends = [each.interval or (math.nan, math.nan) for each in estimates(sample)]
        hits += [low <= true <= high for (low, high), true in zip(ends, truth, strict=True)]
        accepted.append(sample.n)
        if sample.group is not None:
            fewest.append(int(np.bincount(sample.group, minlength=min(plan.replicates, 64)).min()))
    count = min(fewest) if fewest else None
    return Cell(name, method, tuple(hits.tolist()), min(accepted), count, plan.replicates, plan.trials)


def faults(cells: Sequence[Cell], runs: int) -> list[str]:
    """The cells that miss the bar."""
    level = FAMILY / (len(cells) * len(STATISTICS))
    return [
        f"{cell.problem}, {cell.method}, {statistic}: {hits / runs:.2%}"
        for cell in cells
        for statistic, hits in zip(STATISTICS, cell.hits, strict=True)
        if bdtr(hits, runs, LEAST) < level or hits > MOST * runs
    ]


def table(result: Mapping[str, Any]) -> str:
    """Coverage in percent, as Markdown."""
    lines = ["| problem | sampling | trials | least accepted | " + " | ".join(STATISTICS) + " |"]
    lines += ["|---|---|---:|---:|" + "---:|" * len(STATISTICS)]
    for cell in (Cell(*each) for each in result["cells"]):
        shares = " | ".join(f"{100 * hits / result['runs']:.1f}" for hits in cell.hits)
        least = f"{cell.accepted:,}" + ("" if cell.per_replicate is None else f" ({cell.per_replicate:,})")
        lines.append(f"| {cell.problem} | {METHODS[cell.method].name} | {cell.trials:,} | {least} | {shares} |")
    return "\n".join(lines)


def main() -> None:
    """Measure, write, and end with 1 where a cell misses the bar."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--results", type=Path, default=RESULTS)
    parser.add_argument("--page", type=Path, default=PAGE)
    given = parser.parse_args()
    cells = []
    for name in PROBLEMS:
        for method in METHODS:
            cells.append(measure(name, method, given.runs))
            print(*cells[-1], flush=True)
    result = {"runs": given.runs, "statistics": STATISTICS, "cells": cells}
    given.results.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    given.page.write_text(placed(given.page.read_text(encoding="utf-8"), "coverage", table(result)), encoding="utf-8")
    missed = faults(cells, given.runs)
    print("\n".join(missed) or "every cell meets the bar")
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
