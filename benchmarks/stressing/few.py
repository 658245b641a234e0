"""Statistics of a handful of accepted trials: how often their 95 % intervals hold the truth, and which have none."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

import numpy as np
from scipy import stats

import xlmc.montecarlo.statistics as xs

__all__ = ["FORECASTS", "STATISTICS", "coverage", "truths"]

FORECASTS: Final[Mapping[str, Any]] = {
    "normal": stats.norm(10.0, 3.0),
    "uniform": stats.uniform(2.0, 1.0),
    "exponential": stats.expon(),
}

STATISTICS: Final[Mapping[str, Callable[[xs.Sample, float], xs.Estimate]]] = {
    "mean": lambda sample, _: xs.mean(sample),
    "median": lambda sample, _: xs.median(sample),
    "24.5 %": lambda sample, _: xs.percentile(sample, 24.5),
    "75.5 %": lambda sample, _: xs.percentile(sample, 75.5),
    "P(above)": lambda sample, threshold: xs.probability_above(sample, threshold),
    "standard deviation": lambda sample, _: xs.standard_deviation(sample),
    "coefficient of variation": lambda sample, _: xs.coefficient_of_variation(sample),
    "skewness": lambda sample, _: xs.skewness(sample),
    "kurtosis": lambda sample, _: xs.kurtosis(sample),
}


def truths(name: str) -> dict[str, float]:
    """By STATISTICS; the threshold is the 70th percentile."""
    law = FORECASTS[name]
    skewness, excess = (float(each) for each in law.stats("sk"))
    return {
        "mean": law.mean(), "median": law.median(), "24.5 %": law.ppf(0.245), "75.5 %": law.ppf(0.755),
        "P(above)": 0.3, "standard deviation": law.std(), "coefficient of variation": law.std() / law.mean(),
        "skewness": skewness, "kurtosis": 3.0 + excess,
    }  # fmt: skip


def coverage(name: str, trials: int, runs: int) -> dict[str, Any]:
    """Statistic -> (runs with an interval, runs in which it holds the truth)."""
    law, true = FORECASTS[name], truths(name)
    threshold = float(law.ppf(0.7))
    draws = law.rvs((runs, trials), random_state=np.random.default_rng(trials))
    result = {statistic: [0, 0] for statistic in STATISTICS}
    for row in draws:
        sample = xs.Sample.of(row)
        for statistic, compute in STATISTICS.items():
            interval = compute(sample, threshold).interval
            if interval is not None:
                result[statistic][0] += 1
                result[statistic][1] += int(interval[0] <= true[statistic] <= interval[1])
    return {"forecast": name, "trials": trials, "runs": runs, "found": result}
