from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

TRIGEN, TRIANGULAR = FAMILIES["Trigen"], FAMILIES["Triangular"]


def told_by_percentiles(low, likeliest, high, below, above):
    """The parameters of Trigen for a triangle; SciPy finds the percentiles."""
    triangle = stats.triang((likeliest - low) / (high - low), low, high - low)
    return triangle, (triangle.ppf(below / 100), likeliest, triangle.ppf(above / 100), below, above)


@pytest.mark.parametrize(
    ("triangle", "percents"),
    [
        ((0.0, 1.0, 4.0), (10.0, 90.0)),
        ((10.0, 15.0, 20.0), (5.0, 95.0)),
        ((-1.0, 0.2, 1.0), (0.0, 80.0)),
        ((-1.0, 0.2, 1.0), (30.0, 100.0)),
        ((2.0, 5.0, 6.0), (0.0, 100.0)),
        ((0.0, 1e-3, 1.0), (0.01, 99.9)),
    ],
)
def test_it_is_the_triangle_with_these_percentiles(triangle, percents, quantiles_agree, moments_agree, draws_fit):
    oracle, params = told_by_percentiles(*triangle, *percents)
    quantiles_agree(TRIGEN, params, oracle)
    moments_agree(TRIGEN, params, oracle)
    draws_fit(TRIGEN, params, oracle)
    np.testing.assert_allclose(TRIGEN.support(*params), (triangle[0], triangle[2]), atol=1e-9)


@given(
    down=st.floats(0, 100),
    up=st.floats(0, 100),
    below=st.floats(0, 45),
    above=st.floats(55, 100),
    likeliest=st.floats(-50, 50),
)
def test_its_percentiles_are_what_was_asked_for(down, up, below, above, likeliest):
    bottom, top = likeliest - down, likeliest + up
    if top - bottom < 1e-3:
        return
    params = bottom, likeliest, top, below, above
    assert TRIGEN.check(*params) is None
    assert TRIGEN.ppf(below / 100, *params) == pytest.approx(bottom, abs=1e-9 * (top - bottom))
    assert TRIGEN.isf(1 - above / 100, *params) == pytest.approx(top, abs=1e-6 * (top - bottom))


def test_bottom_may_be_likeliest():
    low, high = TRIGEN.support(2.0, 2.0, 5.0, 10.0, 90.0)
    assert low < 2 < 5 < high
    assert TRIANGULAR.cdf(2.0, low, 2.0, high) == pytest.approx(0.1, abs=1e-14)
    assert TRIANGULAR.cdf(5.0, low, 2.0, high) == pytest.approx(0.9, abs=1e-14)


def test_the_upper_tail_keeps_its_digits():
    """A triangle from 0 to 1 that falls all the way: P(X > x) = (1 - x)², from 1 - 1e-6 on 1e-12."""
    params = (0.0, 0.0, 1.0, 0.0, 100.0)
    u = np.array([0.0, 0.4, 0.999])
    expected = 1e-6 * np.sqrt(1 - u)
    np.testing.assert_allclose(1 - Truncated(TRIGEN).ppf(u, 1 - 1e-6, 1.0, *params), expected, atol=1e-15)


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((5, 2, 6, 10, 90), "bottom", "Bottom (5) is above Likeliest (2)"),
        ((1, 7, 6, 10, 90), "likeliest", "Likeliest (7) is above Top (6)"),
        ((2, 2, 2, 10, 90), "bottom", "Bottom (2) and Top (2) must differ"),
        ((1, 2, 6, -1, 90), "bottom_percent", "Bottom % (-1) must be 0 or more"),
        ((1, 2, 6, 0.1, 0.9), "top_percent", "Top % (0.9) must be above 1 and at most 100"),
        ((1, 2, 6, 10, 101), "top_percent", "Top % (101) must be above 1 and at most 100"),
        ((1, 2, 6, 60, 40), "bottom_percent", "Bottom % (60) is not below Top % (40)"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = TRIGEN.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
