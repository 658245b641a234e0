from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.distributions.discrete_uniform import DiscreteUniform

DIE = DiscreteUniform()


@pytest.mark.parametrize("params", [(1, 6), (-3, 3), (0, 1), (-1_000_000, 1_000_000), (0, 10**9)])
def test_against_scipy(params, counts_agree):
    low, high = params
    counts_agree(DIE, params, stats.randint(low, high + 1))


def test_low_equal_to_high_is_a_constant(clean):
    np.testing.assert_array_equal(DIE.ppf(np.array([0.0, 0.9]), 4, 4), 4)
    assert DIE.variance(4, 4) == 0


@given(low=st.integers(-1000, 1000), width=st.integers(0, 10**6), k=st.integers(1, 2**53 - 1))
def test_the_quantile_is_the_first_that_reaches(low, width, k):
    u = k * 2.0**-53
    x = DIE.ppf(np.array([u]), np.array([float(low)]), float(low + width))[0]
    assert DIE.cdf(x, low, low + width) >= u
    assert DIE.cdf(x - 1, low, low + width) < u


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((6, 1), "low", "Low (6) is above High (1)"),
        ((0.5, 6), "low", "Low (0.5) must be a whole number from -1,000,000,000 to 1,000,000,000"),
        ((1, 6.5), "high", "High (6.5) must be a whole number from -1,000,000,000 to 1,000,000,000"),
        ((-2e9, 6), "low", "Low (-2,000,000,000) must be a whole number from -1,000,000,000 to 1,000,000,000"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = DIE.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
