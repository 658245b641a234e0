"""What every family of counts must do: truncation with both cutoffs kept, both roads to a quantile, fast and slow."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.montecarlo.distributions import FAMILIES, Truncated
from xlmc.montecarlo.distributions.whole_numbers import WholeNumbers, smallest

INF = math.inf
FEW = {
    "Binomial": (0.3, 20.0),
    "Discrete Uniform": (0.0, 9.0),
    "Geometric": (0.25,),
    "Geomet": (0.25,),
    "Hypergeometric": (20.0, 10.0, 50.0),
    "Negative Binomial": (0.25, 3.0),
    "Negbin": (0.25, 3.0),
    "Poisson": (4.0,),
    "Yes-No": (0.25,),
}
CASES = [pytest.param(FAMILIES[name], params, id=name) for name, params in FEW.items()]


def test_all_of_them_are_here():
    assert {name for name, family in FAMILIES.items() if isinstance(family, WholeNumbers)} == set(FEW)


def mass(family, params, k):
    return family.cdf(k, *params) - family.cdf(k - 1, *params)


@pytest.mark.parametrize(("family", "params"), CASES)
@pytest.mark.parametrize(("lower", "upper"), [(1, INF), (0.5, INF), (-INF, 4), (1, 4), (0.2, 4.9), (3, 9)])
def test_truncation_keeps_both_cutoffs_and_renormalises(family, params, lower, upper):
    if family.name == "Yes-No" and lower == 3:
        return
    truncated = Truncated(family)
    k = np.arange(-1.0, 200)
    kept = mass(family, params, k) * (k >= lower) * (k <= upper)
    expected = np.cumsum(kept / kept.sum())
    assert truncated.check(lower, upper, *params) is None
    np.testing.assert_allclose(truncated.cdf(k, lower, upper, *params), expected, rtol=1e-12, atol=1e-14)
    u = np.random.default_rng(5).random(4000)
    x = truncated.ppf(u, lower, upper, *params)
    at = (x + 1).astype(int)
    assert np.isin(x, k[kept > 0]).all()
    assert (u <= expected[at] + 1e-12).all()
    assert (u >= expected[at - 1] - 1e-12).all()


@pytest.mark.parametrize(("family", "params"), CASES)
def test_truncation_in_the_far_upper_tail(family, params):
    """Counted from above, the tail keeps its digits."""
    lower = float(family.isf(1e-12, *params))
    x = Truncated(family).ppf(np.array([0.0, 0.3, 1 - 2.0**-53]), lower, INF, *params)
    assert (x >= lower).all()
    assert (x == np.floor(x)).all()
    assert x[0] == lower


@pytest.mark.parametrize(
    ("cutoffs", "key", "message"),
    [
        ((3.2, 3.8), "lower_cutoff", "Lower cutoff (3.2) leaves nothing of the distribution"),
        ((5.0, 4.0), "lower_cutoff", "Lower cutoff (5) is not below Upper cutoff (4)"),
        ((10.0, INF), "lower_cutoff", "Lower cutoff (10) leaves nothing of the distribution"),
        ((-INF, -1.0), "upper_cutoff", "Upper cutoff (-1) leaves nothing of the distribution"),
    ],
)
def test_cutoffs_that_leave_nothing(cutoffs, key, message):
    die = Truncated(FAMILIES["Discrete Uniform"])
    fault = die.fault(*cutoffs, 0, 9)
    assert (fault.key, fault.message) == (key, message)
    assert np.isnan(die.ppf(0.5, *cutoffs, 0, 9))


def test_cutoffs_that_vary_by_trial():
    lower = np.array([1.0, 3.0, 8.5, 3.2])
    upper = np.array([2.0, 3.5, 9.0, 3.4])
    np.testing.assert_array_equal(
        Truncated(FAMILIES["Discrete Uniform"]).ppf(0.75, lower, upper, 0, 9), [2, 3, 9, np.nan]
    )


@pytest.mark.parametrize(("family", "params"), CASES)
def test_zero_is_the_least_that_a_draw_may_be(family, params):
    np.testing.assert_array_equal(family.ppf(0.0, *params), family.ppf(2.0**-54, *params))


@given(answer=st.integers(-50, 10**6), guess=st.floats(-1e9, 1e9), low=st.integers(-50, 0), size=st.integers(1, 4))
def test_the_search_finds_it_from_any_guess(answer, guess, low, size):
    asked = []

    def holds(k, _):
        asked.append(k)
        return k >= answer

    low_, high = np.full(size, float(low)), np.full(size, 1e6)
    assert (smallest(holds, np.full(size, guess), low_, high) == max(answer, low)).all()
    assert len(asked) <= 64


def test_a_right_guess_costs_two_questions():
    asked = []

    def holds(k, _):
        asked.append(float(k[0]))
        return k >= 7

    assert smallest(holds, np.array([7.2]), np.array([0.0]), np.array([INF])) == 7
    assert asked == [7, 6]


def test_a_trial_without_an_answer():
    result = smallest(lambda k, _: k >= 3, np.array([np.nan, 1.0]), np.zeros(2), np.full(2, INF))
    np.testing.assert_array_equal(result, [np.nan, 3])
