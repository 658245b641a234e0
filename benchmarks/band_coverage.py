"""Do the 90 % bands of `xlmc uncertainty` hold the truth, where truths are drawn from the outer distributions?

`python benchmarks/band_coverage.py` makes 300 seeded runs of each problem, writes `results/band-coverage.json` and
prints the shares. A truth is one draw of what is uncertain, for which the mean, the 95th percentile and a probability
have closed forms. Where a filter rejects trials, a truth is drawn as what really happened is: with a trial that passes.

The bar: each band holds the truth in 86 to 94 % of the runs.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.stats import norm, truncnorm

import xlmc

__all__ = ["PROBLEMS", "RESULTS", "Problem", "faults", "measure"]

RESULTS = Path(__file__).resolve().parent / "results" / "band-coverage.json"
RUNS, OUTER, INNER, CONFIDENCE = 300, 250, 1_000, 90.0
LEAST, MOST = 0.86, 0.94


class Problem(NamedTuple):
    """A model with known distributions.

    Attributes:
        model: with the forecast `y`.
        uncertain: its assumptions of the outer loop.
        truth: draws what is uncertain, and gives the true numbers of the forecast.
    """

    name: str
    model: Callable[[], xlmc.Model]
    uncertain: tuple[str, ...]
    truth: Callable[[np.random.Generator], dict[str, float]]


def _skid() -> xlmc.Model:
    """Make the speed of a skid of 100 ft: friction scatters about a mean that is not known (Figures 3 and 4)."""
    return xlmc.model(
        lambda mean, scatter, z: {"y": np.sqrt(2 * 32.174 * 100 * (mean + scatter * z))},
        {"mean": xlmc.Uniform(0.70, 0.85), "scatter": xlmc.Uniform(0.03, 0.07), "z": xlmc.Normal(0, 1)},
        {"y": {"threshold": 70.0}},
        name="skid",
    )


def _true_skid(random: np.random.Generator) -> dict[str, float]:
    mean, scatter = random.uniform(0.70, 0.85), random.uniform(0.03, 0.07)
    friction = 70.0**2 / (2 * 32.174 * 100)
    return {
        "95th percentile": float(np.sqrt(2 * 32.174 * 100 * (mean + scatter * norm.ppf(0.95)))),
        "median": float(np.sqrt(2 * 32.174 * 100 * mean)),
        "P(> 70)": float(norm.sf((friction - mean) / scatter)),
    }


def _filtered() -> xlmc.Model:
    """Make a normal quantity of unknown mean that is known to have been above 0."""
    return xlmc.model(
        lambda mean, z: {"y": mean + z, "positive": mean + z > 0},
        {"mean": xlmc.Normal(0, 1), "z": xlmc.Normal(0, 1)},
        ["y"],
        ["positive"],
        name="filtered",
    )


def _true_filtered(random: np.random.Generator) -> dict[str, float]:
    mean = z = -1.0
    while mean + z <= 0:
        mean, z = random.standard_normal(2)
    left = truncnorm(-mean, np.inf, loc=mean)
    return {"mean": float(left.mean()), "95th percentile": float(left.ppf(0.95)), "median": float(left.ppf(0.5))}


PROBLEMS = (
    Problem("skid", _skid, ("mean", "scatter"), _true_skid),
    Problem("filtered", _filtered, ("mean",), _true_filtered),
)


def measure(problem: Problem, runs: int = RUNS, outer: int = OUTER, inner: int = INNER) -> dict[str, float]:
    """Return the share of runs in which each band holds the truth."""
    model, held = problem.model(), dict[str, int]()
    for run in range(runs):
        truth = problem.truth(np.random.default_rng([1, run]))
        result = xlmc.uncertainty(
            model, outer=outer, inner=inner, confidence=CONFIDENCE, uncertain=problem.uncertain, seed=run
        )
        bands = {band.number: band for band in result["y"].bands}
        for number, value in truth.items():
            held[number] = held.get(number, 0) + (bands[number].low.value <= value <= bands[number].high.value)
    return {number: count / runs for number, count in held.items()}


def faults(records: dict[str, dict[str, float]]) -> list[str]:
    """Return the bands that hold the truth too seldom, or too often."""
    return [
        f"{name}: the band of the {number} holds the truth in {share:.1%}"
        for name, shares in records.items()
        for number, share in shares.items()
        if not LEAST <= share <= MOST
    ]


def main() -> int:
    """Measure all problems."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=RUNS)
    runs = parser.parse_args().runs
    records = {problem.name: measure(problem, runs) for problem in PROBLEMS}
    for name, shares in records.items():
        print(name, *(f"{number} {share:.1%}" for number, share in shares.items()), sep="; ")
    if runs == RUNS:
        RESULTS.write_text(json.dumps(records, indent=2) + "\n", encoding="utf-8")
    result = faults(records)
    print(*result, sep="\n")
    return bool(result)


if __name__ == "__main__":
    sys.exit(main())
