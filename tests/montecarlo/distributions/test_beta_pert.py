from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

PERT = FAMILIES["BetaPERT"]


@pytest.mark.parametrize("params", [(0.0, 1.0, 4.0), (10.0, 10.0, 20.0), (-3.0, 5.0, 5.0), (0.0, 1e-6, 1.0)])
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    low, likeliest, high = params
    width = high - low
    alpha, beta = 1 + 4 * (likeliest - low) / width, 1 + 4 * (high - likeliest) / width
    oracle = stats.beta(alpha, beta, low, width)
    quantiles_agree(PERT, params, oracle)
    moments_agree(PERT, params, oracle)
    draws_fit(PERT, params, oracle)


def test_the_density_peaks_at_likeliest():
    x = 12 + 0.01 * np.array([-1.5, -0.5, 0.5, 1.5])
    steps = np.diff(PERT.cdf(x, 10, 12, 20))
    assert steps[1] > steps[0]
    assert steps[1] > steps[2]


def test_equal_ends_are_a_constant(clean):
    np.testing.assert_array_equal(PERT.ppf(np.array([0.0, 0.5, 0.9]), 2, 2, 2), 2)
    np.testing.assert_array_equal(PERT.cdf(np.array([1.0, 2.0, 3.0]), 2, 2, 2), [0, 1, 1])
    assert (PERT.mean(2, 2, 2), PERT.variance(2, 2, 2)) == (2, 0)


def test_the_upper_tail_keeps_its_digits():
    """With likeliest = low, P(X > x) = (1 - x)^5: from x = 0.9999 on, 1e-20."""
    u = np.array([0.0, 0.4, 0.999])
    expected = 1 - 1e-4 * (1 - u) ** 0.2
    np.testing.assert_allclose(Truncated(PERT).ppf(u, 0.9999, 1.0, 0.0, 0.0, 1.0), expected, rtol=1e-14)


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((3, 2, 1), "low", "Low (3) is above High (1)"),
        ((1, 0, 2), "likeliest", "Likeliest (0) is below Low (1)"),
        ((1, 3, 2), "likeliest", "Likeliest (3) is above High (2)"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = PERT.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
