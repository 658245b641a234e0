from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.statistics import (
    Estimate,
    central_interval,
    maximum,
    median,
    minimum,
    percentile,
    percentiles,
    range_width,
    share,
)
from xlmc.montecarlo.statistics.sample import positions_of

EXAMPLES = settings(max_examples=50, deadline=None)

values = st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=60)


@EXAMPLES
@given(values, st.floats(0, 100))
def test_the_value_is_excels_percentile_inc(x, percent):
    assert percentile(x, percent).value == pytest.approx(np.percentile(x, percent), rel=1e-12, abs=1e-9)


@pytest.mark.parametrize(
    ("percent", "expected"),
    [(0, 1), (25, 1.75), (30, 1.9), (50, 2.5), (100, 4)],
)
def test_the_examples_of_excels_documentation(percent, expected):
    assert percentile([1.0, 3.0, 2.0, 4.0], percent).value == pytest.approx(expected)


@EXAMPLES
@given(values, st.floats(0, 100))
def test_equal_weights_are_no_weights(x, percent):
    plain, weighted = percentile(x, percent), percentile(x, percent, np.full(len(x), 3.0))
    assert weighted.value == pytest.approx(plain.value, rel=1e-9, abs=1e-6)


def test_equal_weights_give_the_same_interval():
    x = np.random.default_rng(1).normal(size=150)
    for percent in (5, 24.5, 50, 90):
        plain, weighted = percentile(x, percent), percentile(x, percent, np.full(150, 3.0))
        assert weighted.interval == pytest.approx(plain.interval, rel=1e-9)
        assert weighted.error == pytest.approx(plain.error, rel=1e-9)


@EXAMPLES
@given(st.lists(st.floats(-1e3, 1e3), min_size=2, max_size=30, unique=True), st.integers(0, 99))
def test_whole_weights_agree_with_repeated_trials_at_every_trial(x, seed):
    counts = np.random.default_rng(seed).integers(1, 6, len(x))
    order = np.argsort(x)
    at = 100 * positions_of(counts[order].astype(float))
    for percent, value in zip(at, np.array(x)[order], strict=True):
        assert percentile(x, percent, counts).value == pytest.approx(value, rel=1e-9, abs=1e-9)
        assert np.percentile(np.repeat(x, counts), percent) == pytest.approx(value, rel=1e-6, abs=1e-6)


@EXAMPLES
@given(values, st.lists(st.floats(0, 100), min_size=2, max_size=6), st.integers(0, 99))
def test_percentiles_rise_and_stay_within_the_extremes(x, percents, seed):
    weights = np.random.default_rng(seed).uniform(0.1, 2.0, len(x))
    result = [percentiles(x, sorted(percents), w) for w in (None, weights)]
    for each in result:
        line = [min(x), *(estimate.value for estimate in each.values()), max(x)]
        assert np.all(np.diff(line) >= -1e-9)


@EXAMPLES
@given(values, st.floats(0.1, 99.9), st.floats(0.01, 100), st.floats(-100, 100))
def test_follows_a_change_of_unit_and_origin(x, percent, scale, shift):
    here, there = percentile(x, percent), percentile(np.array(x) * scale + shift, percent)
    assert there.value == pytest.approx(here.value * scale + shift, rel=1e-9, abs=1e-6)
    assert (here.interval is None) == (there.interval is None)
    if here.interval is not None:
        assert there.interval == pytest.approx(tuple(end * scale + shift for end in here.interval), rel=1e-9, abs=1e-6)


@EXAMPLES
@given(values, st.floats(0.1, 49.9))
def test_mirrored_values_have_mirrored_percentiles(x, percent):
    low, high = percentile(x, percent), percentile(-np.array(x), 100 - percent)
    assert high.value == pytest.approx(-low.value, rel=1e-9, abs=1e-6)
    assume(low.interval is not None)
    assume(not {*x} <= {-1.0, 0.0, 1.0})  # 0 and 1 are an answer, whose percentiles lie between them
    assert high.interval == pytest.approx((-low.interval[1], -low.interval[0]), rel=1e-6, abs=1e-5)


