from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats
from scipy.special import bdtr, betaln, xlog1py, xlogy

from xlmc.montecarlo.statistics import (
    inverse_proportion,
    mean,
    probability_above,
    probability_between,
    proportion,
    replicated_proportion,
    share,
)

EXAMPLES = settings(max_examples=50, deadline=None)

counts = st.integers(1, 5000).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n)))


@pytest.mark.parametrize(("method", "theirs"), [("wilson", "wilson"), ("clopper-pearson", "exact")])
@pytest.mark.parametrize("confidence", [0.8, 0.95, 0.99])
@EXAMPLES
@given(case=counts)
def test_intervals_are_scipys(method, theirs, confidence, case):
    """Wilson's ends no nearer than those that leave both tails on one side, as Brown, Cai & DasGupta 2001 have it."""
    hits, trials = case
    low, high = stats.binomtest(hits, trials).proportion_ci(confidence, method=theirs)
    if method == "wilson":
        low = min(low, stats.binomtest(hits, trials, alternative="greater").proportion_ci(confidence).low)
        high = max(high, stats.binomtest(hits, trials, alternative="less").proportion_ci(confidence).high)
    result = proportion(hits, trials, confidence=confidence, method=method).interval
    assert result == pytest.approx((low, high), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("trials", [20, 1000, 200_000])
def test_shares_of_a_few_in_all_trials_are_covered(trials):
    """The exact coverage, no simulation: for every share from 0.01 hits on, 92.5 % or more; Wilson's own has 84 %."""
    ends = np.array([proportion(hits, trials).interval for hits in range(min(trials, 200) + 1)])
    wilson = np.array([stats.binomtest(hits, trials).proportion_ci(method="wilson") for hits in range(len(ends))])
    shares = np.geomspace(0.01, min(trials / 2, 60), 300) / trials
    chances = stats.binom.pmf(np.arange(len(ends)), trials, shares[:, None])
    ours, theirs = (
        np.sum(chances * ((result[:, 0] <= shares[:, None]) & (shares[:, None] <= result[:, 1])), axis=1)
        for result in (ends, wilson)
    )
    assert ours.min() > 0.925
    assert theirs.min() < 0.85


@EXAMPLES
@given(counts)
def test_a_proportion_is_never_0_plus_minus_0(case):
    hits, trials = case
    estimate = proportion(hits, trials)
    low, high = estimate.interval
    assert estimate.value == hits / trials
    assert estimate.n == trials
    assert estimate.error > 0
    assert 0 <= low <= estimate.value <= high <= 1
    assert low < high


def test_the_error_is_the_binomial_one():
    assert proportion(30, 120).error == pytest.approx(math.sqrt(0.25 * 0.75 / 120))


def test_no_success_has_half_of_wilsons_interval_as_error():
    z = 1.959963984540054
    estimate = proportion(0, 1000)
    assert estimate.error == pytest.approx(estimate.interval[1] / 2 / z)
    assert proportion(1000, 1000).error == pytest.approx(estimate.error)
    assert proportion(0, 1000, confidence=0.5).error == estimate.error


def test_no_trials_give_nan():
    for estimate in (proportion(0, 0), replicated_proportion([0, 0], [0, 0]), share([]), share([], [], [])):
        assert math.isnan(estimate.value)
        assert (estimate.error, estimate.interval, estimate.n) == (None, None, 0)


@pytest.mark.parametrize(("hits", "trials"), [(-1, 4), (5, 4)])
def test_impossible_counts_are_refused(hits, trials):
    with pytest.raises(ValueError, match="successes"):
        proportion(hits, trials)
    with pytest.raises(ValueError, match="successes"):
        replicated_proportion([hits, 1], [trials, 4])


def test_counts_must_pair():
    with pytest.raises(ValueError, match="per replicate"):
        replicated_proportion([1, 2], [4])


def test_share_counts_trials_that_are_true():
    hits = np.array([True, False, True, True])
    assert share(hits) == proportion(3, 4)
    assert share(hits, [1.0, 3.0, 1.0, 1.0]).value == pytest.approx(0.5)


@EXAMPLES
@given(st.lists(st.integers(0, 9), min_size=1, max_size=50), st.integers(-1, 10))
def test_above_means_strictly_above(values, threshold):
    assert probability_above(values, threshold) == proportion(sum(x > threshold for x in values), len(values))


def test_the_weighted_error_is_that_of_a_weighted_mean():
    rng = np.random.default_rng(1)
    x, w = rng.normal(size=500), rng.uniform(0.2, 3, 500)
    indicator = mean((x > 0.3).astype(float), w)
    estimate = probability_above(x, 0.3, w)
    assert estimate.value == pytest.approx(indicator.value)
    assert estimate.error == pytest.approx(indicator.error)
    assert estimate.interval == pytest.approx(indicator.interval, abs=0.003)  # symmetric there, Wilson's here


@pytest.mark.parametrize("method", ["wilson", "clopper-pearson"])
def test_equal_weights_are_nearly_no_weights(method):
    """The error divides by n − 1 and the interval takes Student's t: at 400 trials below 1 %."""
    x = np.random.default_rng(2).normal(size=400)
    plain = probability_above(x, 1.0, method=method)
    weighted = probability_above(x, 1.0, np.full(400, 2.0), method=method)
    assert weighted.error == pytest.approx(plain.error, rel=0.01)
    assert weighted.interval == pytest.approx(plain.interval, rel=0.01)


def test_replicated_counts_and_trials_with_ids_agree():
    rng = np.random.default_rng(3)
    ids = rng.integers(0, 12, 900)
    hits = rng.random(900) < 0.2 + 0.02 * ids
    by_trial = share(hits, replicate=ids)
    by_count = replicated_proportion(np.bincount(ids, weights=hits), np.bincount(ids))
    assert by_trial.value == pytest.approx(by_count.value)
    assert by_trial.error == pytest.approx(by_count.error)
    assert by_trial.interval == pytest.approx(by_count.interval)
    assert by_trial.n == by_count.n == 900


def test_the_replicated_error_is_the_spread_between_replicates():
    hits, trials = np.array([20, 30, 25, 37]), np.full(4, 100)
    estimate = replicated_proportion(hits, trials)
    assert estimate.value == 0.28
    assert estimate.error == pytest.approx(np.std(hits / 100, ddof=1) / 2)


def test_a_narrow_replicated_interval_is_students():
    hits, trials = np.array([5012, 4991, 5003, 4987, 5021]), np.full(5, 10_000)
    estimate = replicated_proportion(hits, trials)
    half = stats.t.ppf(0.975, 4) * np.std(hits / 10_000, ddof=1) / math.sqrt(5)
    assert estimate.interval == pytest.approx((estimate.value - half, estimate.value + half), rel=1e-4)


@pytest.mark.parametrize(
    ("more", "end"),
    [(0, 0), (0, 1), (1, 1), (19, 0)],
    ids=["all agree, below", "all agree, above", "one has a hit more", "one has a hit less"],
)
def test_replicates_that_differ_by_one_hit_have_a_binomial_interval(more, end):
    """20 replicates of 100 trials with 24 hits, or with 25: how many have 25 is a binomial number."""
    hits = np.full(20, 24.0)
    hits[:more] += 1.0
    result = replicated_proportion(hits, np.full(20, 100.0), method="clopper-pearson").interval
    ends = stats.binomtest(more, 20).proportion_ci(0.95, method="exact")
    share_of_more = -ends.high if more == end == 0 else ends[end]
    assert result[end] == pytest.approx((24.0 + share_of_more) / 100.0, rel=1e-12)


@pytest.mark.parametrize("hits", [[24.0, 26.0] * 10, [24.0] * 19 + [26.0], [23.0] + [24.0] * 18 + [25.0]])
def test_replicates_that_differ_by_more_have_the_interval_of_their_spread(hits):
    result = replicated_proportion(hits, np.full(20, 100.0), method="clopper-pearson")
    half = stats.t.ppf(0.975, 19) * np.std(hits, ddof=1) / 100.0 / math.sqrt(20)
    assert result.interval[1] - result.interval[0] == pytest.approx(2.0 * half, rel=0.05)


def test_replicates_that_all_agree_still_leave_an_error():
    estimate = replicated_proportion([24, 24, 24], [100, 100, 100])
    assert estimate.error == proportion(0, 300).error > 0
    assert estimate.interval[0] < 0.24 < estimate.interval[1]


@pytest.mark.parametrize("hits", [0, 100])
def test_replicates_without_success_or_failure_have_the_interval_of_independent_trials(hits):
    pooled, plain = replicated_proportion([hits] * 3, [100] * 3), proportion(3 * hits, 300)
    assert (pooled.error, pooled.interval) == (plain.error, plain.interval)


def test_weighted_trials_without_success_still_leave_an_error():
    estimate = probability_above([1.0, 2.0, 3.0], 9.0, [1.0, 2.0, 1.0])
    assert estimate.value == 0.0
    assert estimate.error > 0
    assert estimate.interval[0] == 0.0 < estimate.interval[1]


def test_one_replicate_gives_a_value_without_an_error():
    estimate = replicated_proportion([39], [40])
    assert (estimate.value, estimate.error, estimate.interval) == (0.975, None, None)
    assert share([True, False], replicate=[1, 1]).error is None


@pytest.mark.parametrize("replicated", [False, True])
def test_the_share_between_is_the_rest_of_those_below_and_above(replicated):
    x = np.random.default_rng(3).normal(0.0, 1.0, 2000)
    replicate = np.arange(2000) // 125 if replicated else None
    result = probability_between(x, -0.5, np.inf, replicate=replicate)
    below = probability_above(-x, 0.5, replicate=replicate)
    assert result.value == pytest.approx(1.0 - below.value, abs=1e-12)
    assert result.error == pytest.approx(below.error, rel=1e-9)
    inside = share((x >= -0.5) & (x <= 0.3), replicate=replicate)
    assert probability_between(x, -0.5, 0.3, replicate=replicate) == inside


def test_ends_belong_to_the_range_and_a_range_runs_upwards():
    assert probability_between([1.0, 2.0, 2.0, 3.0], 2.0, 2.0).value == 0.5
    with pytest.raises(ValueError, match="cannot reach from 2 to 1"):
        probability_between([1.0], 2, 1)


def waiting_times(successes, p):
    """Numbers of trials until so many successes, and their probabilities; what is left out is below 1e-12."""
    n = np.arange(successes, int(successes / p * 8 + 200 / p))
    choose = -np.log(n) - betaln(n - successes + 1, successes)
    return n, np.exp(choose + xlogy(successes, p) + xlog1py(n - successes, -p))


CASES = [(2, 0.5), (2, 0.05), (5, 0.3), (20, 0.0176), (50, 0.6)]


@pytest.mark.parametrize(("successes", "p"), CASES)
def test_it_is_unbiased_and_so_is_its_variance(successes, p):
    n, weights = waiting_times(successes, p)
    assert weights.sum() == pytest.approx(1.0, abs=1e-9)
    result = (successes - 1) / (n - 1)
    assert (weights * result).sum() == pytest.approx(p, rel=1e-9)
    assert (weights * successes / n).sum() > p  # what it is not
    estimates = [inverse_proportion(successes, int(each)).value for each in n[:50]]
    assert estimates == pytest.approx(result[:50].tolist(), rel=1e-15)
    if successes > 2:
        errors = np.array([inverse_proportion(successes, int(each)).error for each in n[1:50]])
        assert errors**2 == pytest.approx(result[1:50] * (1 - result[1:50]) / (n[1:50] - 2), rel=1e-12)
        variance = (weights * (result - p) ** 2).sum()
        keep = n > 2
        estimated = (weights * result * (1 - result) / np.where(keep, n - 2, 1))[keep].sum()
        assert estimated == pytest.approx(variance, rel=1e-6)


@pytest.mark.parametrize(("successes", "p"), CASES)
@pytest.mark.parametrize("confidence", [0.9, 0.95])
def test_either_end_misses_in_no_more_than_a_tail(successes, p, confidence):
    n, weights = waiting_times(successes, p)
    common = weights > 1e-9
    ends = np.array([inverse_proportion(successes, int(each), confidence=confidence).interval for each in n[common]])
    tail = (1 - confidence) / 2
    assert weights[common][ends[:, 0] > p].sum() <= tail + 1e-9
    assert weights[common][ends[:, 1] < p].sum() <= tail + 1e-9


def test_the_ends_are_where_the_observed_is_as_rare_as_a_tail():
    low, high = inverse_proportion(20, 1000).interval
    assert 1.0 - bdtr(19, 1000, low) == pytest.approx(0.025, rel=1e-9)  # as few trials, or fewer
    assert bdtr(19, 999, high) == pytest.approx(0.025, rel=1e-9)  # as many, or more


def test_every_trial_a_success():
    result = inverse_proportion(50, 50)
    assert result.value == 1.0
    assert result.error > 0.0
    assert result.interval[1] == 1.0
    assert 0.9 < result.interval[0] < 1.0
    assert inverse_proportion(2, 2).value == 1.0


def test_seeded_replicates():
    """20,000 runs: the mean of the estimates lies within 4 of its standard errors."""
    draws = np.random.default_rng(5).negative_binomial(10, 0.02, 20_000) + 10
    result = np.array([inverse_proportion(10, int(n)).value for n in draws])
    assert abs(result.mean() - 0.02) < 4 * result.std() / np.sqrt(result.size)


@pytest.mark.parametrize(("successes", "trials"), [(1, 5), (0, 5), (6, 5)])
def test_what_cannot_be(successes, trials):
    with pytest.raises(ValueError, match="successes, waited for in"):
        inverse_proportion(successes, trials)
