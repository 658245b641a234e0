from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

MINIMUM = FAMILIES["Minimum Extreme"]


@pytest.mark.parametrize("params", [(0.0, 1.0), (10.0, 2.0), (-3.0, 1e-5), (1e6, 4e4)])
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    oracle = stats.gumbel_l(*params)
    quantiles_agree(MINIMUM, params, oracle)
    moments_agree(MINIMUM, params, oracle)
    draws_fit(MINIMUM, params, oracle)


def test_it_mirrors_the_maximum():
    u = np.array([0.2, 0.5, 1 - 1e-9])
    np.testing.assert_allclose(MINIMUM.ppf(u, 3, 2), -FAMILIES["Maximum Extreme"].isf(u, -3, 2), rtol=1e-14)


def test_the_upper_tail_keeps_its_digits():
    """Where P(X > x) = exp(-e^x) is 1e-120."""
    x = np.log(120 * np.log(10))
    assert MINIMUM.sf(x, 0, 1) == pytest.approx(1e-120, rel=1e-12)
    u = np.array([0.1, 0.9])
    expected = np.log(np.exp(x) - np.log1p(-u))
    np.testing.assert_allclose(Truncated(MINIMUM).ppf(u, x, np.inf, 0.0, 1.0), expected, rtol=1e-14)


def test_far_values_raise_no_flag(clean):
    np.testing.assert_array_equal(MINIMUM.cdf(np.array([-1e300, 1e300]), 0, 1e-100), [0, 1])
    np.testing.assert_array_equal(MINIMUM.sf(np.array([-1e300, 1e300]), 0, 1e-100), [1, 0])


@pytest.mark.parametrize("scale", [-0.5, -1])
def test_scale_must_be_positive(scale):
    fault = MINIMUM.fault(0, scale)
    assert (fault.key, fault.message) == ("scale", f"Scale ({scale}) must be above 0")
    assert fault.hint
