from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.distributions.triangular import Triangular

TRIANGULAR = Triangular()
SHAPES = [(0.0, 2.0, 4.0), (0.5, 0.7, 1.1), (-3.0, -3.0, 1.0), (-3.0, 1.0, 1.0), (1e5, 1e5 + 0.9, 1e5 + 1)]


@pytest.mark.parametrize("params", SHAPES)
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    low, likeliest, high = params
    oracle = stats.triang((likeliest - low) / (high - low), low, high - low)
    quantiles_agree(TRIANGULAR, params, oracle)
    moments_agree(TRIANGULAR, params, oracle)
    draws_fit(TRIANGULAR, params, oracle)


@given(
    low=st.floats(-1e3, 1e3),
    rise=st.floats(0, 1e3),
    fall=st.floats(1e-3, 1e3),
    k=st.integers(0, 2**53 - 1),
)
def test_round_trip(low, rise, fall, k):
    u, params = k * 2.0**-53, (low, low + rise, low + rise + fall)
    x = TRIANGULAR.ppf(u, *params)
    assert params[0] <= x <= params[2]
    assert TRIANGULAR.cdf(x, *params) == pytest.approx(u, abs=1e-9)


def test_three_equal_values_are_a_constant(clean):
    np.testing.assert_array_equal(TRIANGULAR.ppf(np.array([0.0, 0.3, 0.9]), 0.1, 0.1, 0.1), 0.1)
    np.testing.assert_array_equal(TRIANGULAR.cdf(np.array([0.0, 0.1, 0.2]), 0.1, 0.1, 0.1), [0, 1, 1])
    assert TRIANGULAR.variance(0.1, 0.1, 0.1) == 0
    assert TRIANGULAR.check(0.1, 0.1, 0.1) is None


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((12, 11, 10), "low", "Low (12) is above High (10)"),
        ((0, -1, 4), "likeliest", "Likeliest (-1) is below Low (0)"),
        ((0, 5, 4), "likeliest", "Likeliest (5) is above High (4)"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = TRIANGULAR.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
