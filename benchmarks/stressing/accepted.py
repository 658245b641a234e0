"""Intervals after filters that accept little: how many accepted trials a replicate must have, and shares of a few.

The forecast is a sum of three normals, kept where it is in its own upper tail: any acceptance, and every true answer
from the truncated normal distribution.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from interval_coverage import estimates, one_run
from numpy.typing import NDArray
from problems import Normals
from scipy import stats

import xlmc.montecarlo.statistics as xs
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan

__all__ = ["METHODS", "after_filters", "exact_coverage", "shares", "waited_for"]

Floats = NDArray[np.float64]

METHODS: Final = ("mc", "lhs", "sobol")
STATISTICS: Final = ("mean", "SD", "median", "24.5 %", "75.5 %", "acceptance")


def after_filters(method: str, acceptance: float, trials: int, runs: int, first: int = 0) -> dict[str, Any]:
    """How often 95 % intervals held the truth, by STATISTICS; those that there were, and how many those were."""
    above = float(stats.norm.isf(acceptance))
    problem, plan = Normals(trials, above), SamplingPlan.of(method, trials)
    truth = [*problem.truth().tolist(), acceptance]
    hits, given, accepted = np.zeros(len(truth), int), np.zeros(len(truth), int), 0
    for seed in range(first, first + runs):
        sample = one_run(problem, plan, seed)
        accepted += sample.n
        result = [*estimates(sample), _acceptance(sample, plan)]
        for place, (estimate, true) in enumerate(zip(result, truth, strict=True)):
            if estimate.interval is not None:
                given[place] += 1
                hits[place] += estimate.interval[0] <= true <= estimate.interval[1]
    return {
        "method": method, "acceptance": acceptance, "trials": plan.trials, "runs": runs, "accepted": accepted / runs,
        "statistics": STATISTICS, "hits": hits.tolist(), "given": given.tolist(),
    }  # fmt: skip


def _acceptance(sample: xs.Sample, plan: SamplingPlan) -> xs.Estimate:
    """As `Simulation.acceptance` has it; replicates that accepted nothing count there."""
    if not plan.size:
        return xs.proportion(sample.n, plan.trials)
    counts = np.zeros(plan.replicates)
    if sample.group is not None and sample.n:
        result = np.bincount(sample.group, minlength=sample.groups)
        counts[: result.size] = result  # which of them is which does not matter
    return xs.replicated_proportion(counts, np.full(plan.replicates, plan.size))


def exact_coverage(ends: Floats, trials: int, shares: Floats) -> Floats:
    """How often intervals hold a share, `(p,)`, summed over all counts that could come; `ends` is `(k, 2)` by count."""
    chances = stats.binom.pmf(np.arange(len(ends)), trials, shares[:, None])
    return np.asarray(np.sum(chances * ((ends[:, 0] <= shares[:, None]) & (shares[:, None] <= ends[:, 1])), axis=1))


def _wilson(hits: Floats, trials: int) -> Floats:
    """95 % intervals of a share, (k, 2), as Wilson (1927) has them."""
    z = stats.norm.ppf(0.975)
    half = z * np.sqrt(hits * (trials - hits) / trials + z**2 / 4)
    return np.asarray(np.stack([hits + z**2 / 2 - half, hits + z**2 / 2 + half], axis=1) / (trials + z**2))


def shares(acceptance: float, expected: Floats) -> dict[str, Any]:
    """Exact coverage of the acceptance where so many are expected to be accepted, `(n,)`; xlmc's, and two others'."""
    result: dict[str, list[float]] = {"xlmc": [], "Wilson": [], "Clopper–Pearson": []}
    for count in expected:
        trials = max(1, round(float(count) / acceptance))
        most = min(trials, int(count + 12 * count**0.5 + 40))
        counts = range(most + 1)
        ways = {
            "xlmc": [xs.proportion(k, trials).interval for k in counts],
            "Wilson": _wilson(np.arange(most + 1.0), trials),
            "Clopper–Pearson": [xs.proportion(k, trials, method="clopper-pearson").interval for k in counts],
        }
        for name, ends in ways.items():
            result[name].append(float(exact_coverage(np.array(ends), trials, np.array([acceptance]))[0]))
    return {"acceptance": acceptance, "expected": expected.tolist(), "coverage": result}


def waited_for(acceptance: float, wanted: int, points: int = 20_000) -> dict[str, float]:
    """Exact, of `--until-accepted`: how often the interval holds, and the averages of N/n and (N − 1)/(n − 1).

    Summed over the trials that the last acceptance may fall on, in so many groups or some more, but for 1e-9 of the
    probability in either tail.
    """
    law = stats.nbinom(wanted, acceptance)
    low, high = int(law.ppf(1e-9)), int(law.isf(1e-9))
    step = max(1, (high - low) // points)
    misses = np.arange(low, high + step, step)
    chances = np.diff(law.cdf(np.append(misses, misses[-1] + step) - 1))
    result = [xs.inverse_proportion(wanted, wanted + int(miss) + step // 2) for miss in misses]
    ends = np.array([estimate.interval for estimate in result])
    unbiased = np.array([estimate.value for estimate in result])
    plain = wanted / (wanted + misses + step // 2)
    return {
        "coverage": float(np.sum(chances * ((ends[:, 0] <= acceptance) & (acceptance <= ends[:, 1])))),
        "N/n": float(np.sum(chances * plain)) / acceptance - 1.0,
        "(N-1)/(n-1)": float(np.sum(chances * unbiased)) / acceptance - 1.0,
    }
