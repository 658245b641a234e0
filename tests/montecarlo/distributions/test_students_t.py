from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

STUDENTS_T = FAMILIES["Student's t"]


@pytest.mark.parametrize(
    "params", [(0.0, 1.0, 3.0), (10.0, 2.0, 5.0), (-4.0, 1e-3, 2.5), (0.0, 1.0, 30.0), (0.0, 1.0, 1e6)]
)
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    midpoint, scale, degrees = params
    oracle = stats.t(degrees, midpoint, scale)
    quantiles_agree(STUDENTS_T, params, oracle)
    moments_agree(STUDENTS_T, params, oracle)
    draws_fit(STUDENTS_T, params, oracle)


def test_one_degree_is_cauchy():
    u = np.array([1e-6, 0.01, 0.3, 0.5, 0.6, 0.99, 1 - 2.0**-20])
    np.testing.assert_allclose(STUDENTS_T.ppf(u, 0, 1, 1), stats.cauchy.ppf(u), rtol=1e-13, atol=1e-15)
    np.testing.assert_allclose(STUDENTS_T.sf(1e8, 0, 1, 1), stats.cauchy.sf(1e8), rtol=1e-13)


def test_two_degrees_in_closed_form():
    u = np.array([1e-6, 0.01, 0.24, 0.26, 0.5, 0.9, 1 - 2.0**-20])
    np.testing.assert_allclose(
        STUDENTS_T.ppf(u, 0, 1, 2), (2 * u - 1) / np.sqrt(2 * u * (1 - u)), rtol=1e-13, atol=1e-15
    )


def test_moments_that_do_not_exist():
    degrees = np.array([0.5, 1.0, 1.5, 2.0, 3.0])
    np.testing.assert_array_equal(STUDENTS_T.mean(7.0, 1.0, degrees), [np.nan, np.nan, 7.0, 7.0, 7.0])
    np.testing.assert_allclose(STUDENTS_T.variance(7.0, 1.0, degrees), [np.nan, np.nan, np.inf, np.inf, 3.0])


def test_the_upper_tail_keeps_its_digits():
    u, oracle = np.array([0.0, 0.4, 0.999]), stats.t(5)
    expected = oracle.isf(oracle.sf(1e6) * (1 - u))
    np.testing.assert_allclose(Truncated(STUDENTS_T).ppf(u, 1e6, np.inf, 0.0, 1.0, 5.0), expected, rtol=1e-12)
    assert oracle.sf(1e6) < 1e-27


def test_far_values_raise_no_flag(clean):
    np.testing.assert_array_equal(STUDENTS_T.cdf(np.array([-1e300, 0.0, 1e300]), 0, 1e-100, 3), [0, 0.5, 1])


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((0, -1, 1), "scale", "Scale (-1) must be above 0"),
        ((0, 1, 0), "degrees", "Degrees of freedom (0) must be above 0"),
        ((0, 1, 1e7), "degrees", "Degrees of freedom (10,000,000) must be at most 1,000,000"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = STUDENTS_T.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
