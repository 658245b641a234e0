"""Do 95 % intervals contain the truth 95 times in 100? Fixed seeds; no result depends on the machine.

Bounds: 0.95 ± 4 binomial standard errors of the runs, less a documented slack below where theory itself promises less.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

import xlmc.montecarlo.statistics as xs

RUNS = 300
NOISE = 4 * math.sqrt(0.95 * 0.05 / RUNS)
DISTRIBUTIONS = {"normal": stats.norm(20, 3), "exponential": stats.expon(), "lognormal": stats.lognorm(0.5)}


def covers(estimate, truth):
    return estimate.interval[0] <= truth <= estimate.interval[1]


@pytest.mark.parametrize(("name", "n"), [("normal", 200), ("exponential", 200), ("lognormal", 200)])
def test_independent_trials(name, n):
    """Slack: skewed distributions cost the mean 1 % at n = 200 and the standard deviation 4 % (Student's t assumes
    neither); the ranks of the percentiles are exact up to interpolation, 0.5 %."""
    distribution = DISTRIBUTIONS[name]
    draws = distribution.rvs((RUNS, n), random_state=np.random.default_rng(n))
    percents = [5, 24.5, 50, 75.5, 95]
    truth = {"mean": distribution.mean(), "deviation": distribution.std()}
    truth |= {percent: distribution.ppf(percent / 100) for percent in percents}
    hits = dict.fromkeys(truth, 0)
    for run in draws:
        sample = xs.Sample.of(run)
        hits["mean"] += covers(xs.mean(sample), truth["mean"])
        hits["deviation"] += covers(xs.standard_deviation(sample), truth["deviation"])
        for percent, estimate in xs.percentiles(sample, percents).items():
            hits[percent] += covers(estimate, truth[percent])
    skewed = name != "normal"
    slack = {"mean": 0.01 * skewed, "deviation": 0.04 * skewed + 0.01}
    for key, count in hits.items():
        assert 0.95 - NOISE - slack.get(key, 0.005) < count / RUNS < 0.95 + NOISE + slack.get(key, 0.005), key


def test_errors_are_the_spread_from_run_to_run():
    """The errors' mean against the spread of 500 runs, which is known to 1/√1000 = 3.2 %; four of those and 2 %."""
    draws = stats.gamma(4).rvs((500, 500), random_state=np.random.default_rng(1))
    functions = [xs.mean, xs.standard_deviation, xs.variance, xs.coefficient_of_variation, xs.median]
    result = [[function(sample) for function in functions] for sample in map(xs.Sample.of, draws)]
    values = np.array([[each.value for each in run] for run in result])
    errors = np.array([[each.error for each in run] for run in result])
    assert errors.mean(axis=0) / values.std(axis=0, ddof=1) == pytest.approx(np.ones(5), abs=0.147)


def test_proportions():
    """Wilson's coverage swings about its nominal value with n·p, here by up to 2 %; Clopper and Pearson's never falls
    below it. Both are computed without drawing: the sum of binomial chances of the counts whose interval holds p."""
    for n, p in [(50, 0.1), (200, 0.02), (200, 0.5), (1000, 0.05)]:
        chance = stats.binom.pmf(np.arange(n + 1), n, p)
        wilson = sum(chance[k] for k in range(n + 1) if covers(xs.proportion(k, n), p))
        exact = sum(chance[k] for k in range(n + 1) if covers(xs.proportion(k, n, method="clopper-pearson"), p))
        assert 0.93 < wilson < 0.98
        assert exact >= 0.95


def test_weighted_trials():
    """Draws from N(0, 1.6²) weighted back to N(0, 1): some 360 effective of 500 trials, and 1 % of slack for it."""
    rng, target = np.random.default_rng(2), stats.norm()
    truth = {"mean": 0.0, "deviation": 1.0, "above": target.sf(1.0)}
    truth |= {percent: target.ppf(percent / 100) for percent in (10, 24.5, 50, 90)}
    hits = dict.fromkeys(truth, 0)
    for _ in range(RUNS):
        x = 1.6 * rng.standard_normal(500)
        sample = xs.Sample.of(x, np.exp(-0.5 * x * x * (1 - 1 / 1.6**2)))
        hits["mean"] += covers(xs.mean(sample), 0.0)
        hits["deviation"] += covers(xs.standard_deviation(sample), 1.0)
        hits["above"] += covers(xs.probability_above(sample, 1.0), truth["above"])
        for percent, estimate in xs.percentiles(sample, (10, 24.5, 50, 90)).items():
            hits[percent] += covers(estimate, truth[percent])
    for key, count in hits.items():
        assert 0.95 - NOISE - 0.01 < count / RUNS < 0.95 + NOISE + 0.01, key
