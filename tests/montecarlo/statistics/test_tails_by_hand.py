"""Hill's index and shapes by L-moments, made by hand, and where their limits lie."""

from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.montecarlo.statistics.estimate import Estimate, finite_json, supported_digits
from xlmc.montecarlo.statistics.heavy_tails import (
    _few_hold_half,
    _is_heavy,
    _shape,
    _tail_index,
    decides_spread,
    farthest_part,
    heavy_tail,
)


def pareto(alpha, n):
    """Quantiles of P(x > t) = t^−α at (i − ½)/n, ascending."""
    return (1.0 - (np.arange(n) + 0.5) / n) ** (-1.0 / alpha)


@pytest.mark.parametrize("n", [400, 1_000, 5_000])
@pytest.mark.parametrize("part", [1.0, 0.25])
def test_hills_index(n, part):
    """One over the mean logarithm of the farthest over the one before them, about the median: 2 %, 40 at least."""
    x = np.sort(np.random.default_rng(1).standard_t(3, n))
    k = max(40, n // 50)
    used = int(part * k)
    tails = np.abs(x - np.median(x))
    upper, lower = np.sort(tails[x > np.median(x)])[::-1], np.sort(tails[x < np.median(x)])[::-1]
    by_hand = min(1.0 / np.mean(np.log(tail[:used] / tail[used])) for tail in (upper, lower))
    index, error = _tail_index(x, part)
    assert index == pytest.approx(by_hand)
    assert error == pytest.approx(by_hand / math.sqrt(k))
    assert _tail_index(1e300 * x)[0] == pytest.approx(_tail_index(x)[0])


def test_too_few_numbers_have_no_index():
    assert _tail_index(pareto(1.0, 399)) == (math.inf, 0.0)
    assert _tail_index(pareto(1.0, 400))[0] < 2.0
    assert _tail_index(np.zeros(400))[0] == math.inf


@pytest.mark.parametrize(("alpha", "heavy"), [(0.5, True), (1.0, True), (1.4, True), (2.2, False), (4.0, False)])
def test_a_tail_is_heavy_where_no_standard_deviation_exists(alpha, heavy):
    result = heavy_tail(pareto(alpha, 5_000))
    assert (result is not None) is heavy
    if heavy:
        assert result[0] == pytest.approx(alpha, rel=0.1)
    mirrored = heavy_tail(np.append(-pareto(alpha, 5_000), [math.nan, math.inf]))
    assert (mirrored is not None) is heavy


def test_a_few_trials_apart_are_no_heavy_tail():
    """The tail as a whole must be heavy, and its far quarter by itself."""
    x = np.append(np.random.default_rng(2).normal(size=4_960), np.geomspace(20.0, 1e6, 40))
    assert heavy_tail(x) is not None
    near = np.append(np.random.default_rng(2).normal(size=4_960), np.linspace(400.0, 410.0, 40))
    assert heavy_tail(near) is None


@pytest.mark.parametrize("shape", [-0.5, 0.0, 0.25, 0.5])
def test_shapes_by_l_moments(shape):
    """Of a generalised Pareto with mean 1/(1 − ξ) and second L-moment 1/((1 − ξ)(2 − ξ))."""
    u = 1.0 - (np.arange(4_000) + 0.5) / 4_000
    beyond = -np.log(1.0 - u) if shape == 0.0 else ((1.0 - u) ** -shape - 1.0) / shape
    assert _shape(beyond) == pytest.approx(shape, abs=0.02)
    descending = np.sort(np.random.default_rng(3).exponential(size=30))[::-1]
    gini = np.mean(np.abs(descending[:, None] - descending[None, :])) / 2.0
    assert _shape(descending) == pytest.approx(2.0 - descending.mean() / gini)


def test_shapes_need_ten_exceedances():
    assert _shape(np.arange(9.0, 0.0, -1.0)) == -math.inf
    assert _shape(np.append(np.arange(9.0, 0.0, -1.0), [0.0] * 9)) == -math.inf  # those at the threshold do not count
    assert _shape(np.arange(10.0, 0.0, -1.0)) == pytest.approx(2.0 - 5.5 / 1.65)
    assert _shape(np.ones(20)) < -1e9  # all alike: no tail at all


@pytest.mark.parametrize(("shape", "heavy"), [(0.05, False), (0.24, True), (0.4, True)])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_spreads_are_decided_by_tails_whose_shape_is_near_a_quarter(shape, heavy, side):
    u = (np.arange(40_000) + 0.5) / 40_000
    x = np.sort(side * ((1.0 - u) ** -shape - 1.0) / shape)
    assert _is_heavy(x) is heavy
    assert not _is_heavy(x[:20])  # of which a fifth are four


def test_ten_trials_that_hold_half_of_the_fourth_powers():
    x = np.sort(np.append(np.random.default_rng(4).normal(size=9_990), [12.0] * 10))
    mean, scale = x.mean(), x.std()
    kurtosis = np.mean(((x - mean) / scale) ** 4)
    share = 10 * ((12.0 - mean) / scale) ** 4 / (kurtosis * 10_000)
    assert share > 0.5
    assert _few_hold_half(x, mean, scale, kurtosis)
    assert not _few_hold_half(x[1:], mean, scale, kurtosis)  # ten are not few among fewer than 10,000
    assert not _few_hold_half(x, mean, scale, 2.05 * share * kurtosis)
    assert _few_hold_half(x, mean, scale, 1.95 * share * kurtosis)
    assert decides_spread(x, mean, scale, kurtosis)


@pytest.mark.parametrize("unit", [1e-200, 1e-10, 1.0, 1e10, 1e200])
@pytest.mark.parametrize(("shape", "decides"), [(1 / 3, True), (1 / 30, False)])
def test_the_unit_of_a_spread_does_not_matter(unit, shape, decides):
    u = (np.arange(4_000) + 0.5) / 4_000
    x = np.sort((1.0 - u) ** -shape)
    assert decides_spread(unit * x, unit * x.mean(), unit * x.std(), 9.0) is decides


@pytest.mark.parametrize(("factor", "decides"), [(0.99, False), (1.01, True)])
def test_a_kurtosis_that_a_normal_forecast_may_have_decides_nothing(factor, decides):
    x = pareto(3.0, 40_000)
    limit = 3.0 + math.sqrt(24.0 / x.size)
    assert decides_spread(x, x.mean(), x.std(), factor * limit) is decides
    assert not decides_spread(np.ones(40_000), 1.0, 0.0, 9.0)


def test_the_farthest_part():
    assert farthest_part([0.0, 0.0, 0.0, 4.0]) == pytest.approx(0.75)
    assert farthest_part([-4.0, 0.0, 0.0, 0.0]) == pytest.approx(0.75)
    assert farthest_part([0.0, 4.0], [3.0, 1.0]) == pytest.approx(0.75)
    assert farthest_part([4.0, 0.0], [3.0, 1.0]) == pytest.approx(0.75)
    assert math.isnan(farthest_part([2.0, 2.0]))
    assert math.isnan(farthest_part([]))


@pytest.mark.parametrize(
    ("error", "digits"),
    [(0.0023, 2), (0.005, 2), (0.0051, 1), (0.05, 1), (0.5, 0), (4.9, -1), (5.1, -2), (0.0, None), (None, None)],
)
def test_digits_that_an_error_supports(error, digits):
    """Two errors are at most one unit of the last digit."""
    assert supported_digits(Estimate(17.0213, error)) == digits


def test_json_has_no_infinite_numbers():
    result = {"a": math.nan, "b": [1.0, math.inf, "x", None], "c": {"d": (2, -math.inf)}}
    assert finite_json(result) == {"a": None, "b": [1.0, None, "x", None], "c": {"d": [2, None]}}
