from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, DataError, Truncated

WEIGHTS = np.array([1.0, 4.0, 0.0, 2.0, 4.0])
HISTOGRM = FAMILIES["Histogrm"].built(WEIGHTS[:, None])


@pytest.mark.parametrize("params", [(0.0, 1.0), (-20.0, 80.0), (10.0, 11.0)])
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    oracle = stats.rv_histogram((WEIGHTS, np.linspace(*params, 6)), density=False)
    quantiles_agree(HISTOGRM, params, oracle)
    moments_agree(HISTOGRM, params, oracle)
    draws_fit(HISTOGRM, params, oracle)


def test_the_ends_may_vary_by_trial(clean):
    np.testing.assert_allclose(HISTOGRM.ppf(0.1, np.array([0.0, 10.0, 30.0]), 20.0), [4.1, 12.05, np.nan])


def test_the_upper_tail_keeps_its_digits():
    u = np.array([0.0, 0.4, 0.999])
    x = Truncated(HISTOGRM).ppf(u, 1 - 2.0**-40, np.inf, 0.0, 1.0)
    np.testing.assert_allclose((1 - x) * 2.0**40, 1 - u, atol=1e-3)  # the grid of doubles below 1 is 2^-53


def test_low_must_be_below_high():
    fault = HISTOGRM.fault(2, 2)
    assert (fault.key, fault.message) == ("low", "Low (2) must be below High (2)")
    assert fault.hint


@pytest.mark.parametrize(
    ("weights", "message", "row"),
    [
        ([1, -1], "The weight -1 is below 0", 1),
        ([0, 0], "All weights are 0", 0),
        ([np.nan], "Row 1 of the data has no weight", 0),
    ],
)
def test_bad_data(weights, message, row):
    with pytest.raises(DataError) as caught:
        FAMILIES["Histogrm"].built(np.array(weights, dtype=float)[:, None])
    assert (caught.value.message, caught.value.row, caught.value.column) == (message, row, 0)
    assert caught.value.hint


def test_before_it_is_built_it_has_no_functions():
    with pytest.raises(TypeError, match="Histogrm must be built from data first"):
        FAMILIES["Histogrm"].ppf(0.5, 0.0, 1.0)
