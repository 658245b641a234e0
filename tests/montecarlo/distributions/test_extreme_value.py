from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

MAXIMUM = FAMILIES["Maximum Extreme"]


@pytest.mark.parametrize("params", [(0.0, 1.0), (10.0, 2.0), (-3.0, 1e-5), (1e6, 4e4)])
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    oracle = stats.gumbel_r(*params)
    quantiles_agree(MAXIMUM, params, oracle)
    moments_agree(MAXIMUM, params, oracle)
    draws_fit(MAXIMUM, params, oracle)


def test_far_out_it_is_exponential(quantiles_agree):
    quantiles_agree(Truncated(MAXIMUM), (100.0, float("inf"), 0.0, 1.0), stats.expon(100.0))


def test_the_largest_of_many_exponential_waits():
    """The largest of n standard exponentials, less ln n, tends to it: P = (1 - e^-x / n)^n."""
    x, n = np.array([-1.0, 0.0, 3.0]), 1e8
    np.testing.assert_allclose(MAXIMUM.cdf(x, 0, 1), np.exp(n * np.log1p(-np.exp(-x) / n)), rtol=1e-7)


def test_far_values_raise_no_flag(clean):
    np.testing.assert_array_equal(MAXIMUM.cdf(np.array([-1e300, 1e300]), 0, 1e-100), [0, 1])
    np.testing.assert_array_equal(MAXIMUM.sf(np.array([-1e300, 1e300]), 0, 1e-100), [1, 0])


@pytest.mark.parametrize("scale", [-0.5, -1])
def test_scale_must_be_positive(scale):
    fault = MAXIMUM.fault(0, scale)
    assert (fault.key, fault.message) == ("scale", f"Scale ({scale}) must be above 0")
    assert fault.hint
