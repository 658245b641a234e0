from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy import stats

import xlmc.montecarlo.statistics as xs

EXAMPLES = settings(max_examples=25, deadline=None)

SMOOTH = {
    "mean": xs.mean,
    "variance": xs.variance,
    "standard_deviation": xs.standard_deviation,
    "coefficient_of_variation": xs.coefficient_of_variation,
    "skewness": xs.skewness,
    "kurtosis": xs.kurtosis,
    "mean_standard_error": xs.mean_standard_error,
}
EVERY = pytest.mark.parametrize("statistic", SMOOTH.values(), ids=SMOOTH)

numbers = st.lists(st.integers(-1000, 1000), min_size=5, max_size=50).filter(lambda x: len(set(x)) > 2)


def grid(distribution, n=1_000_000):
    """A sample without noise: the quantiles at the middle of n equal shares."""
    return distribution.ppf((np.arange(n) + 0.5) / n)


# Distribution, value, and error times √n, from the closed forms of the central moments.
CLOSED_FORMS = {
    "normal": (
        stats.norm(3, 2),
        {
            "mean": (3, 2),
            "variance": (4, 4 * math.sqrt(2)),
            "standard_deviation": (2, 2 / math.sqrt(2)),
            "coefficient_of_variation": (2 / 3, 2 / 3 * math.sqrt(1 / 2 + 4 / 9)),
            "skewness": (0, math.sqrt(6)),
            "kurtosis": (3, math.sqrt(24)),
        },
    ),
    "uniform": (
        stats.uniform(),
        {
            "mean": (1 / 2, math.sqrt(1 / 12)),
            "variance": (1 / 12, math.sqrt(1 / 180)),
            "standard_deviation": (math.sqrt(1 / 12), math.sqrt(1 / 180) / 2 / math.sqrt(1 / 12)),
            "coefficient_of_variation": (math.sqrt(1 / 3), math.sqrt(1 / 3 * (1 / 3 + 1 / 5))),
            "skewness": (0, math.sqrt(27 / 7 - 6 * 9 / 5 + 9)),
            "kurtosis": (9 / 5, math.sqrt(9 - 81 / 25 - 36 / 5 * (27 / 7 - 9 / 5) + 324 / 25 * 4 / 5)),
        },
    ),
    "exponential": (
        stats.expon(),
        {
            "mean": (1, 1),
            "variance": (1, math.sqrt(8)),
            "standard_deviation": (1, math.sqrt(2)),
            "coefficient_of_variation": (1, 1),
            "skewness": (2, None),
            "kurtosis": (9, None),  # the errors take moments up to 8, which a grid cut at 1e-6 does not have
        },
    ),
}


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_values_and_errors_are_those_of_the_closed_forms(name):
    distribution, expected = CLOSED_FORMS[name]
    sample = xs.Sample.of(grid(distribution))
    for statistic, (value, error) in expected.items():
        estimate = SMOOTH[statistic](sample)
        assert estimate.value == pytest.approx(value, rel=5e-3, abs=1e-9), statistic
        if error is not None:
            assert estimate.error * 1000 == pytest.approx(error, rel=1e-2), statistic


def test_agrees_with_scipy():
    x = np.random.default_rng(5).gamma(3.0, size=501)
    assert xs.mean(x).value == pytest.approx(np.mean(x))
    assert xs.mean(x).error == pytest.approx(stats.sem(x))
    both = np.concatenate([x, -x])  # of a symmetric sample the interval is Student's
    assert xs.mean(both).interval == pytest.approx(stats.t.interval(0.95, 1001, 0.0, stats.sem(both)))
    assert xs.variance(x).value == pytest.approx(np.var(x, ddof=1))
    assert xs.standard_deviation(x).value == pytest.approx(np.std(x, ddof=1))
    assert xs.coefficient_of_variation(x).value == pytest.approx(stats.variation(x, ddof=1))
    assert xs.skewness(x).value == pytest.approx(stats.skew(x))
    assert xs.kurtosis(x).value == pytest.approx(stats.kurtosis(x, fisher=False))
    assert xs.mean_standard_error(x).value == pytest.approx(stats.sem(x))


