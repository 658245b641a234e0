from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.distributions.trapezoid import Trapezoid
from xlmc.montecarlo.distributions.triangular import Triangular
from xlmc.montecarlo.distributions.uniform import Uniform

TRAPEZOID = Trapezoid()
FRICTION = (0.45, 0.70, 0.85, 1.05)
SHAPES = [FRICTION, (0.0, 0.0, 1.0, 3.0), (0.0, 2.0, 3.0, 3.0), (-1.0, 2.0, 2.0, 3.0), (5.0, 5.0, 7.0, 7.0)]
U = np.array([0.0, 1e-6, 0.01, 0.2, 0.5, 0.77, 0.99, 1 - 1e-6, 1 - 2.0**-53])


@pytest.mark.parametrize("params", SHAPES)
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    low, first, last, high = params
    width = high - low
    oracle = stats.trapezoid((first - low) / width, (last - low) / width, low, width)
    quantiles_agree(TRAPEZOID, params, oracle)
    moments_agree(TRAPEZOID, params, oracle)
    draws_fit(TRAPEZOID, params, oracle)


def test_areas_of_figure_4():
    """Widths .25, .15, .20 give areas .125, .15, .10 out of .375."""
    np.testing.assert_allclose(TRAPEZOID.cdf(np.array(FRICTION), *FRICTION), [0, 1 / 3, 11 / 15, 1], rtol=1e-14)


@given(
    low=st.floats(-1e3, 1e3),
    rise=st.floats(0, 1e3),
    flat=st.floats(1e-3, 1e3),
    fall=st.floats(0, 1e3),
    k=st.integers(0, 2**53 - 1),
)
def test_round_trip(low, rise, flat, fall, k):
    u, params = k * 2.0**-53, tuple(np.cumsum([low, rise, flat, fall]))
    x = TRAPEZOID.ppf(u, *params)
    assert params[0] <= x <= params[3]
    assert TRAPEZOID.cdf(x, *params) == pytest.approx(u, abs=1e-9)


@pytest.mark.parametrize("peak", [2.0, 3.5, 6.0])
def test_without_a_flat_part_it_is_triangular(peak):
    triangular = Triangular()
    np.testing.assert_allclose(TRAPEZOID.ppf(U, 2, peak, peak, 6), triangular.ppf(U, 2, peak, 6), rtol=1e-14)
    x = np.linspace(1, 7, 25)
    np.testing.assert_allclose(TRAPEZOID.cdf(x, 2, peak, peak, 6), triangular.cdf(x, 2, peak, 6), atol=1e-15)
    assert TRAPEZOID.mean(2, peak, peak, 6) == pytest.approx(triangular.mean(2, peak, 6), rel=1e-14)
    assert TRAPEZOID.variance(2, peak, peak, 6) == pytest.approx(triangular.variance(2, peak, 6), rel=1e-14)


def test_without_slopes_it_is_uniform():
    uniform = Uniform()
    np.testing.assert_allclose(TRAPEZOID.ppf(U, 2, 2, 6, 6), uniform.ppf(U, 2, 6), rtol=1e-14)
    x = np.linspace(1, 7, 25)
    np.testing.assert_allclose(TRAPEZOID.cdf(x, 2, 2, 6, 6), uniform.cdf(x, 2, 6), atol=1e-15)
    assert TRAPEZOID.variance(2, 2, 6, 6) == pytest.approx(uniform.variance(2, 6), rel=1e-14)


def test_four_equal_values_are_a_constant(clean):
    same = (0.1, 0.1, 0.1, 0.1)
    np.testing.assert_array_equal(TRAPEZOID.ppf(U, *same), 0.1)
    np.testing.assert_array_equal(TRAPEZOID.cdf(np.array([0.0, 0.1, 0.2]), *same), [0, 1, 1])
    assert TRAPEZOID.mean(*same) == 0.1
    assert TRAPEZOID.variance(*same) == 0
    assert TRAPEZOID.check(*same) is None


def test_very_narrow_shapes_keep_their_digits():
    narrow = np.array(FRICTION) * 1e-200
    np.testing.assert_allclose(TRAPEZOID.ppf(U, *narrow), TRAPEZOID.ppf(U, *FRICTION) * 1e-200, rtol=1e-13)


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((12, 10.5, 11, 10), "low", "Low (12) is above High (10)"),
        ((0.5, 0.4, 0.8, 1), "low_likeliest", "Low likeliest (0.4) is below Low (0.5)"),
        ((0.5, 0.9, 0.8, 1), "low_likeliest", "Low likeliest (0.9) is above High likeliest (0.8)"),
        ((0.5, 0.6, 1.8, 1), "high_likeliest", "High likeliest (1.8) is above High (1)"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = TRAPEZOID.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
