from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.distributions.normal import Normal

NORMAL = Normal()


@pytest.mark.parametrize("params", [(0.0, 1.0), (1.25, 0.46), (-40.0, 1e-6), (1e6, 5e4)])
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    oracle = stats.norm(*params)
    quantiles_agree(NORMAL, params, oracle)
    moments_agree(NORMAL, params, oracle)
    draws_fit(NORMAL, params, oracle)


@given(mean=st.floats(-1e3, 1e3), std_dev=st.floats(1e-3, 1e3), k=st.integers(1, 2**53 - 1))
def test_round_trip(mean, std_dev, k):
    u = k * 2.0**-53
    assert NORMAL.cdf(NORMAL.ppf(u, mean, std_dev), mean, std_dev) == pytest.approx(u, abs=1e-9)


def test_the_upper_tail_keeps_its_digits():
    assert NORMAL.sf(10.0, 0, 1) == pytest.approx(7.619853024160525e-24, rel=1e-12)
    assert NORMAL.isf(7.619853024160525e-24, 0, 1) == pytest.approx(10.0, rel=1e-14)


def test_far_values_raise_no_flag(clean):
    np.testing.assert_array_equal(NORMAL.cdf(np.array([-1e300, 1e300]), 0, 1e-100), [0, 1])


@pytest.mark.parametrize(("std_dev", "shown"), [(-1, "-1"), (-0.46, "-0.46")])
def test_std_dev_must_be_positive(std_dev, shown):
    fault = NORMAL.fault(mean=1.25, std_dev=std_dev)
    assert (fault.key, fault.message) == ("std_dev", f"Std dev ({shown}) must be above 0")
    assert "Frozen" in fault.hint
