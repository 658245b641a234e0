"""Forecasts of zeros and ones: every number's interval comes from that of the share."""

from __future__ import annotations

import math

import numpy as np
import pytest

import xlmc.montecarlo.statistics as xs
from xlmc.montecarlo.loop.stopping.progress import RunningMoments
from xlmc.montecarlo.statistics import Estimate
from xlmc.montecarlo.statistics.yes_no import coefficient_of_share, deviation_of_share, variance_of_share


@pytest.fixture(params=["plain", "weighted", "replicated"])
def kind(request):
    """Weights and replicates of 2,000 trials."""
    rng = np.random.default_rng(1)
    return {
        "plain": (None, None),
        "weighted": (rng.random(2_000), None),
        "replicated": (None, np.arange(2_000) // 125),
    }[request.param]


@pytest.mark.parametrize("ones", [0, 1, 20, 1_000, 1_999, 2_000])
def test_the_mean_is_the_share_with_its_interval(ones, kind):
    weights, replicate = kind
    x = np.random.default_rng(2).permutation(np.arange(2_000) < ones).astype(float)
    mean, share = xs.mean(x, weights, replicate), xs.probability_above(x, 0.5, weights, replicate)
    assert mean == share
    low, high = mean.interval
    assert low < high
    deviation = xs.standard_deviation(x, weights, replicate)
    assert deviation.interval[0] <= deviation.value <= deviation.interval[1]
    assert deviation.error > 0.0
    inside = 0.5 if low < 0.5 < high else max(math.sqrt(p * (1.0 - p)) for p in (low, high))
    assert deviation.interval[1] == pytest.approx(max(inside, deviation.value))
    assert xs.variance(x, weights, replicate).interval[1] == pytest.approx(deviation.interval[1] ** 2)


def test_no_failure_in_200_000_trials():
    x = np.zeros(200_000)
    result = xs.describe(x, threshold=0.5)
    assert result.mean == result.probability_above
    assert result.mean.interval[1] == pytest.approx(1.92e-5, rel=0.05)
    assert result.mean_standard_error.value > 0.0
    assert result.median.interval == (0.0, 0.0)  # no share that agrees with the trials moves it


def test_percentiles_do_not_leave_zero_and_one():
    result = xs.percentiles(np.zeros(100), [50, 99.9])
    assert result[50.0].interval == (0.0, 0.0)
    assert result[99.9].interval == (0.0, 1.0)


@pytest.mark.parametrize("ones", [1, 3])
def test_a_few_failures_give_no_notice_of_a_tail(ones):
    x = np.zeros(200_000)
    x[:ones] = 1.0
    assert xs.too_short(x) == []
    assert xs.errors_from_trials(x, None, np.arange(200_000) // 12_500) == []


@pytest.mark.parametrize(("p", "n"), [(1e-3, 1_000), (0.02, 500), (0.5, 400), (0.97, 500)])
def test_intervals_hold(p, n):
    """In 400 runs, 95 % less 4 binomial errors; Wilson's coverage swings by 2 %."""
    rng, truth, hits = np.random.default_rng(3), math.sqrt(p * (1.0 - p)), np.zeros(2)
    for _ in range(400):
        x = (rng.random(n) < p).astype(float)
        for which, (result, true) in enumerate(((xs.mean(x), p), (xs.standard_deviation(x), truth))):
            hits[which] += result.interval[0] <= true <= result.interval[1]
    assert (hits / 400 > 0.95 - 4.0 * math.sqrt(0.05 * 0.95 / 400) - 0.01).all()


@pytest.mark.parametrize("ones", [0, 5, 400])
def test_stop_rules_see_the_same(ones):
    x = np.random.default_rng(4).permutation(np.arange(1_000) < ones).astype(float)
    running = RunningMoments()
    for part in np.split(x, 4):
        running.add(part)
    assert running.mean().interval == pytest.approx(xs.mean(x).interval)
    assert running.standard_deviation().interval == pytest.approx(xs.standard_deviation(x).interval)


Z = 1.959963984540054


@pytest.mark.parametrize(
    ("share", "interval", "deviation", "coefficient"),
    [
        (0.1, (0.05, 0.2), (0.05 * 0.95, 0.2 * 0.8), (2.0, math.sqrt(19.0))),
        (0.9, (0.8, 0.95), (0.95 * 0.05, 0.8 * 0.2), (math.sqrt(1 / 19), 0.5)),
        (0.4, (0.3, 0.6), (0.3 * 0.7, 0.25), (math.sqrt(2 / 3), math.sqrt(7 / 3))),  # greatest at a half
        (0.6, (0.2, 0.7), (0.2 * 0.8, 0.25), (math.sqrt(3 / 7), 2.0)),
        (0.5, (0.5, 0.7), (0.7 * 0.3, 0.25), (math.sqrt(3 / 7), 1.0)),
        (0.0, (0.0, 0.2), (0.0, 0.2 * 0.8), (2.0, math.inf)),
        (1.0, (0.8, 1.0), (0.0, 0.8 * 0.2), (0.0, 0.5)),
    ],
)
def test_numbers_that_follow_from_the_interval_of_a_share(share, interval, deviation, coefficient):
    """The variance p(1 − p), its root, and √((1 − p)/p), where the interval of p leads."""
    given = Estimate(share, 0.03, interval, 500)
    variance = share * (1.0 - share)
    result = variance_of_share(given, variance)
    assert result.interval == pytest.approx(deviation)
    assert (result.value, result.error) == (variance, pytest.approx((deviation[1] - deviation[0]) / 2 / Z))
    result = deviation_of_share(given, math.sqrt(variance))
    low, high = map(math.sqrt, deviation)
    assert result.interval == pytest.approx((low, high))
    assert result.error == pytest.approx((high - low) / 2 / Z)
    if share:
        result = coefficient_of_share(given, math.sqrt((1.0 - share) / share))
        assert result.interval == pytest.approx(coefficient)
        assert result.error == pytest.approx((coefficient[1] - coefficient[0]) / 2 / Z)
        assert result.n == 500


def test_without_an_interval_or_a_value_nothing_follows():
    assert variance_of_share(Estimate(0.1, 0.03, None, 500), 0.09) == Estimate(0.09, n=500)
    unknown = coefficient_of_share(Estimate(0.0, 0.03, (0.0, 0.2), 500), math.inf)
    assert (unknown.error, unknown.interval) == (None, None)
    wide = coefficient_of_share(Estimate(0.1, 0.03, (0.0, 0.2), 500), 3.0)
    assert (wide.error, wide.interval) == (None, (2.0, math.inf))
    narrower = variance_of_share(Estimate(0.1, 0.03, (0.05, 0.2), 500), 0.09, confidence=0.5)
    assert narrower.error == pytest.approx((0.16 - 0.0475) / 2 / 0.6744897501960817)
