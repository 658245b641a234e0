from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

INF = math.inf
NORMAL = Truncated(FAMILIES["Normal"])
UNIFORM = Truncated(FAMILIES["Uniform"])


@pytest.mark.parametrize(
    ("lower", "upper"),
    [(-1.0, 2.0), (8.0, 9.0), (-9.0, -8.0), (8.0, INF), (-INF, -8.0), (30.0, 31.0), (-0.5, INF), (-INF, 0.5)],
)
def test_truncated_normal_against_scipy(lower, upper, quantiles_agree, draws_fit):
    oracle = stats.truncnorm(lower, upper)
    quantiles_agree(NORMAL, (lower, upper, 0.0, 1.0), oracle)
    draws_fit(NORMAL, (lower, upper, 0.0, 1.0), oracle)


def test_cutoffs_are_values_not_standard_deviations():
    assert NORMAL.ppf(0.5, 0.5, 2.0, 1.25, 0.46) == pytest.approx(
        stats.truncnorm(-0.75 / 0.46, 0.75 / 0.46, 1.25, 0.46).median(), rel=1e-12
    )


def test_truncated_uniform_is_uniform():
    u = np.array([0.0, 1e-6, 0.3, 0.5, 0.9, 1 - 1e-6])
    for lower, upper in [(3.0, 5.0), (2.0, 5.9), (4.5, 99.0), (-INF, 3.0)]:
        low, high = UNIFORM.support(lower, upper, 2, 6)
        expected = FAMILIES["Uniform"].ppf(u, low, high)
        np.testing.assert_allclose(UNIFORM.ppf(u, lower, upper, 2, 6), expected, rtol=1e-14)


@pytest.mark.parametrize(
    ("name", "params"), [("Triangular", (0.0, 1.0, 4.0)), ("Trapezoid", (0.0, 1.0, 2.0, 4.0)), ("Normal", (1.0, 2.0))]
)
@given(lower=st.floats(0, 3), width=st.floats(0.01, 3), k=st.integers(0, 2**53 - 1))
def test_round_trip_inside_the_cutoffs(name, params, lower, width, k):
    truncated, u = Truncated(FAMILIES[name]), k * 2.0**-53
    x = truncated.ppf(u, lower, lower + width, *params)
    assert lower <= x <= lower + width
    assert truncated.cdf(x, lower, lower + width, *params) == pytest.approx(u, abs=1e-9)


@pytest.mark.parametrize(("lower", "upper"), [(-1.0, INF), (0.3, INF), (-INF, INF), (-INF, 1.0), (35.0, INF)])
def test_extreme_draws_are_finite(lower, upper, clean):
    x = NORMAL.ppf(np.array([0.0, 2.0**-53, 1 - 2.0**-53]), lower, upper, 0.0, 1.0)
    assert np.isfinite(x).all()
    assert (np.diff(x) >= 0).all()


def test_cutoffs_and_parameters_may_vary_by_trial(clean):
    lower = np.array([-1.0, 8.0, 2.0, np.nan, 50.0, -1.0])
    upper = np.array([2.0, 9.0, 1.0, 1.0, 60.0, 2.0])
    std_dev = np.array([1.0, 1.0, 1.0, 1.0, 1.0, -1.0])
    x = NORMAL.ppf(0.5, lower, upper, 0.0, std_dev)
    assert x[0] == pytest.approx(stats.truncnorm(-1, 2).median(), rel=1e-12)
    assert x[1] == pytest.approx(stats.truncnorm(8, 9).median(), rel=1e-12)
    assert np.isnan(x[2:]).all()


def test_out_may_be_u():
    u = np.array([0.0, 0.5, 0.9])
    expected = NORMAL.ppf(u, -1.0, 2.0, 0.0, 1.0)
    assert NORMAL.ppf(u, -1.0, 2.0, 0.0, 1.0, out=u) is u
    np.testing.assert_array_equal(u, expected)


@pytest.mark.parametrize(
    ("truncated", "cutoffs", "params", "key", "message"),
    [
        (NORMAL, (9.0, 8.0), (0, 1), "lower_cutoff", "Lower cutoff (9) is not below Upper cutoff (8)"),
        (NORMAL, (8.0, 8.0), (0, 1), "lower_cutoff", "Lower cutoff (8) is not below Upper cutoff (8)"),
        (NORMAL, (math.nan, 8.0), (0, 1), "lower_cutoff", "Lower cutoff must be a number"),
        (NORMAL, (0.0, math.nan), (0, 1), "upper_cutoff", "Upper cutoff must be a number"),
        (NORMAL, (0.0, 1.0), (0, -1), "std_dev", "Std dev (-1) must be above 0"),
        (NORMAL, (60.0, INF), (0, 1), "lower_cutoff", "Lower cutoff (60) leaves nothing of the distribution"),
        (UNIFORM, (7.0, 9.0), (2, 6), "lower_cutoff", "Lower cutoff (7) leaves nothing of the distribution"),
        (UNIFORM, (0.0, 1.0), (2, 6), "upper_cutoff", "Upper cutoff (1) leaves nothing of the distribution"),
        (UNIFORM, (-INF, 1.0), (2, 6), "upper_cutoff", "Upper cutoff (1) leaves nothing of the distribution"),
    ],
)
def test_bad_cutoffs(truncated, cutoffs, params, key, message):
    fault = truncated.fault(*cutoffs, *params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
    assert truncated.check(*cutoffs, *params) == message
    assert np.isnan(truncated.ppf(0.5, *cutoffs, *params))


def test_the_hint_tells_where_the_distribution_lies():
    assert UNIFORM.fault(7.0, 9.0, 2, 6).hint.endswith("which lies from 2 to 6")
    assert NORMAL.fault(60.0, INF, 0, 1).hint.endswith("which lies around its mean")


@pytest.mark.parametrize("cutoffs", [(3.0, 5.0), (-INF, 5.0), (3.0, INF), (0.0, 99.0)])
def test_good_cutoffs(cutoffs):
    assert UNIFORM.check(*cutoffs, low=2, high=6) is None
