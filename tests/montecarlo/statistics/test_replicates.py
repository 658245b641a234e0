"""Latin hypercubes: the error from independent trials is wrong for them, the one between replicates is right."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

import xlmc.montecarlo.statistics as xs

RUNS, REPLICATES, STRATA = 200, 20, 50
NOISE = 4 * math.sqrt(0.95 * 0.05 / RUNS)


def hypercubes(rng):
    """(trials, 2) uniform, stratified within each replicate, and the replicate ids."""
    order = rng.permuted(np.broadcast_to(np.arange(STRATA), (REPLICATES, 2, STRATA)), axis=2)
    u = (order + rng.random(order.shape)) / STRATA
    return u.transpose(0, 2, 1).reshape(-1, 2), np.repeat(np.arange(REPLICATES), STRATA)


def runs(filtered):
    """Estimates of a sum of two inputs, all trials or only those with a product below 0.4."""
    rng = np.random.default_rng(5)
    result = []
    for _ in range(RUNS):
        u, ids = hypercubes(rng)
        kept = u[:, 0] * u[:, 1] < 0.4 if filtered else np.full(ids.size, True)
        sample = xs.Sample.of(3 * u[kept, 0] + u[kept, 1], None, ids[kept])
        functions = (xs.mean, xs.standard_deviation, xs.median, lambda s: xs.probability_above(s, 2.5))
        result.append([function(sample) for function in functions])
    return result


def truths(filtered):
    """The same four numbers from a fine midpoint grid: an error of about 2e-3 of a standard deviation."""
    grid = (np.arange(1000) + 0.5) / 1000
    first, second = np.meshgrid(grid, grid)
    kept = first * second < 0.4 if filtered else np.full(first.shape, True)
    x = (3 * first + second)[kept]
    return [x.mean(), x.std(), np.median(x), np.mean(x > 2.5)]


@pytest.mark.parametrize("filtered", [False, True], ids=["all", "filtered"])
def test_errors_and_coverage_with_replicates(filtered):
    """200 runs know a spread to 5 %, 20 replicates an error to 16 %, so their mean to 1 %; 3.3 of those."""
    result = runs(filtered)
    for column, truth in enumerate(truths(filtered)):
        estimates = [run[column] for run in result]
        spread = np.std([each.value for each in estimates], ddof=1)
        assert np.mean([each.error for each in estimates]) / spread == pytest.approx(1.0, abs=0.17)
        coverage = np.mean([each.interval[0] <= truth <= each.interval[1] for each in estimates])
        assert coverage == pytest.approx(0.95, abs=NOISE)


def test_the_gain_of_stratification_shows():
    """A sum of stratified inputs: the mean's error falls by about the number of strata."""
    u, ids = hypercubes(np.random.default_rng(6))
    x = 3 * u[:, 0] + u[:, 1]
    assert xs.mean(x, None, ids).error < xs.mean(x).error / 20
    assert xs.mean(x, None, ids).value == xs.mean(x).value


def test_many_blocks_are_joined_and_the_error_stays_the_same():
    """400 independent replicates as 64 groups: an error known to 1/√126 = 9 %."""
    rng = np.random.default_rng(7)
    ids = np.repeat(np.arange(400), 10)
    x = rng.normal(size=400)[ids] + 0.1 * rng.normal(size=4000)
    whole = np.std([x[ids == r].mean() for r in range(400)], ddof=1) / 20
    estimate = xs.mean(x, None, ids)
    assert estimate.error == pytest.approx(whole, rel=0.3)
    half = stats.t.ppf(0.975, 63) * estimate.error
    assert estimate.interval[0] < estimate.value - half < estimate.value + half < estimate.interval[1]
    assert estimate.interval == pytest.approx((estimate.value - half, estimate.value + half), abs=0.05 * half)
