from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

LOGNORMAL = FAMILIES["Lognormal"]


def oracle_of(location, mean, std_dev):
    variance = np.log1p((std_dev / (mean - location)) ** 2)
    return stats.lognorm(np.sqrt(variance), location, (mean - location) * np.exp(-variance / 2))


@pytest.mark.parametrize(
    "params", [(0.0, 1.0, 1.0), (0.0, 10.0, 3.0), (5.0, 5.5, 4.0), (-100.0, 3.0, 1e-2), (0.0, 1e-8, 2e-8)]
)
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    oracle = oracle_of(*params)
    quantiles_agree(LOGNORMAL, params, oracle)
    moments_agree(LOGNORMAL, params, oracle)
    draws_fit(LOGNORMAL, params, oracle)


def test_a_blank_location_is_0():
    assert LOGNORMAL.ppf(0.3, mean=10.0, std_dev=3.0) == LOGNORMAL.ppf(0.3, 0.0, 10.0, 3.0)
    assert LOGNORMAL.check(mean=10.0, std_dev=3.0) is None


def test_the_tail_above_a_cutoff():
    oracle, truncated = oracle_of(0.0, 10.0, 3.0), Truncated(LOGNORMAL)
    u = np.array([0.0, 0.4, 0.999])
    expected = oracle.isf(oracle.sf(100.0) * (1 - u))
    np.testing.assert_allclose(truncated.ppf(u, 100.0, np.inf, 0.0, 10.0, 3.0), expected, rtol=1e-12)
    assert oracle.sf(100.0) < 1e-14


def test_extreme_ratios_raise_no_flag(clean):
    """Mean and standard deviation are up to 300 orders of magnitude apart."""
    u = np.array([0.0, 0.5, 1 - 2.0**-53])
    assert np.isfinite(LOGNORMAL.ppf(u, 0.0, 1e-150, 1e150)).all()
    np.testing.assert_array_equal(LOGNORMAL.ppf(u, 0.0, 1e150, 1e-150), LOGNORMAL.ppf(0.5, 0.0, 1e150, 1e-150))
    assert LOGNORMAL.cdf(-1.0, 0.0, 1.0, 1.0) == 0


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((2, 2, 1), "mean", "Mean (2) must be above Location (2)"),
        ((0, 1, -1), "std_dev", "Std dev (-1) must be above 0"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = LOGNORMAL.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
