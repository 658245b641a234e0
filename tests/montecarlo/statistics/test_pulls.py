"""Intervals of numbers that a few far trials decide."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from scipy import stats
from scipy.special import ndtri

import xlmc.montecarlo.statistics as xs
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan
from xlmc.montecarlo.statistics.estimate import LENGTHENED, t_quantile, t_range
from xlmc.montecarlo.statistics.pulls import trial_skewness

RUNS = 200
NOISE = 3 * math.sqrt(0.95 * 0.05 / RUNS)

FORECASTS = {
    "exponential": (lambda u: -np.log1p(-u), 1.0, 1.0),
    "lognormal, 1": (lambda u: np.exp(ndtri(u)), stats.lognorm(1).mean(), stats.lognorm(1).std()),
}


@cache
def uniforms(method, trials, seed):
    """The same for every test that asks for them; none changes them."""
    plan = SamplingPlan.of(method, trials)
    u = np.empty(plan.trials)
    plan.margins(seed, ["a"])[0].uniforms(0, u)
    return np.maximum(u, 2.0**-54), plan.replicate_of(np.arange(plan.trials))


def holds(estimate, truth):
    return estimate.interval[0] <= truth <= estimate.interval[1]


@pytest.mark.parametrize("skewness", [0.9, 0.3, 0.01, 1e-5, 1e-12, -0.3])
def test_the_range_solves_halls_cubic_and_is_nowhere_shorter(skewness):
    low, high = t_range(15, 0.95, skewness)
    t, r = t_quantile(15, 0.95), skewness / 6
    longer = t * (1 + LENGTHENED * abs(skewness))
    corrected = [each + 2 * r * each**2 + 4 / 3 * r**2 * each**3 + r for each in (low, high)]
    assert low <= -longer < longer <= high
    skewed = 0 if skewness > 0 else 1  # the side that it is longer on
    assert corrected[skewed] == pytest.approx((-longer, longer)[skewed], rel=1e-9)
    assert t_range(15, 0.95, -skewness) == pytest.approx((-high, -low), rel=1e-12)


def test_without_skewness_it_is_students_t():
    assert t_range(15, 0.95) == (-t_quantile(15, 0.95), t_quantile(15, 0.95))


def test_the_skewness_of_pulls_is_that_of_the_influences():
    x = np.random.default_rng(1).gamma(2.0, size=1000)
    z = (x - x.mean()) / x.std()
    m = xs.Sample.of(x).moments
    for a, b in ((1.0, 0.0), (0.0, 1.0), (-0.7, 0.5)):
        assert trial_skewness(m, (a, b), 1000) == pytest.approx(stats.skew(a * z + b * z * z) / 1000**0.5, rel=1e-9)


@pytest.mark.parametrize("method", ["lhs", "sobol"])
def test_replicates_of_one_skewed_input(method):
    """Student's t of 16 replicates covers 86 to 91 % for the exponential one and 79 to 88 % for a lognormal one."""
    hits = dict.fromkeys(((name, which) for name in FORECASTS for which in ("mean", "deviation")), 0)
    for seed in range(RUNS):
        u, ids = uniforms(method, 1_024, seed)
        for name, (forecast, mean, deviation) in FORECASTS.items():
            sample = xs.Sample.of(forecast(u), None, ids)
            hits[name, "mean"] += holds(xs.mean(sample), mean)
            hits[name, "deviation"] += holds(xs.standard_deviation(sample), deviation)
    for key, count in hits.items():
        assert count / RUNS > 0.95 - NOISE, key


def test_independent_trials_of_a_heavy_tail():
    """Student's t covers 85 % for the mean and 74 % for the SD (σ = 1) of 100 trials."""
    rng, hits = np.random.default_rng(3), [0, 0]
    heavy, less = stats.lognorm(1.5).mean(), stats.lognorm(1.0).std()
    for _ in range(RUNS):
        z = rng.standard_normal(100)
        hits[0] += holds(xs.mean(np.exp(1.5 * z)), heavy)
        hits[1] += holds(xs.standard_deviation(np.exp(z)), less)
    assert min(hits) / RUNS > 0.935 - NOISE


@pytest.mark.parametrize("method", ["lhs", "sobol"])
@pytest.mark.parametrize("share", [0.5071, 0.7493, 0.3009])
def test_a_share_that_the_replicates_agree_on(method, share):
    """1,024 trials: 64 a replicate, of which 32.45, 47.96, 19.26 are expected."""
    hits = 0
    for seed in range(RUNS):
        u, ids = uniforms(method, 1_024, seed)
        hits += holds(xs.share(u < share, None, ids), share)
    assert hits / RUNS > 0.95 - NOISE


def test_equal_replicates_leave_a_share_open_to_both_sides():
    hits, ids = np.tile([1, 0, 0, 0], 80), np.repeat(np.arange(16), 20)
    low, high = xs.share(hits, None, ids).interval
    assert low < 0.25 - 2.5 / 320 < 0.25 + 2.5 / 320 < high


@pytest.mark.parametrize("method", ["lhs", "sobol"])
def test_the_mean_of_a_forecast_that_jumps(method):
    """64 trials a replicate, of which 5.1 lie beyond the step: no replicate of 16 has a sixth in 1 of 5 runs."""
    hits = 0
    for seed in range(RUNS):
        u, ids = uniforms(method, 1_024, seed)
        hits += holds(xs.mean(10.0 * (u < 0.0797), None, ids), 0.797)
    assert hits / RUNS > 0.95 - NOISE


def test_replicates_that_agree_are_no_proof():
    same = xs.mean(np.tile([1.0, 0.0, 0.0, 0.0], 80), None, np.repeat(np.arange(16), 20))
    assert same.error > 0
    assert same.interval == pytest.approx((0.25 - 3.3 / 320, 0.25 + 3.3 / 320), rel=0.01)


def test_far_trials_make_the_error_that_of_independent_trials():
    u, ids = uniforms("lhs", 10_000, 1)
    x = np.exp(ndtri(u))
    sample = xs.Sample.of(x, None, ids)
    assert xs.errors_from_trials(sample) == ["standard deviation"]
    assert xs.standard_deviation(sample).error == pytest.approx(xs.standard_deviation(x).error, rel=1e-3)
    (low, high), (lower, higher) = (xs.standard_deviation(each).interval for each in (x, sample))
    assert lower <= low * 1.001 < high / 1.001 <= higher
    assert xs.errors_from_trials(x) == []


@pytest.mark.parametrize("method", ["mc", "lhs", "sobol"])
def test_ordinary_forecasts_have_no_notice(method):
    for seed in range(5):
        u, ids = uniforms(method, 10_000, seed)
        for x in (ndtri(u), u, np.maximum(ndtri(u), 0.0), np.abs(u - 0.3), ndtri(u) + 6 * (u > 0.4)):
            assert xs.errors_from_trials(x, None, ids) == xs.too_short(x, None, ids) == []


@pytest.mark.parametrize("method", ["mc", "lhs", "sobol"])
@pytest.mark.parametrize("trials", [1_000, 10_000])
def test_a_tail_without_a_fourth_moment_to_speak_of_is_told(method, trials):
    message = 0
    for seed in range(40):
        u, ids = uniforms(method, trials, seed)
        message += "standard deviation" in xs.too_short(np.exp(1.5 * ndtri(u)), None, ids)
    assert message >= 38


def test_nothing_to_tell_of_nothing():
    for values in ([], [1.0], [2.0, 2.0, 2.0]):
        assert xs.too_short(values) == xs.errors_from_trials(values, None, [0] * len(values)) == []