@pytest.mark.parametrize("n", [100, 1000])
def test_the_error_of_the_variance_is_the_textbooks(n):
    x = np.random.default_rng(n).exponential(size=n)
    s2, m4 = np.var(x, ddof=1), stats.moment(x, 4)
    textbook = (m4 - s2**2 * (n - 3) / (n - 1)) / n
    assert xs.variance(x).error ** 2 == pytest.approx(textbook, rel=10 / n)  # the two differ in 1/n²
    assert xs.standard_deviation(x).error == pytest.approx(xs.variance(x).error / 2 / np.sqrt(s2))
    assert xs.mean_standard_error(x).error == pytest.approx(xs.standard_deviation(x).error / np.sqrt(n))


@EXAMPLES
@given(numbers, st.integers(-1000, 1000))
def test_a_shift_moves_the_mean_alone(values, shift):
    x = np.array(values, dtype=float)
    assert xs.mean(x + shift).value == pytest.approx(xs.mean(x).value + shift, rel=1e-12, abs=1e-9)
    for name in ("standard_deviation", "variance", "skewness", "kurtosis", "mean_standard_error"):
        here, there = SMOOTH[name](x), SMOOTH[name](x + shift)
        assert there.value == pytest.approx(here.value, rel=1e-9, abs=1e-9)
        assert there.error == pytest.approx(here.error, rel=1e-6, abs=1e-6)


POWER = {
    "mean": 1,
    "variance": 2,
    "standard_deviation": 1,
    "coefficient_of_variation": 0,
    "skewness": 0,
    "kurtosis": 0,
    "mean_standard_error": 1,
}


@EXAMPLES
@given(numbers, st.floats(1e-6, 1e6))
def test_a_change_of_unit_scales_value_error_and_interval(values, unit):
    x = np.array(values, dtype=float)
    assume(abs(x.mean()) > 1e-3)
    for name, power in POWER.items():
        here, there = SMOOTH[name](x), SMOOTH[name](x * unit)
        scale = unit**power
        tight = {"rel": 1e-6, "abs": 1e-6 * scale}
        assert there.value == pytest.approx(here.value * scale, **tight)
        assert there.error == pytest.approx(here.error * scale, **tight)
        assert there.interval == pytest.approx(tuple(end * scale for end in here.interval), **tight)


@EVERY
@EXAMPLES
@given(values=numbers, seed=st.integers(0, 99))
def test_the_order_of_the_trials_does_not_matter(statistic, values, seed):
    shuffled = np.random.default_rng(seed).permutation(np.array(values, dtype=float))
    assert statistic(shuffled) == statistic(values)


@EVERY
@EXAMPLES
@given(values=numbers)
def test_equal_weights_are_no_weights(statistic, values):
    plain, weighted = statistic(values), statistic(values, np.full(len(values), 0.7))
    assert weighted.value == pytest.approx(plain.value, rel=1e-9, abs=1e-9, nan_ok=True)
    assert (weighted.error is None) == (plain.error is None)
    if plain.error is not None:
        assert weighted.error == pytest.approx(plain.error, rel=1e-6, abs=1e-6)
        assert weighted.interval == pytest.approx(plain.interval, rel=1e-5, abs=1e-5)


@pytest.mark.parametrize("name", ["mean", "skewness", "kurtosis"])
@EXAMPLES
@given(values=numbers, seed=st.integers(0, 99))
def test_whole_weights_are_repeated_trials(name, values, seed):
    counts = np.random.default_rng(seed).integers(1, 6, len(values))
    weighted, repeated = SMOOTH[name](values, counts), SMOOTH[name](np.repeat(values, counts))
    assert weighted.value == pytest.approx(repeated.value, rel=1e-9, abs=1e-9)


def test_whole_weights_are_repeated_trials_for_the_variance_but_for_its_divisor():
    x, counts = np.array([1.0, 4.0, 6.0]), np.array([3, 1, 2])
    effective = 36 / 14
    population = np.var(np.repeat(x, counts))
    assert xs.variance(x, counts).value == pytest.approx(population * effective / (effective - 1))


@EVERY
@EXAMPLES
@given(values=numbers)
def test_a_replicate_of_one_trial_each_is_no_replicate(statistic, values):
    plain, single = statistic(values), statistic(values, replicate=np.arange(len(values)))
    assert single.value == pytest.approx(plain.value, nan_ok=True)
    if plain.error is not None:
        assert single.error == pytest.approx(plain.error, rel=1e-9, abs=1e-12)
        assert single.interval == pytest.approx(plain.interval, rel=1e-9, abs=1e-12)


