"""Where filters accept 1 trial in 10⁴ to 10⁷: do 95 % intervals hold the truth, and how many trials does that take?

`python benchmarks/rare_acceptance.py` finds 2,000 accepted trials 1,000 times in each of three problems with known
answers, compares methods on them, and writes `results/rare.json` and the tables of docs/rare-acceptance.md. With
`--case` it does the same, 300 trials at a time, with the paper's case study under narrowed filters, whose truth is a
long run of plain trials. No figure depends on the machine.

The bar: no cell lies below 93 % by more than chance allows at a family-wise level of 1 %; at 10⁻⁶ plain rejection
takes at least 50 times as many evaluations.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rare_problems import PROBLEMS, STATISTICS
from scipy.special import bdtr, ndtr, ndtri
from tables import placed

import xlmc
import xlmc.statistics as xs
from xlmc.model import Model
from xlmc.rare.finding import Found, find
from xlmc.rare.landscape import Landscape
from xlmc.rare.splitting import descend
from xlmc.statistics import Estimate

__all__ = ["CASE", "covered", "estimates", "faults", "narrowed", "one_run"]

HERE = Path(__file__).resolve().parent
PAGE = HERE.parent / "docs" / "rare-acceptance.md"
RESULTS = HERE / "results" / "rare.json"
BOOK = HERE.parent / "examples" / "intersection.xlsx"

RUNS, WANTED, MOST = 1_000, 2_000, 10**9
LEAST, FAMILY, FEWER = 0.93, 0.01, 50.0

CASE_RUNS, CASE_WANTED, CASE_TRIALS = 100, 300, 200_000_000
CASE = {"Restitution, normal": {"at_least": 0.10, "below": 0.12}, "Restitution, tangential": {"at_most": 0.01}}
"""Limits of the case study's filters, narrowed until some 4 in 100,000 trials are accepted."""

BINS = 64
"""Equally likely intervals of each uniform in the grid that proposals are compared with."""

Floats = NDArray[np.float64]
Distance = Callable[[Floats], Floats]


def one_run(distance: Distance, dimensions: int, seed: int, wanted: int = WANTED) -> Found:
    """Accepted trials, from two streams of a seed."""
    learning, drawing = (np.random.default_rng((seed, purpose)) for purpose in (0, 1))
    return find(distance, lambda z: distance(z) == 0.0, dimensions, wanted, MOST, learning, drawing)


def estimates(found: Found, values: Floats) -> list[Estimate]:
    """By STATISTICS."""
    assert found.equalised is not None
    sample = xs.Sample.of(values)
    moments = [xs.mean(sample), xs.standard_deviation(sample), xs.median(sample)]
    return [found.equalised.acceptance, *moments, *xs.central_interval(sample)]


def covered(found: Sequence[Estimate], truth: Sequence[float]) -> list[bool]:
    """Whether each interval holds its truth."""
    ends = [each.interval or (math.nan, math.nan) for each in found]
    return [low <= true <= high for (low, high), true in zip(ends, truth, strict=True)]


def faults(hits: Mapping[str, Sequence[int]], runs: Mapping[str, int]) -> list[str]:
    """The cells that miss the bar."""
    level = FAMILY / sum(len(each) for each in hits.values())
    return [
        f"{name}, {statistic}: {count / runs[name]:.2%}"
        for name, each in hits.items()
        for statistic, count in zip(STATISTICS, each, strict=False)
        if bdtr(count, runs[name], LEAST) < level
    ]


