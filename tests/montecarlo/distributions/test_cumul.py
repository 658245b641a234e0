from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, DataError, Truncated

POINTS = np.array([[1.0, 0.25], [1.5, 0.75], [2.0, 0.9]])
CUMUL = FAMILIES["Cumul"].built(POINTS)
PARAMS = (0.5, 3.0)


def test_against_scipy(quantiles_agree, moments_agree, draws_fit):
    edges = [0.5, 1.0, 1.5, 2.0, 3.0]
    oracle = stats.rv_histogram((np.array([0.25, 0.5, 0.15, 0.1]), edges), density=False)
    quantiles_agree(CUMUL, PARAMS, oracle)
    moments_agree(CUMUL, PARAMS, oracle)
    draws_fit(CUMUL, PARAMS, oracle)


def test_a_single_point(quantiles_agree, moments_agree):
    single = FAMILIES["Cumul"].built(np.array([[2.0, 0.9]]))
    oracle = stats.rv_histogram((np.array([0.9, 0.1]), [0.0, 2.0, 3.0]), density=False)
    quantiles_agree(single, (0.0, 3.0), oracle)
    moments_agree(single, (0.0, 3.0), oracle)


def test_the_ends_may_be_points_themselves(quantiles_agree):
    whole = FAMILIES["Cumul"].built(np.array([[0.5, 0.0], *POINTS, [3.0, 1.0]]))
    assert whole.check(*PARAMS) is None
    u = np.array([0.0, 0.1, 0.25, 0.8, 1 - 2.0**-53])
    np.testing.assert_allclose(whole.ppf(u, *PARAMS), CUMUL.ppf(u, *PARAMS), rtol=1e-14)
    np.testing.assert_allclose(whole.isf(u, *PARAMS), CUMUL.isf(u, *PARAMS), rtol=1e-14)


def test_a_gap():
    gap = FAMILIES["Cumul"].built(np.array([[1.0, 0.5], [2.0, 0.5]]))
    np.testing.assert_allclose(gap.ppf(np.array([0.25, 0.75]), 0.0, 3.0), [0.5, 2.5])
    np.testing.assert_allclose(gap.cdf(np.array([1.0, 1.5, 2.0, 2.5]), 0.0, 3.0), [0.5, 0.5, 0.5, 0.75])


def test_the_ends_may_vary_by_trial(clean):
    low = np.array([0.5, 0.0, 1.0, np.nan])
    np.testing.assert_array_equal(CUMUL.ppf(0.125, low, 3.0), [0.75, 0.5, np.nan, np.nan])


def test_the_upper_tail_keeps_its_digits():
    """The last piece has probability 0.1 over 1; from 3 - 1e-12 on it is uniform still."""
    u = np.array([0.0, 0.4, 0.999])
    x = Truncated(CUMUL).ppf(u, 3 - 2.0**-40, 3.0, *PARAMS)
    np.testing.assert_allclose((3 - x) * 2.0**40, 1 - u, atol=2e-3)  # the grid of doubles below 3 is 2^-51


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((1, 3), "low", "Low (1) leaves no room below the first value (1)"),
        ((0, 1.75), "high", "High (1.75) leaves no room above the last value (2)"),
        ((0, 2), "high", "High (2) leaves no room above the last value (2)"),
        ((4, 3), "low", "Low (4) must be below High (3)"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = CUMUL.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint


@pytest.mark.parametrize(
    ("data", "message", "row", "column"),
    [
        ([[1, 0.5], [1, 0.6]], "The value 1 is not above the one before it, 1", 1, 0),
        ([[1, 0.5], [2, 0.4]], "The cumulative probability 0.4 is below the one before it", 1, 1),
        ([[1, 25]], "The cumulative probability 25 is not from 0 to 1", 0, 1),
        ([[np.nan, 0.5]], "Row 1 of the data has no value", 0, 0),
        ([[1, 0.5], [2, np.nan]], "Row 2 of the data has no cumulative probability", 1, 1),
        (np.zeros((0, 2)), "The data hold no numbers", None, None),
    ],
)
def test_bad_data(data, message, row, column):
    with pytest.raises(DataError) as caught:
        FAMILIES["Cumul"].built(np.array(data, dtype=float))
    assert (caught.value.message, caught.value.row, caught.value.column) == (message, row, column)
    assert caught.value.hint


def test_before_it_is_built_it_has_no_functions():
    with pytest.raises(TypeError, match="Cumul must be built from data first"):
        FAMILIES["Cumul"].ppf(0.5, 0.0, 1.0)
