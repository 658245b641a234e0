from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.distributions import Truncated
from xlmc.montecarlo.distributions.empirical_smoothed import EmpiricalSmoothed, silverman
from xlmc.montecarlo.distributions.parameters import DataError

RNG = np.random.default_rng(20010311)
SAMPLES = {
    "five": RNG.normal(0.77, 0.05, 5),
    "540": RNG.gamma(3.0, 2.0, 540),
    "two heaps": np.concatenate([RNG.normal(0, 1, 40), RNG.normal(500, 1, 40)]),
    "ties": np.repeat([1.0, 2.0, 5.0], [3, 1, 9]),
}


@pytest.fixture(params=SAMPLES.values(), ids=SAMPLES)
def smoothed(request):
    return EmpiricalSmoothed(request.param, silverman(request.param))


def test_the_distribution_function_is_a_mean_of_normals(smoothed):
    x = np.linspace(*smoothed.support(), 301)
    normals = stats.norm(smoothed.values[:, None], smoothed.bandwidth)
    np.testing.assert_allclose(smoothed.cdf(x), normals.cdf(x).mean(axis=0), rtol=1e-12, atol=1e-16)
    np.testing.assert_allclose(smoothed.sf(x), normals.sf(x).mean(axis=0), rtol=1e-12, atol=1e-16)


def test_against_scipys_density(smoothed):
    """SciPy's estimate with the same bandwidth, integrated."""
    kde = stats.gaussian_kde(smoothed.values, bw_method=smoothed.bandwidth / smoothed.values.std(ddof=1))
    for x in smoothed.ppf(np.array([0.05, 0.4, 0.77])):
        assert smoothed.cdf(x) == pytest.approx(kde.integrate_box_1d(-np.inf, x), abs=1e-12)


def test_quantiles_are_right_to_the_last_digits(smoothed):
    u = np.concatenate([[2.0**-53, 1e-12, 1e-6], np.linspace(0.0005, 0.9995, 2001), [1 - 1e-9]])
    x = smoothed.ppf(u)
    np.testing.assert_allclose(smoothed.cdf(x), u, rtol=1e-9, atol=1e-14)
    assert (np.diff(x) >= 0).all()
    np.testing.assert_allclose(smoothed.sf(smoothed.isf(u)), u, rtol=1e-9, atol=1e-14)


def test_the_table_of_quantiles_holds_the_distribution_function_at_the_edges_of_every_cell(smoothed):
    """At the far left, too, where it is some 1e-19, and up to the next edge by a polynomial."""
    edges, (at_edge, series) = smoothed._edges, smoothed._table
    normals = stats.norm(smoothed.values[:, None], smoothed.bandwidth)
    np.testing.assert_allclose(at_edge, normals.cdf(edges).mean(axis=0), rtol=1e-9)
    steps = np.diff(edges) / smoothed.bandwidth
    near = steps < 1.5 * steps.min()  # the next cell begins where this one ends
    ends = sum(part[:-1] * (steps / 2) ** power for power, part in enumerate(series))
    np.testing.assert_allclose((at_edge[:-1] + ends)[near], at_edge[1:][near], rtol=1e-9, atol=1e-15)


def test_moments(smoothed):
    normals = smoothed.values
    assert smoothed.mean() == pytest.approx(normals.mean(), rel=1e-12)
    assert smoothed.variance() == pytest.approx(normals.var() + smoothed.bandwidth**2, rel=1e-12)


@given(
    data=st.lists(st.floats(-100, 100).map(lambda x: round(x, 3)), min_size=1, max_size=30),
    bandwidth=st.floats(0.5, 50),
    k=st.integers(1, 2**53 - 1),
)
def test_round_trip(data, bandwidth, k):
    smoothed, u = EmpiricalSmoothed(data, bandwidth), k * 2.0**-53
    assert smoothed.cdf(smoothed.ppf(u)) == pytest.approx(u, rel=1e-9, abs=1e-13)


def test_one_value_is_a_normal():
    u = np.array([1e-9, 0.3, 0.9])
    np.testing.assert_allclose(EmpiricalSmoothed([5.0], 2.0).ppf(u), stats.norm(5, 2).ppf(u), rtol=1e-12)


@pytest.mark.parametrize("data", [[1, 2, 3, 4, 5], RNG.normal(size=200), [0, 0, 0, 0, 9]])
def test_silvermans_rule(data):
    """0.9·min(s, IQR/1.34)·m^-0.2, where an interquartile range of 0 does not count."""
    spread = [np.std(data, ddof=1), stats.iqr(data) / 1.34]
    expected = 0.9 * min(value for value in spread if value > 0) * len(data) ** -0.2
    assert silverman(data) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("data", [[4.0], [4.0, 4.0]])
def test_values_that_do_not_vary_have_no_bandwidth(data):
    assert silverman(data) == 0


def test_truncation():
    smoothed = EmpiricalSmoothed([1.0, 2.0, 4.0], 0.5)
    x = Truncated(smoothed).ppf(np.linspace(0, 0.999, 101), 0.0, 3.0)
    assert (x >= 0).all()
    assert (x <= 3).all()
    middle = (smoothed.cdf(0.0) + smoothed.cdf(3.0)) / 2
    assert Truncated(smoothed).ppf(0.5, 0.0, 3.0) == pytest.approx(smoothed.ppf(middle), rel=1e-12)


COLUMN = np.array([[4.0], [1.0], [np.nan], [2.0], [1.0]])


def test_it_is_built_with_silvermans_bandwidth_or_the_given_one():
    assert EmpiricalSmoothed().built(COLUMN).bandwidth == silverman([4, 1, 2, 1])
    assert EmpiricalSmoothed().built(COLUMN, bandwidth=0.5).bandwidth == 0.5


@pytest.mark.parametrize(
    ("data", "options", "message"),
    [
        ([[2.0], [2.0]], {}, "The values are all equal"),
        ([[np.nan]], {}, "The data are blank"),
        ([[float(i)] for i in range(5000)], {"bandwidth": 1e-6}, "The bandwidth is very small"),
    ],
)
def test_data_that_cannot_be_smoothed(data, options, message):
    with pytest.raises(DataError, match=message):
        EmpiricalSmoothed().built(np.array(data), **options)
