"""Do 95 % intervals of the variance explained hold the truth where a forecast jumps, bends or oscillates?

`python benchmarks/share_coverage.py` makes 100 seeded runs of each problem and number of trials, and writes
`results/share-coverage.json` and the table of docs/sensitivity.md. A run looks at 8,192 trials first, as xlmc does for
up to 128 pairs of an assumption and a forecast, and at more where that asks for it. No figure depends on the machine.

The bar: no interval holds the truth in fewer than 92 % of the runs, by more than chance allows at a family-wise level
of 1 %, unless the words "at least" stand in for it and their lower end holds; of smooth forecasts the words stand in at
most 5 %, and the median interval is at most 1.3 times that of 16 classes.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.special import bdtr
from share_problems import PROBLEMS, Problem
from tables import placed

from xlmc.analysis.studies.sensitivity.explained import Explained, explained
from xlmc.analysis.studies.sensitivity.given_data import explained_share
from xlmc.analysis.studies.sensitivity.pull_errors import Units
from xlmc.analysis.studies.sensitivity.ranked import Ranked

__all__ = ["Cell", "faults", "measure", "table"]

HERE = Path(__file__).resolve().parent
PAGE = HERE.parent / "docs" / "sensitivity.md"
RESULTS = HERE / "results" / "share-coverage.json"

RUNS = 100
TRIALS = (3_500, 32_768)
FIRST = 1 << 13
LEAST, SELDOM, LONGEST, FAMILY = 0.92, 0.05, 1.3, 0.01


class Cell(NamedTuple):
    """What came of the runs of one problem with one number of accepted trials.

    Attributes:
        hits: runs whose interval held the truth.
        bounded: runs whose interval held it, or that said "at least" and whose lower end was below it.
        told: runs that said "at least".
        before: runs in which the interval of 16 classes held it.
        width: the median interval over that of 16 classes.
    """

    problem: str
    trials: int
    runs: int
    truth: float
    mean: float
    hits: int
    bounded: int
    told: int
    before: int
    width: float


class Run(NamedTuple):
    """One run: its number now, and the interval of 16 classes."""

    now: Explained
    before: tuple[float, float]

    @property
    def interval(self) -> tuple[float, float]:
        assert self.now.share.interval is not None, "there are many trials"
        return self.now.share.interval


def one_run(problem: Problem, trials: int, seed: int) -> Run:
    """The share in so many accepted trials, from the first ones where they are enough."""
    a, b = np.random.default_rng(seed).random((2, 2 * trials))
    kept = np.flatnonzero(problem.keeps(a, b))[:trials]
    a, y = a[kept], problem.forecast(a[kept], b[kept])
    first = min(FIRST, trials)
    x, units = Ranked.of(a[:first]), Units.of(first)
    before, now = explained_share(x, y[:first], units), explained(x, y[:first], units)
    assert before.interval is not None, "there are many trials"
    if not now.coarse_enough and trials > first:
        now = explained(Ranked.of(a), y, Units.of(trials))
    return Run(now, before.interval)


def measure(name: str, trials: int, runs: int) -> Cell:
    """One problem with so many accepted trials, with the seeds from 0 on."""
    problem = PROBLEMS[name]
    truth = problem.truth
    result = [one_run(problem, trials, seed) for seed in range(runs)]
    holds = [_holds(each.interval, truth) for each in result]
    bounded = [each.now.at_least and each.interval[0] <= truth for each in result]
    width = np.median([each.interval[1] - each.interval[0] for each in result])
    before = np.median([each.before[1] - each.before[0] for each in result])
    return Cell(
        name,
        trials,
        runs,
        round(truth, 5),
        round(float(np.mean([each.now.share.value for each in result])), 5),
        sum(holds),
        sum(map(max, holds, bounded)),
        sum(each.now.at_least for each in result),
        sum(_holds(each.before, truth) for each in result),
        round(float(width / before), 3),
    )


def _holds(interval: tuple[float, float], truth: float) -> bool:
    return interval[0] - 1e-6 <= truth <= interval[1] + 1e-6


def faults(cells: Sequence[Cell]) -> list[str]:
    """What misses the bar."""
    level = FAMILY / len(cells)
    missed = []
    for cell in cells:
        where = f"{cell.problem}, {cell.trials:,} trials"
        if bdtr(cell.bounded, cell.runs, LEAST) < level:
            missed.append(f"{where}: held in {cell.bounded / cell.runs:.1%}")
        if PROBLEMS[cell.problem].smooth and bdtr(cell.runs - cell.told, cell.runs, 1.0 - SELDOM) < level:
            missed.append(f"{where}: words in {cell.told / cell.runs:.1%}")
        if PROBLEMS[cell.problem].smooth and cell.width > LONGEST:
            missed.append(f"{where}: {cell.width:.2f} times as long as of 16 classes")
    return missed


def table(cells: Sequence[Cell]) -> str:
    """Coverage in percent, as Markdown."""
    lines = ["| forecast | trials | truth | mean | held | held or “at least” | “at least” | 16 classes held | length |"]
    lines.append("|---|" + "---:|" * 8)
    for cell in cells:
        shares = (cell.hits, cell.bounded, cell.told, cell.before)
        shown = " | ".join(f"{100.0 * each / cell.runs:.1f}" for each in shares)
        numbers = f"{cell.truth:.4f} | {cell.mean:.4f} | {shown} | {cell.width:.2f}"
        lines.append(f"| {cell.problem} | {cell.trials:,} | {numbers} |")
    return "\n".join(lines)


def main() -> None:
    """Measure, write, and end with 1 where a cell misses the bar."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--results", type=Path, default=RESULTS)
    parser.add_argument("--page", type=Path, default=PAGE)
    given = parser.parse_args()
    cells = [measure(name, trials, given.runs) for name in PROBLEMS for trials in TRIALS]
    given.results.write_text(
        json.dumps({"cells": cells}, ensure_ascii=False).replace("[", "\n[") + "\n", encoding="utf-8"
    )
    text = given.page.read_text(encoding="utf-8")
    given.page.write_text(placed(text, "share-coverage", table(cells)), encoding="utf-8")
    missed = faults(cells)
    print("\n".join(missed) or "every cell meets the bar")
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
