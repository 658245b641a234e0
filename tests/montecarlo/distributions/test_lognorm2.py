from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

LOGNORM2 = FAMILIES["Lognorm2"]


@pytest.mark.parametrize("params", [(0.0, 0.0, 1.0), (2.0, 1.0, 0.5), (-7.0, -20.0, 0.01), (0.0, 5.0, 3.0)])
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    location, mu, sigma = params
    oracle = stats.lognorm(sigma, location, np.exp(mu))
    quantiles_agree(LOGNORM2, params, oracle)
    moments_agree(LOGNORM2, params, oracle)
    draws_fit(LOGNORM2, params, oracle)


def test_the_tail_above_a_cutoff():
    oracle = stats.lognorm(0.5)
    u = np.array([0.0, 0.4, 0.999])
    expected = oracle.isf(oracle.sf(1e3) * (1 - u))
    np.testing.assert_allclose(Truncated(LOGNORM2).ppf(u, 1e3, np.inf, 0.0, 0.0, 0.5), expected, rtol=1e-12)


def test_values_up_to_the_location_are_impossible(clean):
    np.testing.assert_array_equal(LOGNORM2.cdf(np.array([-5.0, 2.0]), 2.0, 1.0, 0.5), 0)
    np.testing.assert_array_equal(LOGNORM2.sf(np.array([-5.0, 2.0]), 2.0, 1.0, 0.5), 1)


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((0, 1, -1), "sigma", "Sigma (-1) must be above 0"),
        ((0, 350, 1), "mu", "Mu (350) and Sigma (1) give values above 1E150"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = LOGNORM2.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
