"""Where filters accept 1 trial in 10⁴ to 10⁷: do 95 % intervals hold the truth, and how many trials does that take?

`python benchmarks/rare_acceptance.py` finds 2,000 accepted trials 1,000 times in each of three problems with known
answers, and 300 in the paper's case study under narrowed filters, whose truth is a long run of plain trials. It
compares methods on them, and writes `results/rare.json` and the tables of docs/rare-acceptance.md. The seeds begin at
SEED: nothing was tuned on those. No figure depends on the machine.

The bar: no cell lies below 93 % by more than chance allows at a family-wise level of 1 %; at 10⁻⁶ plain rejection
takes at least 50 times as many evaluations.
"""

from __future__ import annotations

import argparse
import json
import math
import multiprocessing
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import rare_case as case
from rare_methods import Distance, Floats, compared, one_run
from rare_problems import PROBLEMS, STATISTICS
from scipy.special import bdtr
from tables import placed

import xlmc.montecarlo.statistics as xs
from xlmc.montecarlo.rare.limit_state_function import LimitStateFunction
from xlmc.montecarlo.rare.search import SearchResult
from xlmc.montecarlo.statistics import Estimate

__all__ = ["covered", "estimates", "faults"]

HERE = Path(__file__).resolve().parent
PAGE = HERE.parent / "docs" / "rare-acceptance.md"
RESULTS = HERE / "results" / "rare.json"

RUNS, SEED, WANTED, CASE_TRIALS = 1_000, 1_000_000, 2_000, 2 * 10**10
KEEP = 20
LEAST, FAMILY, FEWER = 0.93, 0.01, 50.0
NAMES = (*PROBLEMS, case.WORDS)

Entry = dict[str, Any]
"""What is kept of a problem: `hits` by `labels`, and the rest by name."""

Answers = list[Estimate]
"""By labels."""


def estimates(result: SearchResult, values: Floats) -> Answers:
    """By STATISTICS."""
    assert result.resampled is not None
    sample = xs.Sample.of(values)
    moments = [xs.mean(sample), xs.standard_deviation(sample), xs.median(sample)]
    return [result.resampled.acceptance, *moments, *xs.central_interval(sample)]


def covered(result: Sequence[Estimate], truth: Sequence[float]) -> list[bool]:
    """Whether each interval holds its truth."""
    ends = [each.interval or (math.nan, math.nan) for each in result]
    return [low <= true <= high for (low, high), true in zip(ends, truth, strict=True)]


def faults(problems: Mapping[str, Entry]) -> list[str]:
    """The cells that miss the bar."""
    level = FAMILY / sum(len(each["hits"]) for each in problems.values())
    missed = [
        f"{name}, {label}: {count / each['runs']:.2%}"
        for name, each in problems.items()
        for label, count in zip(each["labels"], each["hits"], strict=True)
        if bdtr(count, each["runs"], LEAST) < level
    ]
    fewer = {name: each["wanted"] / each["acceptance"] / each["evaluations"] for name, each in problems.items()}
    return missed + [
        f"{name}: only {fewer[name]:.0f} × fewer evaluations"
        for name, each in problems.items()
        if each["acceptance"] <= 1e-6 and fewer[name] < FEWER
    ]


def analytic(name: str, seed: int) -> tuple[Answers, int]:
    """One run of a problem with a known answer, and how many trials it computed."""
    problem = PROBLEMS[name]
    result = one_run(problem.distance, problem.dimensions, seed, WANTED)
    assert result.resampled is not None
    return estimates(result, problem.forecast(result.resampled.points)), result.evaluations


@dataclass(frozen=True, slots=True)
class Subject:
    """A problem as it is measured.

    Attributes:
        one: seed -> what a run says, and how many trials it computed.
        holds: whether each interval holds the truth.
        region: its distance and number of dimensions.
        about: the entry before any run.
    """

    one: Callable[[int], tuple[Answers, int]]
    holds: Callable[[Answers], list[bool]]
    region: tuple[Distance, int]
    about: Entry


