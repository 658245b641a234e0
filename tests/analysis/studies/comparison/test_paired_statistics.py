"""Differences of two runs over the same trials, and their errors.

Coverage: the spread of a difference over 100 independent pairs of runs is known to 1/√(2·100) = 7 % of itself, and
must agree with the mean of the errors stated to 4 times that and 10 % for what is only true of many trials.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.stats import ks_2samp, wasserstein_distance

from xlmc.analysis.studies.comparison.differences import difference
from xlmc.analysis.studies.comparison.paired_statistics import (
    Accepted,
    Pair,
    mean_of,
    quantile_of,
    standard_deviation_of,
)
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.statistics.yes_no import are_yes_no

SAMPLES = arrays(np.float64, st.integers(2, 60), elements=st.floats(-1e6, 1e6).map(lambda x: round(x, 3)))


def run_of(values, trials=None, kind=Kind.NUMBER):
    values = np.asarray(values, np.float64)
    return Accepted.of(np.arange(values.size) if trials is None else np.asarray(trials), values, kind)


def answers_of(values, trials=None):
    return run_of(values, trials, Kind.YES_NO)


def both_ways(rng, n):
    """Two runs that share two of three inputs; each accepts its own half of the trials or so."""
    a, b, c = rng.normal(size=(3, n))
    first, second = a + b, 0.9 * a + b + 0.5 * c + 0.1
    mine, theirs = a > -0.5, a + 0.3 * c > -0.4
    trials = np.arange(n)
    return run_of(first[mine], trials[mine]), run_of(second[theirs], trials[theirs])


STATISTICS = {
    "mean": lambda d: d.mean.difference,
    "SD": lambda d: d.standard_deviation.difference,
    "low": lambda d: d.low.difference,
    "high": lambda d: d.high.difference,
    "kolmogorov": lambda d: d.kolmogorov,
    "wasserstein": lambda d: d.wasserstein,
}


@pytest.fixture(scope="module")
def many():
    rng = np.random.default_rng(999)
    return [difference(*both_ways(rng, 2000), 0.51) for _ in range(100)]


@pytest.mark.parametrize("name", STATISTICS)
def test_errors_are_the_spread_between_runs(many, name):
    result = [STATISTICS[name](each) for each in many]
    spread = np.std([each.value for each in result], ddof=1)
    stated = np.mean([each.error for each in result])
    few = 0.1 if name == "kolmogorov" else 0.0  # whose error is that of many trials
    assert stated == pytest.approx(spread, rel=4 * 0.07 + few)


@pytest.mark.parametrize("name", ["mean", "SD", "low", "high"])
def test_common_draws_make_the_error_smaller_than_that_of_two_runs(many, name):
    apart = {"mean": "mean", "SD": "standard_deviation", "low": "low", "high": "high"}[name]
    changes = [getattr(each, apart) for each in many]
    alone = np.mean([np.hypot(each.first.error, each.second.error) for each in changes])
    assert np.mean([each.difference.error for each in changes]) < 0.9 * alone


def test_runs_without_a_common_trial_have_the_errors_of_two_runs():
    rng = np.random.default_rng(1)
    first, second = run_of(rng.normal(size=500)), run_of(rng.normal(size=700), np.arange(700) + 500)
    for statistic in (mean_of, standard_deviation_of, lambda run: quantile_of(run, 0.3)):
        mine, theirs = statistic(first), statistic(second)
        expected = np.hypot(mine.estimate.error, theirs.estimate.error)
        assert Pair(first, second).difference(mine, theirs).error == pytest.approx(expected, rel=0.005)


def test_a_shift_is_known_exactly():
    values = np.random.default_rng(2).normal(size=1000)
    result = difference(run_of(values), run_of(values + 0.25), 0.51)
    for _, change in result.changes:
        assert change.difference.error < 1e-12
    assert result.mean.difference.value == pytest.approx(0.25, abs=1e-12)
    assert result.standard_deviation.difference.value == pytest.approx(0.0, abs=1e-12)
    assert result.low.difference.value == pytest.approx(0.25, abs=1e-12)
    assert result.wasserstein.value == pytest.approx(0.25, abs=1e-12)
    assert result.largest == pytest.approx(0.25, abs=1e-12)


def test_a_quantile_that_no_trial_crosses_is_not_known_exactly():
    rng = np.random.default_rng(3)
    values = rng.normal(size=400)
    result = difference(run_of(values), run_of(values + 1e-5 * rng.normal(size=400)), 0.51)
    assert abs(result.low.difference.value) < 4 * result.low.difference.error
    assert result.low.difference.error <= 1.2e-5


@given(SAMPLES)
def test_a_run_does_not_differ_from_itself(values):
    assume(not are_yes_no(values))  # of which no number of trials proves that they are the same
    result = difference(run_of(values), run_of(values), 0.51)
    numbers = [change.difference for _, change in result.changes]
    for estimate in (*numbers, result.kolmogorov, result.wasserstein):
        assert estimate.value == 0.0
        assert estimate.error in (0.0, None)
        assert estimate.error == 0.0 or values.size < 30  # so few trials do not tell a quantile's error


@given(SAMPLES, SAMPLES)
def test_the_distances_are_those_of_scipy(first, second):
    result = difference(run_of(first), run_of(second), 0.51)
    assert result.kolmogorov.value == pytest.approx(ks_2samp(first, second, method="asymp").statistic, abs=1e-12)
    assert result.wasserstein.value == pytest.approx(wasserstein_distance(first, second), rel=1e-9, abs=1e-9)


@given(SAMPLES, SAMPLES)
def test_the_other_way_round_is_the_negative(first, second):
    there, back = difference(run_of(first), run_of(second), 0.51), difference(run_of(second), run_of(first), 0.51)
    for (_, a), (_, b) in zip(there.changes, back.changes, strict=True):
        assert a.difference.value == -b.difference.value
        assert a.difference.error == pytest.approx(b.difference.error)


@pytest.mark.parametrize("values", [[2.0] * 50, [0.0] * 20 + [1.0] * 80])
def test_values_that_many_trials_share(values):
    result = difference(run_of(values), run_of(np.array(values) + 1.0), 0.51)
    for _, change in result.changes:
        assert change.difference.error == 0.0
    assert result.high.difference.value == 1.0


def test_trials_without_a_number_are_left_out():
    result = Accepted.of(np.array([3, 5, 8]), np.array([1.0, np.nan, 2.0]))
    assert result.trials.tolist() == [3, 8]


def test_no_trials_are_no_number_and_no_crash():
    result = difference(run_of([]), run_of([1.0, 2.0, 3.0]), 0.51)
    assert np.isnan(result.mean.difference.value)
    assert result.mean.difference.error is None
    assert np.isnan(result.wasserstein.value)


@pytest.mark.parametrize(("share", "changes"), [(0.0, 0.0), (0.02, 0.001), (0.5, 0.03), (0.5, 0.0)])
def test_the_interval_of_a_difference_of_yes_no_answers_holds_it(share, changes):
    """Of trials, each yes with one probability, some change to yes and half as many to no: 400 runs of 2,000."""
    rng, n, held = np.random.default_rng(7), 2_000, 0
    for _ in range(400):
        first, u = rng.random(n) < share, rng.random(n)
        second = np.where(first, u >= changes / 2, u < changes)
        result = difference(answers_of(first), answers_of(second), 0.51, 0.5)
        truth = (1 - share) * changes - share * changes / 2
        for each in (result.mean.difference, result.above.difference):
            assert each.error > 0.0
            assert each.interval[0] <= each.value <= each.interval[1]
        held += result.mean.difference.interval[0] <= truth <= result.mean.difference.interval[1]
        assert result.mean.difference == result.above.difference == result.shares["yes"].difference
        assert result.kolmogorov.error == result.wasserstein.error == result.mean.difference.error
        assert result.standard_deviation.difference.error > 0.0 or share == 0.5
    assert held / 400 >= 0.95 - 3 * np.sqrt(0.95 * 0.05 / 400)


def test_no_yes_in_any_trial_leaves_what_a_share_of_none_leaves():
    result = difference(answers_of(np.zeros(200_000)), answers_of(np.zeros(200_000)), 0.51, 0.5)
    assert result.mean.difference.interval == pytest.approx((-1.92e-5, 1.92e-5), rel=0.01)
    assert result.standard_deviation.difference.error == pytest.approx(4.9e-6**0.5, rel=0.01)
    assert result.kolmogorov.interval == pytest.approx((0.0, 1.92e-5), rel=0.01)


def test_where_the_runs_accept_other_trials_a_share_is_not_known_exactly_either():
    first = answers_of(np.zeros(1_000))
    second = answers_of(np.zeros(1_000), np.arange(1, 1_001))
    result = difference(first, second, 0.51, 0.5)
    assert result.mean.difference.interval == pytest.approx((-0.0038, 0.0038), rel=0.01)


def test_equal_numbers_in_every_trial_are_on_the_same_side_of_a_threshold():
    values = np.random.default_rng(3).normal(size=500)
    result = difference(run_of(values), run_of(values.copy()), 0.51, 5.0)
    assert result.above.difference.error == 0.0
    moved = difference(run_of(values), run_of(values + 0.001), 0.51, 5.0)
    assert moved.above.difference.error > 0.0


def test_a_number_that_is_0_in_all_trials_is_no_answer_of_yes_and_no():
    """=MAX(0, x − 1000) is 0 in every trial of either run, which says nothing of shares."""
    result = difference(run_of(np.zeros(1_000)), run_of(np.zeros(1_000)), 0.51)
    assert not result.shares
    assert [name for name, _ in result.changes] == ["mean", "SD", "lower end", "upper end"]
    assert all(change.difference.error == 0.0 for _, change in result.changes)


def test_texts_are_compared_by_their_shares_whatever_stands_for_them():
    rng, n = np.random.default_rng(5), 5_000
    first = rng.integers(0, 3, n)
    changed = rng.random(n) < 0.1
    second = np.where(changed & (first == 0), 1, first)  # some "low" become "middle"
    one = Accepted.of(np.arange(n), first.astype(float), Kind.CATEGORY, ("low", "middle", "high"))
    codes = np.array([2.0, 0.0, 1.0])  # the second run met its texts in another order
    other = Accepted.of(np.arange(n), codes[second], Kind.CATEGORY, ("middle", "high", "low"))
    result = difference(one, other, 0.51)
    moved = np.mean(first != second)
    assert [*result.shares] == sorted(("low", "middle", "high"), key=lambda t: -result.shares[t].first.value)
    assert result.shares["low"].difference.value == pytest.approx(-moved)
    assert result.shares["middle"].difference.value == pytest.approx(moved)
    assert result.shares["high"].difference.value == 0.0
    assert result.shares["high"].difference.error > 0.0  # that no trial changed does not say that none can
    assert result.typical == pytest.approx(moved**0.5)
    assert result.largest == 1.0


def test_rare_texts_stand_together_and_texts_are_not_compared_with_numbers():
    codes = np.concatenate([np.full(100 - 10 * k, float(k)) for k in range(9)])
    run = Accepted.of(np.arange(codes.size), codes, Kind.CATEGORY, tuple("abcdefghi"))
    result = difference(run, run, 0.51)
    assert [*result.shares] == [*"abcdef", "any other text"]
    assert sum(each.first.value for each in result.shares.values()) == pytest.approx(1.0)
    assert not difference(run, run_of(codes), 0.51).shares
