from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, DataError, Piecewise, Truncated

GENERAL = FAMILIES["General"].built(np.array([[0.70, 2.0], [0.85, 2.0]]))
FRICTION = (0.45, 1.05)


def test_with_two_equal_heights_it_is_trapezoidal(quantiles_agree, moments_agree, draws_fit):
    oracle = stats.trapezoid(0.25 / 0.6, 0.4 / 0.6, 0.45, 0.6)
    quantiles_agree(GENERAL, FRICTION, oracle)
    moments_agree(GENERAL, FRICTION, oracle)
    draws_fit(GENERAL, FRICTION, oracle)


def test_with_one_point_it_is_triangular(quantiles_agree, moments_agree):
    single = FAMILIES["General"].built(np.array([[2.0, 7.0]]))
    quantiles_agree(single, (1.0, 5.0), stats.triang(0.25, 1, 4))
    moments_agree(single, (1.0, 5.0), stats.triang(0.25, 1, 4))


def test_it_is_the_density_through_its_points():
    points = np.array([[1.0, 2.0], [2.0, 0.0], [2.5, 3.0], [4.0, 1.0]])
    general = FAMILIES["General"].built(points)
    whole = Piecewise.of_density([0.5, *points[:, 0], 6.0], [0.0, *points[:, 1], 0.0])
    u = np.array([0.0, 1e-6, 0.03, 0.2, 0.5, 0.7, 0.99, 1 - 1e-6])
    np.testing.assert_allclose(general.ppf(u, 0.5, 6.0), whole.ppf(u), rtol=1e-12)
    np.testing.assert_allclose(general.isf(u[1:], 0.5, 6.0), whole.isf(u[1:]), rtol=1e-12)
    x = np.linspace(0, 7, 57)
    np.testing.assert_allclose(general.cdf(x, 0.5, 6.0), whole.cdf(x), atol=1e-14)
    np.testing.assert_allclose(general.sf(x, 0.5, 6.0), whole.sf(x), atol=1e-14)
    assert general.mean(0.5, 6.0) == pytest.approx(whole.mean(), rel=1e-13)
    assert general.variance(0.5, 6.0) == pytest.approx(whole.variance(), rel=1e-12)


def test_a_point_at_an_end_makes_a_step():
    step = FAMILIES["General"].built(np.array([[0.0, 1.0]]))
    assert step.check(0, 1) is None
    np.testing.assert_allclose(step.ppf(np.array([0.0, 0.75]), 0.0, 1.0), [0, 0.5])


def test_the_ends_may_vary_by_trial(clean):
    high = np.array([1.05, 0.9, 0.8])
    expected = [GENERAL.ppf(0.9, 0.45, 1.05), GENERAL.ppf(0.9, 0.45, 0.9), np.nan]
    np.testing.assert_array_equal(GENERAL.ppf(0.9, 0.45, high), expected)


def test_the_upper_tail_keeps_its_digits():
    """The falling side ends at 1.05: above 1.05 - 1e-6 the density is a triangle still."""
    u = np.array([0.0, 0.4, 0.999])
    x = Truncated(GENERAL).ppf(u, 1.05 - 1e-6, np.inf, *FRICTION)
    np.testing.assert_allclose(1.05 - x, 1e-6 * np.sqrt(1 - u), atol=1e-14)


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((0.8, 1), "low", "Low (0.8) leaves no room below the first value (0.7)"),
        ((0.5, 0.8), "high", "High (0.8) leaves no room above the last value (0.85)"),
        ((1, 1), "low", "Low (1) must be below High (1)"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = GENERAL.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint


@pytest.mark.parametrize(
    ("data", "message", "row", "column"),
    [
        ([[2, 1], [1, 1]], "The value 1 is not above the one before it, 2", 1, 0),
        ([[1, 1], [2, -1]], "The height -1 is below 0", 1, 1),
        ([[1, 0], [2, 0]], "All heights are 0", 0, 1),
        ([[1, np.nan]], "Row 1 of the data has no height", 0, 1),
    ],
)
def test_bad_data(data, message, row, column):
    with pytest.raises(DataError) as caught:
        FAMILIES["General"].built(np.array(data, dtype=float))
    assert (caught.value.message, caught.value.row, caught.value.column) == (message, row, column)
    assert caught.value.hint
