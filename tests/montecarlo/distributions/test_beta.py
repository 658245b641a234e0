from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

BETA = FAMILIES["Beta"]
U = np.array([0.0, 1e-6, 0.3, 0.5, 0.99, 1 - 2.0**-53])


@pytest.mark.parametrize(
    "params",
    [
        (0.0, 1.0, 2.0, 3.0),
        (10.0, 20.0, 0.5, 0.5),
        (-1.0, 1.0, 1.0, 1.0),
        (0.0, 5.0, 0.2, 4.0),
        (0.0, 1.0, 1e4, 1e4),
        (0.0, 1e6, 2.0, 1e6),
    ],
)
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    low, high, alpha, beta = params
    oracle = stats.beta(alpha, beta, low, high - low)
    quantiles_agree(BETA, params, oracle)
    moments_agree(BETA, params, oracle)
    draws_fit(BETA, params, oracle)


def test_alpha_1_beta_1_is_uniform():
    np.testing.assert_allclose(BETA.ppf(U, 2, 6, 1, 1), FAMILIES["Uniform"].ppf(U, 2, 6), rtol=1e-15)


def test_one_shape_of_1_in_closed_form():
    np.testing.assert_allclose(BETA.ppf(U, 0, 1, 3, 1), U ** (1 / 3), rtol=1e-13)
    np.testing.assert_allclose(BETA.ppf(U, 0, 1, 1, 3), -np.expm1(np.log1p(-U) / 3), rtol=1e-13)


def test_equal_ends_are_a_constant(clean):
    np.testing.assert_array_equal(BETA.ppf(U, 2, 2, 3, 4), 2)
    np.testing.assert_array_equal(BETA.cdf(np.array([1.0, 2.0, 3.0]), 2, 2, 3, 4), [0, 1, 1])
    assert BETA.variance(2, 2, 3, 4) == 0
    assert BETA.check(2, 2, 3, 4) is None


def test_the_upper_tail_keeps_its_digits():
    """With alpha 1, P(X > x) = (1 - x)^beta: from x = 0.99 on, 1e-40."""
    u = np.array([0.0, 0.4, 0.999])
    expected = 1 - 0.01 * (1 - u) ** (1 / 20)
    np.testing.assert_allclose(Truncated(BETA).ppf(u, 0.99, 1.0, 0.0, 1.0, 1.0, 20.0), expected, rtol=1e-14)


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((3, 2, 1, 1), "low", "Low (3) is above High (2)"),
        ((0, 1, 0, 1), "alpha", "Alpha (0) must be above 0"),
        ((0, 1, 1, -2), "beta", "Beta (-2) must be above 0"),
        ((0, 1, 2e6, 1), "alpha", "Alpha (2,000,000) must be at most 1,000,000"),
        ((0, 1, 1, 2e6), "beta", "Beta (2,000,000) must be at most 1,000,000"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = BETA.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
