from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

GAMMA = FAMILIES["Gamma"]


@pytest.mark.parametrize(
    "params",
    [(0.0, 1.0, 1.0), (1.0, 2.0, 3.0), (-5.0, 0.1, 2.5), (0.0, 1.0, 0.5), (10.0, 1e-3, 200.0), (0.0, 7.0, 1e6)],
)
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    location, scale, shape = params
    oracle = stats.gamma(shape, location, scale)
    quantiles_agree(GAMMA, params, oracle)
    moments_agree(GAMMA, params, oracle)
    draws_fit(GAMMA, params, oracle)


@pytest.mark.parametrize("shape", [0.01, 0.1])
def test_shapes_that_crowd_at_the_location(shape):
    """All but the largest draws lie next to the location, so quantiles are compared as ratios."""
    u = np.array([0.25, 0.5, 0.75, 0.99, 1 - 1e-6])
    np.testing.assert_allclose(GAMMA.ppf(u, 0.0, 3.0, shape), stats.gamma(shape, scale=3.0).ppf(u), rtol=1e-9)
    assert GAMMA.ppf(1e-300, 2.0, 3.0, shape) == 2.0


@pytest.mark.parametrize("count", [2, 5])
def test_a_whole_shape_sums_exponential_waits(count):
    """Erlang's formula: P(X > x) = e^-x · Σ x^k / k!."""
    x = np.array([0.1, 2.0, 30.0, 200.0])
    erlang = np.exp(-x) * sum(x**k / np.prod(np.arange(1, k + 1)) for k in range(count))
    np.testing.assert_allclose(GAMMA.sf(x, 0.0, 1.0, count), erlang, rtol=1e-12)


def test_the_upper_tail_keeps_its_digits():
    truncated = Truncated(GAMMA)
    u = np.array([0.0, 0.3, 0.9, 1 - 1e-6])
    oracle = stats.gamma(3.0)
    expected = oracle.isf(oracle.sf(80.0) * (1 - u))
    np.testing.assert_allclose(truncated.ppf(u, 80.0, np.inf, 0.0, 1.0, 3.0), expected, rtol=1e-12)
    assert oracle.sf(80.0) < 1e-30


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((0, -1, 1), "scale", "Scale (-1) must be above 0"),
        ((0, 1, -1), "shape", "Shape (-1) must be above 0"),
        ((0, 1, 1e7), "shape", "Shape (10,000,000) must be at most 1,000,000"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = GAMMA.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
