from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.statistics import Sample, mode
from xlmc.montecarlo.statistics.mode import half_sample_mode, half_sample_modes

EXAMPLES = settings(max_examples=50, deadline=None)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ([5.0], 5.0),
        ([1.0, 2.0], 1.5),
        ([1.0, 2.0, 4.0], 1.5),
        ([1.0, 3.0, 4.0], 3.5),
        ([1.0, 2.0, 3.0], 2.0),
        ([0.0, 5.0, 5.0, 9.0], 5.0),
        ([0.0, 4.0, 4.1, 4.2, 30.0], 4.1),
        # the densest half is 2.0 … 2.6, of which 2.0 … 2.3, of which the closer pair
        ([0.0, 1.0, 2.0, 2.1, 2.3, 2.6, 5.0, 9.0], 2.05),
        (list(range(11)), 4.0),
        ([3.0] * 20, 3.0),
    ],
)
@pytest.mark.parametrize("weight", [None, 0.4])
def test_small_samples_by_hand(values, expected, weight):
    weights = None if weight is None else np.full(len(values), weight)
    assert mode(values, weights).value == pytest.approx(expected)


def test_weight_draws_the_mode():
    x = np.concatenate([np.linspace(0, 1, 50), np.linspace(10, 11, 60)])
    assert mode(x).value > 9
    assert mode(x, np.where(x < 5, 2.0, 1.0)).value < 2


def test_half_of_the_weight_on_one_trial_is_the_mode():
    assert mode([1.0, 2.0, 3.0, 4.0, 9.0], [1.0, 1.0, 1.0, 1.0, 6.0]).value == 9.0


def test_a_grid_that_is_densest_at_the_peak_gives_the_peak():
    n = 20_001
    x = stats.norm(5, 2).ppf((np.arange(n) + 0.5) / n)
    assert mode(x).value == pytest.approx(5.0, abs=0.01)


@EXAMPLES
@given(st.lists(st.integers(-100, 100), min_size=1, max_size=80), st.integers(-50, 50), st.sampled_from([0.25, 2.0]))
def test_follows_a_change_of_unit_and_origin(values, shift, scale):
    x = np.array(values, dtype=float)
    here, there = mode(x), mode(x * scale + shift)
    assert there.value == pytest.approx(here.value * scale + shift)
    assert (here.error is None) == (there.error is None) == (len(values) < 16)
    if here.error is not None:
        assert there.error == pytest.approx(here.error * scale)


@EXAMPLES
@given(st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=60, unique=True))
def test_equal_weights_are_no_weights(values):
    plain, weighted = mode(values), mode(values, np.full(len(values), 2.0))
    assert min(values) <= plain.value <= max(values)
    if len(values) == 1 or np.diff(np.sort(values)).min() > 1e-6:  # below, rounding decides which pair is closer
        assert weighted.value == pytest.approx(plain.value, rel=1e-9, abs=1e-9)


@EXAMPLES
@given(st.lists(st.integers(-100, 100), min_size=16, max_size=80), st.integers(0, 99))
def test_the_order_of_the_trials_does_not_matter(values, seed):
    assert mode(np.random.default_rng(seed).permutation(values)) == mode(values)


@pytest.mark.parametrize(
    ("distribution", "n"),
    [(stats.norm(), 200), (stats.lognorm(0.5), 200), (stats.lognorm(0.5), 1000), (stats.beta(2, 2), 200)],
)
def test_the_error_is_the_spread_from_run_to_run(distribution, n):
    """80 runs know a spread to 8 %; the fifth-root law holds to some 25 %: 0.7 to 1.5."""
    rng = np.random.default_rng(n)
    runs = [mode(distribution.rvs(n, random_state=rng)) for _ in range(80)]
    spread = np.std([each.value for each in runs], ddof=1)
    assert 0.7 < np.mean([each.error for each in runs]) / spread < 1.5


def test_sorted_trials_have_the_same_error():
    x = np.random.default_rng(1).normal(size=1000)
    assert mode(np.sort(x)).error == mode(x).error > 0


def test_the_weighted_error_is_near_that_of_equal_trials():
    x = np.random.default_rng(2).normal(size=4000)
    w = np.random.default_rng(3).uniform(0.8, 1.2, 4000)
    assert mode(x, w).error == pytest.approx(mode(x).error, rel=0.5)


def test_replicates_are_the_groups():
    rng = np.random.default_rng(4)
    x, ids = rng.normal(size=600), np.repeat(np.arange(6), 100)
    modes = [mode(x[ids == r]).value for r in range(6)]
    estimate = mode(x, replicate=ids)
    assert estimate.value == mode(x).value
    assert estimate.error == pytest.approx(np.std(modes, ddof=1) / 6**0.2)


def test_too_few_trials_or_replicates_have_no_error():
    assert mode(np.arange(15.0)).error is None
    assert mode(np.arange(16.0)).error is not None
    assert mode(np.arange(100.0), replicate=np.zeros(100, dtype=int)).error is None


def test_the_mode_of_whole_numbers_has_whole_ends_and_no_error_where_these_are_equal():
    clear = np.random.default_rng(3).binomial(4, 0.5, 20_000) * 1.0  # 2 is by a third more frequent than 1 or 3
    estimate = mode(clear)
    assert (estimate.value, estimate.error, estimate.interval) == (2.0, 0.0, (2.0, 2.0))
    close = np.random.default_rng(3).poisson(3.0, 20_000) * 1.0  # 2 and 3 are equally frequent
    low, high = mode(close).interval
    assert (low.is_integer(), high.is_integer()) == (True, True)
    assert low <= 2.0
    assert high >= 3.0
    assert mode(close).error > 0.1
    halves = mode(close / 2.0)  # no whole numbers, so that nothing is rounded
    assert halves.interval[1] - halves.value == pytest.approx(stats.t(31).ppf(0.975) * halves.error)


def test_no_trials_give_nan():
    assert math.isnan(mode([]).value)
    assert (mode([]).error, mode([]).interval, mode([]).n) == (None, None, 0)


@pytest.mark.parametrize("size", [2, 3, 4, 31, 500])
@pytest.mark.parametrize(
    "draw",
    [
        lambda random, shape: random.lognormal(size=shape),
        lambda random, shape: random.integers(0, 9, shape) * 1.0,
        lambda random, shape: random.integers(0, 3 * shape[1], shape) / 10,
        lambda random, shape: np.where(random.random(shape) < 0.45, 1.0, random.random(shape)),
        lambda random, shape: random.choice([-1, 1], shape) * 1.7e308 * random.random(shape),
    ],
    ids=["continuous", "counts", "rounded", "partly equal", "as large as doubles"],
)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_the_modes_of_groups_are_those_of_each_alone(draw, size):
    rows = np.sort(draw(np.random.default_rng(5), (32, size)), axis=1)
    alone = [half_sample_mode(Sample.of(row)) for row in rows]
    np.testing.assert_array_equal(half_sample_modes(rows), alone)