def test_the_replicate_error_of_a_mean_is_the_jackknifes():
    rng = np.random.default_rng(6)
    ids = rng.integers(0, 9, 200)
    x, w = rng.normal(size=200) + 0.3 * ids, rng.uniform(0.5, 2, 200)
    pooled = np.average(x, weights=w)
    rest = [(1 - w[ids == r].sum() / w.sum(), np.average(x[ids != r], weights=w[ids != r])) for r in range(9)]
    jackknife = math.sqrt(9 / 8 * sum((share * (each - pooled)) ** 2 for share, each in rest))
    estimate = xs.mean(x, w, ids)
    assert estimate.error == pytest.approx(jackknife, rel=1e-12)
    half = stats.t.ppf(0.975, 8) * jackknife
    low, high = estimate.interval  # not shorter than Student's on either side, and longer on the skewed one
    assert pooled - 1.5 * half < low <= pooled - half < pooled + half <= high < pooled + 1.5 * half


@pytest.mark.parametrize("name", ["variance", "standard_deviation", "coefficient_of_variation", "skewness", "kurtosis"])
def test_replicate_errors_agree_with_an_explicit_jackknife(name):
    rng = np.random.default_rng(7)
    ids = np.repeat(np.arange(20), 500)
    x = 5 + rng.normal(size=10_000) + rng.normal(size=20)[ids] * 0.2  # replicates that differ by more than chance
    statistic = SMOOTH[name]
    rest = np.array([statistic(x[ids != r]).value for r in range(20)])
    jackknife = math.sqrt(19 / 20 * np.sum((rest - statistic(x).value) ** 2))
    assert statistic(x, None, ids).error == pytest.approx(jackknife, rel=0.05)


@EVERY
def test_one_replicate_gives_a_value_without_an_error(statistic):
    x = np.random.default_rng(8).normal(size=50)
    estimate = statistic(x, replicate=np.zeros(50, dtype=int))
    assert (estimate.error, estimate.interval) == (None, None)


@EVERY
@pytest.mark.parametrize("weights", [None, []])
def test_no_trials_give_nan(statistic, weights):
    estimate = statistic([], weights)
    assert math.isnan(estimate.value)
    assert (estimate.error, estimate.interval, estimate.n) == (None, None, 0)


def test_one_trial_has_a_mean_and_no_spread():
    assert xs.mean([4.0]) == xs.Estimate(4.0, n=1)
    for name in ("variance", "standard_deviation", "skewness", "kurtosis", "mean_standard_error"):
        assert math.isnan(SMOOTH[name]([4.0]).value)


@pytest.mark.parametrize("weights", [None, np.ones(7)])
def test_equal_values_have_no_spread_and_no_shape(weights):
    x = np.full(7, 0.1)
    for name in ("variance", "standard_deviation", "coefficient_of_variation", "mean_standard_error"):
        estimate = SMOOTH[name](x, weights)
        assert (estimate.value, estimate.error, estimate.interval) == (0.0, 0.0, (0.0, 0.0))
    assert math.isnan(xs.skewness(x, weights).value)
    assert math.isnan(xs.kurtosis(x, weights).value)


def test_too_few_trials_to_know_the_shape():
    assert xs.skewness([1.0, 2.0]).error is None
    assert xs.kurtosis([1.0, 2.0, 4.0]).error is None
    assert xs.kurtosis([1.0, 2.0, 4.0, 9.0]).error > 0


def test_the_coefficient_of_variation_keeps_the_sign_of_the_mean():
    assert xs.coefficient_of_variation([-1.0, -2.0, -3.0]).value == pytest.approx(-0.5)
    assert math.isnan(xs.coefficient_of_variation([-1.0, 1.0]).value)


def test_confidence_widens_the_interval_and_not_the_error():
    x = np.random.default_rng(9).normal(size=40)
    usual, wide = xs.mean(x), xs.mean(x, confidence=0.99)
    assert wide.error == usual.error
    assert wide.interval[1] - wide.interval[0] > usual.interval[1] - usual.interval[0]