def test_extremes_have_no_error():
    ends = percentiles([1.0, 2.0, 3.0], [0, 100])
    assert [(each.value, each.error, each.interval) for each in ends.values()] == [(1, None, None), (3, None, None)]


def test_the_central_range_is_central():
    x = np.random.default_rng(3).exponential(size=1000)
    lower, upper = central_interval(x, 0.51)
    assert (lower, upper) == (percentile(x, 24.5), percentile(x, 75.5))
    assert central_interval(x, 0.0) == (median(x), median(x))
    assert [each.value for each in central_interval(x, 1.0)] == [x.min(), x.max()]


def test_one_replicate_gives_a_value_without_an_error():
    estimate = median([1.0, 2.0, 3.0], replicate=[5, 5, 5])
    assert (estimate.value, estimate.error, estimate.interval) == (2.0, None, None)


@pytest.mark.parametrize("weights", [None, [0.0, 0.0]])
def test_no_trials_give_nan(weights):
    estimate = median([] if weights is None else [1.0, 2.0], weights)
    assert math.isnan(estimate.value)
    assert (estimate.error, estimate.interval, estimate.n) == (None, None, 0)


@pytest.mark.parametrize("weights", [None, [2.0]])
def test_one_trial_is_every_percentile_and_bounds_none(weights):
    assert median([7.0], weights).value == 7.0
    assert (median([7.0], weights).error, median([7.0], weights).interval) == (None, None)


@pytest.mark.parametrize("percent", [-1, 100.1, math.nan])
def test_percents_outside_0_and_100_are_refused(percent):
    with pytest.raises(ValueError, match="between 0 and 100"):
        percentile([1.0, 2.0], percent)


@pytest.mark.parametrize("share", [-0.1, 51])
def test_shares_outside_0_and_1_are_refused(share):
    with pytest.raises(ValueError, match="between 0 and 1"):
        central_interval([1.0, 2.0], share)


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


@pytest.mark.parametrize("weights", [None, np.ones(160)])
@pytest.mark.parametrize("step", [1, -1])
def test_equal_trials_are_in_no_order(weights, step):
    """Each replicate has three zeros among ten trials: what lies a little within them, or beyond, is known."""
    x, replicate = np.tile([0.0] * 3 + [1.0] * 7, 16)[::step], np.repeat(np.arange(16), 10)
    for percent, value in ((10.0, 0.0), (24.5, 0.0), (40.0, 1.0), (75.5, 1.0), (90.0, 1.0)):
        result = percentile(x, percent, weights, replicate)
        assert (result.value, result.error, result.interval) == (value, 0.0, (value, value))


def test_replicates_of_independent_equal_trials_have_the_error_of_the_trials():
    x = np.random.default_rng(5).binomial(4, 0.3, 64_000) * 1.0
    for percent in (20.0, 24.1, 50.0, 65.2, 91.6, 95.0):
        alone, grouped = percentile(x, percent), percentile(x, percent, replicate=np.arange(64_000) % 64)
        assert grouped.value == alone.value
        assert grouped.error == pytest.approx(alone.error, abs=0.15)


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


def test_extremes_are_facts_without_an_error():
    assert minimum([3.0, -1.0, 2.0]) == Estimate(-1.0, None, None, 3)
    assert maximum([3.0, -1.0, 2.0]) == Estimate(3.0, None, None, 3)
    assert range_width([3.0, -1.0, 2.0]) == Estimate(4.0, None, None, 3)


def test_a_trial_without_weight_is_no_extreme():
    assert minimum([3.0, -1.0, 2.0], [1.0, 0.0, 1.0]) == Estimate(2.0, None, None, 2)


@pytest.mark.parametrize("statistic", [minimum, maximum, range_width])
def test_no_trials_have_no_extremes(statistic):
    assert math.isnan(statistic([]).value)
    assert statistic([]).n == 0
