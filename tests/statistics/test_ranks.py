from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from xlmc.statistics import median, percentile, share
from xlmc.statistics.sample import positions_of


@pytest.mark.parametrize(("n", "percent", "below"), [(100, 50, 40), (100, 24.5, 17), (57, 90, 46), (4000, 75.5, 2990)])
def test_where_binomial_and_ranks_agree_the_lower_end_is_that_trial(n, percent, below):
    """P(Bin(n, p) ≤ k) is the chance that trial k (from 0) lies above the quantile."""
    x = np.random.default_rng(n).normal(size=n)
    tail = stats.binom.cdf(below, n, percent / 100)
    assert 0.001 < tail < 0.2
    estimate = percentile(x, percent, confidence=1 - 2 * tail)
    assert estimate.interval[0] == pytest.approx(np.sort(x)[below], rel=1e-6)


@pytest.mark.parametrize(("n", "percent", "above"), [(100, 50, 59), (57, 90, 55), (4000, 24.5, 1010)])
def test_where_binomial_and_ranks_agree_the_upper_end_is_that_trial(n, percent, above):
    x = np.random.default_rng(n).normal(size=n)
    tail = stats.binom.sf(above, n, percent / 100)
    assert 0.001 < tail < 0.2
    estimate = percentile(x, percent, confidence=1 - 2 * tail)
    assert estimate.interval[1] == pytest.approx(np.sort(x)[above], rel=1e-6)


@pytest.mark.parametrize("n", [5, 20, 73, 200])
@pytest.mark.parametrize("percent", [10, 24.5, 50, 90])
def test_the_ends_lie_between_the_conservative_ranks_and_the_ranks_inside_them(n, percent):
    """Interpolation never reaches beyond the classical interval of order statistics."""
    x, p = np.arange(float(n)), percent / 100
    low, high = percentile(x, percent).interval or (-math.inf, math.inf)
    k = stats.binom.ppf(0.025, n, p)  # the least count with P(≤ k) ≥ 0.025
    assert (low == -math.inf) if k == 0 else (k - 1 - 1e-9 <= low <= k + 1e-9)
    k = stats.binom.ppf(0.975, n, p)
    assert (high == math.inf) if k == n else (k - 1 - 1e-9 <= high <= k + 1e-9)


def test_the_far_tail_of_a_small_sample_is_open():
    low, high = percentile(np.arange(100.0), 99).interval
    assert low < 98.01
    assert high == math.inf
    assert percentile(np.arange(100.0), 99).error is None


def test_the_error_approaches_the_density_formula():
    n = 100_000
    x = stats.expon.ppf((np.arange(n) + 0.5) / n)
    for p in (0.1, 0.245, 0.5, 0.755, 0.9):
        theory = math.sqrt(p * (1 - p) / n) / (1 - p)
        assert percentile(x, 100 * p).error == pytest.approx(theory, rel=2e-3)


def test_the_error_does_not_depend_on_the_confidence():
    x = np.random.default_rng(2).normal(size=300)
    assert median(x, confidence=0.5).error == median(x).error


def test_the_weighted_interval_is_that_of_the_effective_trials():
    """Weights independent of the values: the interval of Σ²/Σ² equal trials at the same quantile curve."""
    n = 20_000
    x = (np.arange(n) + 0.5) / n
    w = np.where(np.arange(n) % 2, 3.0, 1.0)
    error = math.sqrt(0.25 / (n * 16 / 20))
    assert median(x, w).error == pytest.approx(error, rel=1e-3)


def test_weights_that_grow_towards_a_tail_count_where_they_stand():
    """Half of the weight on few heavy trials: the share below the median is known less well than from Kish's count."""
    light, heavy = np.full(9000, 1.0), np.full(100, 90.0)
    x = np.concatenate([np.linspace(0, 1, 9000), np.linspace(1, 2, 100)])
    w = np.concatenate([light, heavy])
    share = w / w.sum()
    error_of_share = math.sqrt(0.25 * np.sum(share**2))
    low, high = median(x, w).interval
    curve = np.interp([low, high], x, positions_of(w))
    assert curve == pytest.approx([0.5 - 1.96 * error_of_share, 0.5 + 1.96 * error_of_share], abs=0.01)


@pytest.mark.parametrize("weighted", [False, True])
def test_the_replicate_error_is_that_of_the_share_below(weighted):
    """The quantile curve of evenly spread values is their share, whose error and Student's t the quantile has."""
    rng, n = np.random.default_rng(4), 20_000
    x = (np.arange(n) + 0.5) / n
    ids = rng.integers(0, 8, n)
    ids = np.where(rng.random(n) < 0.2, (8 * x).astype(int), ids)  # unlike shares below 0.3
    weights = np.where(np.arange(n) % 2, 3.0, 1.0) if weighted else None
    plain, estimate = percentile(x, 30, weights), percentile(x, 30, weights, ids)
    assert estimate.value == plain.value
    between = share(x <= plain.value, weights, ids).error
    assert between > 1.5 * share(x <= plain.value, weights).error
    assert estimate.error == pytest.approx(between, rel=0.02)
    half = stats.t.ppf(0.975, 7) * between
    assert np.diff(estimate.interval)[0] == pytest.approx(2 * half, rel=0.02)
    assert estimate.interval[0] < plain.value < estimate.interval[1]


def test_replicates_that_all_agree_still_leave_an_error():
    x, ids = np.tile(np.arange(100.0), 5), np.repeat(np.arange(5), 100)
    estimate = median(x + 1e-3 * ids, None, ids)
    assert estimate.error > 0


def test_replicates_of_independent_trials_have_their_error():
    """64 replicates know an error to 1/√126 = 9 %."""
    x, ids = np.random.default_rng(5).normal(size=20_000), np.arange(20_000) % 64
    for percent in (10, 50, 75.5):
        assert percentile(x, percent, None, ids).error == pytest.approx(percentile(x, percent).error, rel=0.27)


def test_replicates_do_not_bound_what_their_trials_do_not():
    estimate = percentile(np.arange(100.0), 99, replicate=np.arange(100) % 4)
    assert (estimate.value, estimate.error, estimate.interval[1]) == (98.01, None, np.inf)


@pytest.mark.parametrize("confidence", [0.0, 1.0, 95])
def test_a_confidence_outside_0_and_1_is_refused(confidence):
    with pytest.raises(ValueError, match="between 0 and 1"):
        median([1.0, 2.0], confidence=confidence)
