from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.distributions.hypergeometric import Hypergeometric

HYPERGEOMETRIC = Hypergeometric()


@pytest.mark.parametrize(
    "params", [(20, 10, 50), (30, 40, 50), (3, 5, 5000), (400, 300, 1000), (49_999, 50_000, 99_999)]
)
def test_against_scipy(params, counts_agree):
    success, trials, population = params
    # SciPy adds up exponentials of logarithms, which costs it digits; the exact sums below are the sharper test.
    counts_agree(HYPERGEOMETRIC, params, stats.hypergeom(population, success, trials), digits=1e-8)


@pytest.mark.parametrize(("success", "trials", "population"), [(20, 10, 50), (30, 40, 50), (200, 150, 400)])
def test_against_exact_sums(success, trials, population):
    low, high = max(0, success + trials - population), min(success, trials)
    whole = math.comb(population, trials)
    masses = [
        Fraction(math.comb(success, k) * math.comb(population - success, trials - k), whole)
        for k in range(low, high + 1)
    ]
    at_most = [float(sum(masses[: i + 1])) for i in range(len(masses))]
    at_least = [float(sum(masses[i:])) for i in range(len(masses))]
    k = np.arange(low, high + 1.0)
    np.testing.assert_allclose(HYPERGEOMETRIC.cdf(k, success, trials, population), at_most, rtol=1e-12)
    np.testing.assert_allclose(HYPERGEOMETRIC.sf(k, success, trials, population), at_least, rtol=1e-12)


def test_a_large_population_is_as_good_as_replacing():
    """Of 10^9, 100 are drawn: the binomial's probabilities to about 100/10^9."""
    k = np.arange(60.0)
    result = HYPERGEOMETRIC.cdf(k, 3e8, 100, 1e9)
    np.testing.assert_allclose(result, stats.binom(100, 0.3).cdf(k), rtol=1e-4, atol=1e-12)


def test_half_of_a_thousand_million():
    x = HYPERGEOMETRIC.ppf(np.array([0.025, 0.5, 0.975]), 5e8, 5e8, 1e9)
    half_width = 1.959964 * math.sqrt(1e9) / 4
    np.testing.assert_allclose(x - 2.5e8, [-half_width, 0, half_width], atol=1)


@pytest.mark.parametrize(("params", "always"), [((0, 5, 9), 0), ((9, 5, 9), 5), ((4, 9, 9), 4), ((1, 1, 1), 1)])
def test_constants(params, always, clean):
    np.testing.assert_array_equal(HYPERGEOMETRIC.ppf(np.array([0.0, 0.5, 0.999]), *params), always)
    assert HYPERGEOMETRIC.variance(*params) == 0


@given(population=st.integers(1, 3000), shares=st.tuples(st.floats(0, 1), st.floats(0, 1)), k=st.integers(1, 2**53 - 1))
def test_the_quantile_is_the_first_that_reaches(population, shares, k):
    success, trials = (math.floor(share * population) for share in shares)
    u, params = k * 2.0**-53, (float(success), float(trials), float(population))
    x = HYPERGEOMETRIC.ppf(np.array([u]), *(np.array([value]) for value in params))[0]
    low, high = HYPERGEOMETRIC.support(*params)
    assert low <= x <= high
    assert HYPERGEOMETRIC.cdf(x, *params) >= u
    assert x == low or HYPERGEOMETRIC.cdf(x - 1, *params) < u


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((-1, 5, 9), "success", "Success (-1) must be a whole number from 0 to 1,000,000,000"),
        ((1, 5.5, 9), "trials", "Trials (5.5) must be a whole number from 0 to 1,000,000,000"),
        ((0, 0, 0), "population", "Population (0) must be a whole number from 1 to 1,000,000,000"),
        ((10, 5, 9), "success", "Success (10) is above Population (9)"),
        ((3, 10, 9), "trials", "Trials (10) is above Population (9)"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = HYPERGEOMETRIC.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