def measured(name: str, runs: int, keep: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """One problem; what there is so far is kept from time to time."""
    problem = PROBLEMS[name]
    hits, evaluations = np.zeros(len(STATISTICS), int), list[int]()
    for seed in range(runs):
        if seed and seed % 20 == 0:
            keep(_counted(name, hits, evaluations))
        found = one_run(problem.distance, problem.dimensions, seed)
        assert found.equalised is not None
        hits += covered(estimates(found, problem.forecast(found.equalised.points)), problem.truth)
        evaluations.append(found.evaluations)
    return _counted(name, hits, evaluations)


def _counted(name: str, hits: NDArray[np.int64], evaluations: Sequence[int]) -> dict[str, Any]:
    return {
        "words": PROBLEMS[name].words,
        "acceptance": PROBLEMS[name].truth[0],
        "runs": len(evaluations),
        "wanted": WANTED,
        "hits": hits.tolist(),
        "evaluations": float(np.mean(evaluations)),
        "most_evaluations": max(evaluations),
    }


def compared(distance: Distance, dimensions: int, seeds: int = 8) -> dict[str, float]:
    """The methods on one problem: trials for a relative error of 1 % of the probability of acceptance, or of a mean.

    Splitting: from the spread of single populations. The others: from effective sample sizes of one proposal each, a
    grid of independent uniforms (as VEGAS learns it), the mixture, and its trials of equal weight.
    """
    logs, costs, grids, mixtures, equals = [], [], [], [], []
    for seed in range(seeds):
        way = descend(distance, dimensions, np.random.default_rng((seed, 2)))
        if way.reached:
            logs.append(way.log_probability)
            costs.append(way.evaluations)
            grids.append(grid_efficiency(distance, way.points, np.random.default_rng((seed, 3))))
        best = one_run(distance, dimensions, seed, wanted=500).used
        assert best is not None
        weights = np.exp(best.logs - best.envelope)
        mixtures.append(float(weights.sum() ** 2 / np.square(weights).sum() / best.trials))
        equals.append(best.rate)
    return {
        "splitting": float(np.var(logs, ddof=1) * np.mean(costs) * 1e4),
        "grid": 1e4 / float(np.mean(grids)),
        "mixture": 1e4 / float(np.mean(mixtures)),
        "equal": 1e4 / float(np.mean(equals)),
        "learning": float(np.mean(costs)) * 2,
    }


def grid_efficiency(distance: Distance, points: Floats, random: np.random.Generator, count: int = 1 << 17) -> float:
    """The effective sample size of a proposal from independent histograms, one a uniform, learned from points."""
    cells = np.minimum((ndtr(points) * BINS).astype(int), BINS - 1)
    shares = np.array([np.bincount(column, minlength=BINS) for column in cells.T]) / len(points)
    shares = 0.9 * shares + 0.1 / BINS
    chosen = np.array([random.choice(BINS, count, p=share) for share in shares]).T
    u = (chosen + random.random(chosen.shape)) / BINS
    logs = -np.log(np.take_along_axis(shares.T, chosen, axis=0) * BINS).sum(axis=1)
    weights = np.exp(logs) * (distance(ndtri(np.maximum(u, 2.0**-54))) == 0.0)
    total = float(np.square(weights).sum())
    return float(weights.sum() ** 2 / total / count) if total else 1e-9


def narrowed(model: Model) -> Model:
    """The case study with CASE's limits."""
    filters = tuple(replace(f, **CASE.get(f.name, {})) for f in model.filters)
    return Model(model.workbook, replace(model.definitions, filters=filters), model.path)


def case_study(runs: int, trials: int) -> dict[str, Any]:
    """The case study: its truth from plain trials, and how often intervals hold it, its own error allowed for."""
    model = narrowed(xlmc.load(BOOK))
    plain = model.simulate(trials, 1, engine="jit", jobs=1)
    named = ["Chevrolet delta-V", "Nissan impact speed"]
    truth = [plain.acceptance] + [each for name in named for each in of_forecast(plain[name].sample)]
    hits, evaluations, apart = np.zeros(len(truth), int), [], []
    print(plain.accepted, "of", trials, "plain trials", flush=True)
    for seed in range(runs):
        run = model.simulate(5 * 10**8, seed, until_accepted=CASE_WANTED, rare="always")
        assert run.rare is not None
        found = [run.acceptance] + [each for name in named for each in of_forecast(run[name].sample)]
        hits += [within(mine, true) for mine, true in zip(found, truth, strict=True)]
        evaluations.append(run.rare.evaluations)
        apart.append([mine.value for mine in found])
        print(seed, run.rare.evaluations, hits.tolist(), flush=True)
    means = np.mean(apart, axis=0)
    errors = np.hypot(np.std(apart, axis=0, ddof=1) / math.sqrt(runs), [each.error or math.nan for each in truth])
    return {
        "words": "the case study, filters narrowed",
        "acceptance": plain.acceptance.value,
        "runs": runs,
        "wanted": CASE_WANTED,
        "plain_trials": trials,
        "plain_accepted": plain.accepted,
        "hits": hits.tolist(),
        "evaluations": float(np.mean(evaluations)),
        "most_evaluations": max(evaluations),
        "plain": [each.value for each in truth],
        "plain_errors": [each.error for each in truth],
        "mean_of_runs": means.tolist(),
        "standard_scores": ((means - [each.value for each in truth]) / errors).tolist(),
    }


def of_forecast(sample: xs.Sample) -> list[Estimate]:
    """By STATISTICS without the first."""
    return [xs.mean(sample), xs.standard_deviation(sample), xs.median(sample), *xs.central_interval(sample)]


def within(mine: Estimate, true: Estimate) -> bool:
    """Whether an interval, widened by the error of the truth, holds it."""
    if mine.interval is None or not mine.error or not true.error:
        return False
    wider = math.hypot(1.0, true.error / mine.error)
    low, high = (mine.value + (end - mine.value) * wider for end in mine.interval)
    return low <= true.value <= high


def coverage_table(found: Mapping[str, Any]) -> str:
    """Coverage in percent, as Markdown."""
    lines = ["| problem | accepted | runs | evaluations | plain rejection | " + " | ".join(STATISTICS) + " |"]
    lines.append("|---|---:|---:|---:|---:|" + "---:|" * len(STATISTICS))
    for each in found.values():
        plain = each["wanted"] / each["acceptance"]
        share = [f"{100.0 * hits / each['runs']:.1f}" for hits in each["hits"][: len(STATISTICS)]]
        front = f"| {each['words']} | {each['acceptance']:.1e} | {each['runs']:,} | {each['evaluations']:,.0f} "
        lines.append(f"{front}| {plain:,.0f} ({plain / each['evaluations']:,.0f} ×) | " + " | ".join(share) + " |")
    return "\n".join(lines)


def method_table(found: Mapping[str, Any]) -> str:
    """Trials for an error of 1 %, as Markdown."""
    heads = ("plain rejection", "splitting alone", "grid", "mixture, weighted", "mixture, equal weights")
    lines = ["| problem | " + " | ".join(heads) + " | to learn |", "|---|" + "---:|" * 6]
    for each in found.values():
        if "methods" in each:
            how = each["methods"]
            trials = (1e4 / each["acceptance"], *(how[key] for key in ("splitting", "grid", "mixture", "equal")))
            lines.append(f"| {each['words']} | " + " | ".join(f"{x:.1e}" for x in (*trials, how["learning"])) + " |")
    return "\n".join(lines)


def main() -> None:
    """Measure, write, and end with 1 where a cell misses the bar."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--only", choices=list(PROBLEMS), action="append", help="of the problems; may be given again")
    parser.add_argument("--case", type=int, metavar="RUNS", help="the case study instead, so often")
    parser.add_argument("--case-trials", type=int, default=CASE_TRIALS)
    parser.add_argument("--results", type=Path, default=RESULTS)
    parser.add_argument("--page", type=Path, default=PAGE)
    given = parser.parse_args()
    found = json.loads(given.results.read_text()) if given.results.exists() else {}
    if given.case:
        found["case study"] = case_study(given.case, given.case_trials)
        landscape = Landscape(narrowed(xlmc.load(BOOK)), np.random.default_rng(0))
        found["case study"]["methods"] = compared(landscape.distance, landscape.dimensions)
    for name in () if given.case else given.only or PROBLEMS:

        def keep(counted: dict[str, Any], name: str = name) -> None:
            found[name] = counted
            given.results.write_text(json.dumps(found, indent=1) + "\n")
            print(name, counted, flush=True)

        keep(measured(name, given.runs, keep))
        found[name]["methods"] = compared(PROBLEMS[name].distance, PROBLEMS[name].dimensions)
    given.results.write_text(json.dumps(found, indent=1) + "\n")
    if given.page.exists():
        page = placed(given.page.read_text(), "rare-coverage", coverage_table(found))
        given.page.write_text(placed(page, "rare-methods", method_table(found)))
    missed = faults({name: each["hits"] for name, each in found.items()}, {n: e["runs"] for n, e in found.items()})
    missed += [
        f"{name}: only {each['wanted'] / each['acceptance'] / each['evaluations']:.0f} × fewer evaluations"
        for name, each in found.items()
        if each["acceptance"] <= 1e-6 and each["wanted"] / each["acceptance"] < FEWER * each["evaluations"]
    ]
    print("\n".join(missed) or "every cell meets the bar")
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
