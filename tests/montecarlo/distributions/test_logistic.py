from __future__ import annotations

import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

LOGISTIC = FAMILIES["Logistic"]


@pytest.mark.parametrize("params", [(0.0, 1.0), (10.0, 2.0), (-3.0, 1e-5), (1e6, 4e4)])
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    oracle = stats.logistic(*params)
    quantiles_agree(LOGISTIC, params, oracle)
    moments_agree(LOGISTIC, params, oracle)
    draws_fit(LOGISTIC, params, oracle)


def test_far_out_it_is_exponential(quantiles_agree):
    quantiles_agree(Truncated(LOGISTIC), (100.0, float("inf"), 0.0, 1.0), stats.expon(100.0))


def test_far_values_raise_no_flag(clean):
    assert LOGISTIC.cdf(-1e300, 0, 1e-100) == 0
    assert LOGISTIC.sf(-1e300, 0, 1e-100) == 1


@pytest.mark.parametrize("scale", [-0.5, -1])
def test_scale_must_be_positive(scale):
    fault = LOGISTIC.fault(0, scale)
    assert (fault.key, fault.message) == ("scale", f"Scale ({scale}) must be above 0")
    assert fault.hint
