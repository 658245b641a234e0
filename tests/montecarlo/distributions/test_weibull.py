from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

WEIBULL = FAMILIES["Weibull"]


@pytest.mark.parametrize(
    "params", [(0.0, 1.0, 1.0), (1.0, 2.0, 2.0), (-5.0, 0.1, 3.6), (0.0, 1.0, 0.5), (10.0, 1e4, 80.0)]
)
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    location, scale, shape = params
    oracle = stats.weibull_min(shape, location, scale)
    quantiles_agree(WEIBULL, params, oracle)
    moments_agree(WEIBULL, params, oracle)
    draws_fit(WEIBULL, params, oracle)


def test_shape_2_is_rayleigh(quantiles_agree):
    quantiles_agree(WEIBULL, (0.0, np.sqrt(2), 2.0), stats.rayleigh())


@pytest.mark.parametrize(
    ("shape", "variance"),
    # Γ(1 + 2/k) − Γ(1 + 1/k)² with 60 digits, by mpmath
    [
        (200.0, 4.059270896079906e-5),
        (499.0, 6.571690532966175e-6),
        (501.0, 6.519462339580903e-6),
        (1e4, 1.644503876282238e-8),
        (1e6, 1.644929763782716e-12),
    ],
)
def test_the_variance_of_narrow_shapes(shape, variance):
    assert WEIBULL.variance(0.0, 1.0, shape) == pytest.approx(variance, rel=1e-9)


@pytest.mark.parametrize("shape", [0.01, 0.1])
def test_blunt_shapes(shape):
    """Quantiles spread over hundreds of orders of magnitude, so they are compared as ratios."""
    u = np.array([0.3, 0.5, 0.9, 0.999])
    np.testing.assert_allclose(WEIBULL.ppf(u, 0.0, 1.0, shape), (-np.log1p(-u)) ** (1 / shape), rtol=1e-12)
    assert WEIBULL.variance(0.0, 1.0, 0.001) == np.inf


def test_the_upper_tail_keeps_its_digits():
    """P(X > x) = exp(-x²), at x = 20 about 1e-174."""
    u = np.array([0.0, 0.4, 0.999])
    expected = np.sqrt(400 - np.log1p(-u))
    np.testing.assert_allclose(Truncated(WEIBULL).ppf(u, 20.0, np.inf, 0.0, 1.0, 2.0), expected, rtol=1e-14)


def test_far_values_raise_no_flag(clean):
    np.testing.assert_array_equal(WEIBULL.cdf(np.array([-1.0, 0.0, 1e300]), 0, 1e-100, 3), [0, 0, 1])


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [((0, -1, 1), "scale", "Scale (-1) must be above 0"), ((0, 1, -1), "shape", "Shape (-1) must be above 0")],
)
def test_bad_parameters(params, key, message):
    fault = WEIBULL.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
