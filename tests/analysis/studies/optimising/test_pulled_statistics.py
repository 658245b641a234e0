"""Statistics by NumPy; what a trial pulls them by is their slope as it counts a little more."""

from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.analysis.studies.optimising.pulled_statistics import (
    deviation,
    mean,
    quantile,
    share_of_hits,
    share_of_yes,
    variance,
    variation,
)
from xlmc.montecarlo.statistics.proportions import least_error

X = np.array([1.0, 2.0, 4.0, 9.0, 14.0])


@pytest.mark.parametrize(
    ("statistic", "value"),
    [(mean, 6.0), (variance, 29.5), (deviation, math.sqrt(29.5)), (variation, math.sqrt(29.5) / 6)],
)
def test_values(statistic, value):
    """The deviations from 6 are 5, 4, 2, 3 and 8, with squares 118 in all."""
    assert statistic(X)[0] == pytest.approx(value, rel=1e-14)
    assert statistic(X)[2] == 0


def weighted(statistic, x, weights):
    share = weights / weights.sum()
    centre = np.sum(share * x)
    square = np.sum(share * (x - centre) ** 2)
    return {mean: centre, variance: square, deviation: math.sqrt(square), variation: math.sqrt(square) / centre}[
        statistic
    ]


@pytest.mark.parametrize("statistic", [mean, variance, deviation, variation])
def test_pulls_are_slopes(statistic):
    x = np.random.default_rng(1).gamma(3.0, size=4000)
    pulls = statistic(x)[1]
    by = 1e-4
    for trial in (0, 17, 3999):
        weights = np.ones(x.size)
        weights[trial] += by
        slope = (weighted(statistic, x, weights) - weighted(statistic, x, np.ones(x.size))) / by
        assert pulls[trial] == pytest.approx(slope, rel=5e-3, abs=2e-7)


def test_what_does_not_vary_or_has_no_mean():
    same = np.full(4, 3.0)
    assert deviation(same)[0] == 0
    assert deviation(same)[1].tolist() == [0] * 4
    assert math.isnan(variation(np.array([-1.0, 1.0]))[0])
    assert variation(np.array([-1.0, 1.0]))[1].tolist() == [0, 0]


@pytest.mark.parametrize("share", [0.0, 0.1, 0.25, 0.5, 0.77, 1.0])
@pytest.mark.parametrize("n", [2, 5, 101])
def test_quantiles_are_percentile_inc(share, n):
    x = np.random.default_rng(n).normal(size=n)
    value, pulls, least = quantile(x, share)
    assert value == pytest.approx(np.quantile(x, share), rel=1e-13)
    assert pulls.shape == (n,)
    assert pulls.sum() == pytest.approx(0, abs=1e-12)
    assert least >= 0


def test_the_step_of_a_quantile_comes_from_ranks_a_standard_error_to_both_sides():
    """Of 101 squares the median has rank 50, and √(101/4) is 5: 55² - 45² over ten ranks."""
    x = np.random.default_rng(2).permutation(np.arange(101.0) ** 2)
    value, pulls, least = quantile(x, 0.5)
    assert (value, least) == (2500, 100)
    below = x <= 2500
    np.testing.assert_allclose(pulls, (51 / 101 - below) * 100)


def test_at_an_end_the_ranks_stop_there():
    assert quantile(np.arange(11.0) ** 2, 0.0)[2] == 0
    value, _, least = quantile(np.arange(11.0) ** 2, 0.99)  # √(11 · 0.0099) is 0.33, so that both are rank 10
    assert value == pytest.approx(81 + 0.9 * 19)
    assert least == 0


def test_the_error_of_a_quantile_is_its_scatter():
    """A normal median scatters by √(π/2n); 141 steps between ranks know the density to 8.4 %, of which 0.34 is four."""
    x = np.random.default_rng(4).normal(size=20_000)
    error = math.sqrt(np.sum(quantile(x, 0.5)[1] ** 2))
    assert error == pytest.approx(math.sqrt(math.pi / 2 / 20_000), rel=0.34)


def test_shares():
    hits = np.array([True, False, False, True, False])
    share, pulls, least = share_of_hits(hits)
    assert share == 0.4
    np.testing.assert_allclose(pulls, [0.12, -0.08, -0.08, 0.12, -0.08])
    assert least == least_error(5) > 0
    yes = share_of_yes(np.array([1.0, 0.0, 0.0, -3.0, 0.0]))
    assert (yes[0], yes[2]) == (share, least)
    np.testing.assert_array_equal(yes[1], pulls)
