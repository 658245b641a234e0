from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.distributions.geometric import Geometric

GEOMETRIC = Geometric()


@pytest.mark.parametrize("probability", [0.25, 0.5, 0.9999, 1e-3, 1e-6])
def test_against_scipy(probability, counts_agree):
    counts_agree(GEOMETRIC, (probability,), stats.geom(probability))


def test_against_powers():
    np.testing.assert_allclose(GEOMETRIC.cdf(np.arange(1.0, 5), 0.5), [0.5, 0.75, 0.875, 0.9375], rtol=1e-15)
    np.testing.assert_array_equal(GEOMETRIC.ppf(np.array([0.5, 0.75, 0.875, 0.9]), 0.5), [1, 2, 3, 4])


def test_certain_success_comes_at_once(clean):
    np.testing.assert_array_equal(GEOMETRIC.ppf(np.array([0.0, 0.5, 1 - 2.0**-53]), 1), 1)
    np.testing.assert_array_equal(GEOMETRIC.cdf(np.array([0.0, 1.0, 2.0]), 1), [0, 1, 1])


@given(p=st.floats(1e-6, 1), k=st.integers(1, 2**53 - 1))
def test_the_quantile_is_the_first_that_reaches(p, k):
    u = k * 2.0**-53
    x = GEOMETRIC.ppf(np.array([u]), np.array([p]))[0]
    assert GEOMETRIC.cdf(x, p) >= u
    assert GEOMETRIC.cdf(x - 1, p) < u


@pytest.mark.parametrize(("probability", "shown"), [(0, "0"), (-1, "-1"), (25, "25")])
def test_bad_probabilities(probability, shown):
    fault = GEOMETRIC.fault(probability)
    assert (fault.key, fault.message) == ("probability", f"Probability ({shown}) must be above 0 and at most 1")
    assert fault.hint


def test_a_probability_that_counts_cannot_reach():
    assert GEOMETRIC.check(1e-14) == "Probability (1e-14) is so small that the count may pass 1E15"
    assert GEOMETRIC.ppf(1 - 2.0**-30, 1e-13) == pytest.approx(30 * np.log(2) * 1e13, rel=1e-6)
