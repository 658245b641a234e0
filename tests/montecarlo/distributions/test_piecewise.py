from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, DataError, Piecewise, Truncated

HEIGHTS = st.lists(st.floats(0, 10).map(lambda h: round(h, 3)), min_size=2, max_size=8).filter(lambda h: max(h) > 0)


@pytest.mark.parametrize("peak", [0.25, 0.5, 0.9])
def test_a_triangle(peak, quantiles_agree, moments_agree, draws_fit):
    hill = Piecewise.of_density([10, 10 + 4 * peak, 14], [0, 7, 0])
    oracle = stats.triang(peak, 10, 4)
    quantiles_agree(hill, (), oracle)
    moments_agree(hill, (), oracle)
    draws_fit(hill, (), oracle)


def test_a_trapezoid(quantiles_agree, moments_agree):
    hill = Piecewise.of_density([0, 1, 3, 4], [0, 2, 2, 0])
    quantiles_agree(hill, (), stats.trapezoid(0.25, 0.75, 0, 4))
    moments_agree(hill, (), stats.trapezoid(0.25, 0.75, 0, 4))


def test_a_histogram(quantiles_agree, moments_agree, draws_fit):
    weights = np.array([1.0, 4.0, 2.0, 3.0])
    oracle = stats.rv_histogram((weights, np.linspace(-1, 3, 5)))
    bars = Piecewise.of_weights(-1, 3, weights)
    quantiles_agree(bars, (), oracle)
    moments_agree(bars, (), oracle)
    draws_fit(bars, (), oracle)


def test_a_distribution_function():
    percentiles = Piecewise.of_distribution([1.0, 2.0, 5.0, 6.0], [0.0, 0.5, 0.5, 1.0])
    np.testing.assert_allclose(percentiles.cdf(np.array([0.0, 1.5, 2.0, 4.0, 5.5, 9.0])), [0, 0.25, 0.5, 0.5, 0.75, 1])
    np.testing.assert_allclose(percentiles.ppf(np.array([0.25, 0.75])), [1.5, 5.5])


@given(heights=HEIGHTS, k=st.integers(0, 2**53 - 1))
def test_round_trip(heights, k):
    u = k * 2.0**-53
    line = Piecewise.of_density(np.arange(len(heights)) - 2.0, heights)
    x = line.ppf(u)
    assert -2 <= x <= len(heights) - 3
    assert line.cdf(x) == pytest.approx(u, abs=1e-12)
    assert line.sf(line.isf(u)) == pytest.approx(u, abs=1e-12)


@given(heights=HEIGHTS)
def test_moments_agree_with_a_sum_over_quantiles(heights):
    """Simpson's rule is exact for x·f and x²·f, which are cubic at most on each interval."""
    values = np.arange(len(heights)) * 0.5
    line = Piecewise.of_density(values, heights)
    middles, heights = (values[:-1] + values[1:]) / 2, np.array(heights)
    between = (heights[:-1] + heights[1:]) / 2

    def simpson(power):
        ends = heights * values**power
        return float(np.sum(0.5 / 6 * (ends[:-1] + 4 * between * middles**power + ends[1:])))

    area = float(np.sum(0.5 * between))
    mean = simpson(1) / area
    assert line.mean() == pytest.approx(mean, abs=1e-12)
    assert line.variance() == pytest.approx(simpson(2) / area - mean**2, abs=1e-11)


def test_the_upper_tail_keeps_its_digits():
    hill = Piecewise.of_density([0.0, 1.0], [1.0, 0.0])
    u = np.array([0.0, 0.4, 0.999])
    expected = 1e-6 * np.sqrt(1 - u)
    np.testing.assert_allclose(1 - Truncated(hill).ppf(u, 1 - 1e-6, 1.0), expected, atol=1e-15)
    assert hill.sf(1 - 1e-9) == pytest.approx(1e-18, rel=1e-6)


def test_an_interval_of_height_0_is_never_drawn():
    gap = Piecewise([0.0, 1.0, 2.0, 3.0], [1, 0, 1], [1, 0, 1])
    x = gap.ppf(np.random.default_rng(1).random(1000))
    assert not ((x > 1) & (x < 2)).any()


@pytest.mark.parametrize(
    ("values", "heights"), [([0, 1], [0, 0]), ([1, 0], [1, 1]), ([0, 1, 2], [1, -1, 1]), ([0, 0, 1], [1, 1, 1])]
)
def test_points_that_are_no_density(values, heights):
    with pytest.raises(DataError, match="The points are not a density") as caught:
        Piecewise.of_density(values, heights)
    assert caught.value.hint


def test_it_takes_no_data_of_a_workbook():
    with pytest.raises(TypeError, match="Normal is not built from data"):
        FAMILIES["Normal"].built(np.zeros((2, 1)))
