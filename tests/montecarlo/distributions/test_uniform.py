from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.distributions.uniform import Uniform

UNIFORM = Uniform()
RANGES = [(0.60, 0.95), (181.0, 191.0), (-28.6, -22.6), (-3.2, 3.2), (1e-12, 2e-12), (1e6, 1e6 + 1)]


@pytest.mark.parametrize("params", RANGES)
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    oracle = stats.uniform(params[0], params[1] - params[0])
    quantiles_agree(UNIFORM, params, oracle)
    moments_agree(UNIFORM, params, oracle)
    draws_fit(UNIFORM, params, oracle)


def test_draws_are_low_plus_width_times_u():
    u = np.random.default_rng(5).integers(2**53, size=1000) * 2.0**-53
    np.testing.assert_array_equal(UNIFORM.ppf(u, 0.60, 0.95), 0.60 + (0.95 - 0.60) * u)


@given(
    low=st.floats(-1e9, 1e9),
    width=st.floats(0, 1e9),
    k=st.integers(0, 2**53 - 1) | st.integers(2**53 - 9, 2**53 - 1),
)
def test_draws_never_leave_the_range(low, width, k):
    high = low + width
    assert low <= UNIFORM.ppf(k * 2.0**-53, low, high) <= high


@given(low=st.floats(-1e3, 1e3), width=st.floats(1e-3, 1e3), k=st.integers(0, 2**53 - 1))
def test_round_trip(low, width, k):
    u = k * 2.0**-53
    assert UNIFORM.cdf(UNIFORM.ppf(u, low, low + width), low, low + width) == pytest.approx(u, abs=1e-9)


def test_low_equal_to_high_is_a_constant(clean):
    np.testing.assert_array_equal(UNIFORM.ppf(np.array([0.0, 0.3, 0.9]), 0.1, 0.1), 0.1)
    np.testing.assert_array_equal(UNIFORM.cdf(np.array([0.0, 0.1, 0.2]), 0.1, 0.1), [0, 1, 1])
    assert UNIFORM.mean(0.1, 0.1) == 0.1
    assert UNIFORM.variance(0.1, 0.1) == 0
    assert UNIFORM.check(0.1, 0.1) is None


def test_low_above_high():
    fault = UNIFORM.fault(low=12, high=10)
    assert (fault.key, fault.message) == ("low", "Low (12) is above High (10)")
    assert "Exchange" in fault.hint
