from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from xlmc.statistics import central_interval, median, percentile, percentiles
from xlmc.statistics.sample import positions_of

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
    found = [percentiles(x, sorted(percents), w) for w in (None, weights)]
    for each in found:
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