def subject(name: str, jobs: int) -> Subject:
    """Of that name; the truth of the case study takes a while."""
    if name == case.WORDS:
        truth, accepted = case.plain(CASE_TRIALS, jobs)
        function = LimitStateFunction(case.model(), np.random.default_rng(0))
        about = {"words": f"{name}, filters narrowed", "labels": case.LABELS, "acceptance": truth[0].value}
        about |= {"wanted": case.WANTED, "plain_trials": CASE_TRIALS, "plain_accepted": accepted}
        return Subject(case.searched, partial(case.held, truth), (function.distance, function.dimensions), about)
    problem = PROBLEMS[name]
    about = {"words": problem.words, "labels": STATISTICS, "acceptance": problem.truth[0], "wanted": WANTED}
    region = problem.distance, problem.dimensions
    return Subject(partial(analytic, name), partial(covered, truth=problem.truth), region, about)


def measured(subject: Subject, runs: int, jobs: int, keep: Callable[[Entry], None]) -> None:
    """One problem; what there is so far is kept from time to time."""
    hits, evaluations = np.zeros(len(subject.about["labels"]), int), list[int]()
    with multiprocessing.get_context("spawn").Pool(jobs) as pool:
        for answers, cost in pool.imap(subject.one, range(SEED, SEED + runs)):
            hits += subject.holds(answers)
            evaluations.append(cost)
            if len(evaluations) % KEEP == 0 or len(evaluations) == runs:
                counts = {"runs": len(evaluations), "hits": hits.tolist()}
                costs = {"evaluations": float(np.mean(evaluations)), "most_evaluations": max(evaluations)}
                keep({**subject.about, **counts, **costs})
    keep({**subject.about, **counts, **costs, "methods": compared(*subject.region)})


def coverage_table(result: Mapping[str, Entry]) -> str:
    """Coverage in percent, as Markdown; a line a forecast."""
    lines = ["| problem | accepted | runs | evaluations | plain rejection | " + " | ".join(STATISTICS) + " |"]
    lines.append("|---|---:|---:|---:|---:|" + "---:|" * len(STATISTICS))
    values = len(STATISTICS) - 1
    for each in result.values():
        plain = each["wanted"] / each["acceptance"]
        share = [f"{100.0 * hits / each['runs']:.1f}" for hits in each["hits"]]
        costs = f"{each['acceptance']:.1e} | {each['runs']:,} | {each['evaluations']:,.0f} "
        costs += f"| {plain:,.0f} ({plain / each['evaluations']:,.0f} ×)"
        for at in range(1, len(share), values):
            forecast = each["labels"][at].rpartition(", ")[0]
            words = f"{each['words']}: {forecast}" if forecast else each["words"]
            lines.append(f"| {words} | {costs} | {share[0]} | {' | '.join(share[at : at + values])} |")
    return "\n".join(lines)


def method_table(result: Mapping[str, Any]) -> str:
    """Trials for an error of 1 %, as Markdown."""
    heads = ("plain rejection", "splitting alone", "grid", "mixture, weighted", "mixture, equal weights")
    lines = ["| problem | " + " | ".join(heads) + " | to learn |", "|---|" + "---:|" * 6]
    for each in result.values():
        if "methods" in each:
            how = each["methods"]
            trials = (1e4 / each["acceptance"], *(how[key] for key in ("splitting", "grid", "mixture", "equal")))
            lines.append(f"| {each['words']} | " + " | ".join(f"{x:.1e}" for x in (*trials, how["learning"])) + " |")
    return "\n".join(lines)


def main() -> None:
    """Measure, write, and end with 1 where a cell misses the bar."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--only", choices=NAMES, action="append", help="of the problems; may be given again")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--results", type=Path, default=RESULTS)
    parser.add_argument("--page", type=Path, default=PAGE)
    given = parser.parse_args()
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # in the processes to come: each has one core
    result: dict[str, Entry] = json.loads(given.results.read_text(encoding="utf-8")) if given.results.exists() else {}
    for name in given.only or NAMES:

        def keep(entry: Entry, name: str = name) -> None:
            result[name] = entry
            given.results.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
            print(name, entry["runs"], entry["hits"], flush=True)

        measured(subject(name, given.jobs), given.runs, given.jobs, keep)
    if given.page.exists():
        page = placed(given.page.read_text(encoding="utf-8"), "rare-coverage", coverage_table(result))
        given.page.write_text(placed(page, "rare-methods", method_table(result)), encoding="utf-8")
    missed = faults(result)
    print("\n".join(missed) or "every cell meets the bar")
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
