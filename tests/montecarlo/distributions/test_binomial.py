from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.distributions.binomial import Binomial

BINOMIAL = Binomial()


@pytest.mark.parametrize("params", [(0.3, 20), (0.5, 1), (1e-6, 1000), (0.999, 400), (0.37, 1_000_000), (1e-7, 10**9)])
def test_against_scipy(params, counts_agree):
    probability, trials = params
    counts_agree(BINOMIAL, params, stats.binom(trials, probability))


def test_against_exact_sums():
    """30 trials at 3/8: every probability as a fraction."""
    p, n = Fraction(3, 8), 30
    masses = [math.comb(n, k) * p**k * (1 - p) ** (n - k) for k in range(n + 1)]
    at_most = [float(sum(masses[: k + 1])) for k in range(n + 1)]
    at_least = [float(sum(masses[k:])) for k in range(n + 1)]
    np.testing.assert_allclose(BINOMIAL.cdf(np.arange(n + 1.0), 0.375, n), at_most, rtol=1e-13)
    np.testing.assert_allclose(BINOMIAL.sf(np.arange(n + 1.0), 0.375, n), at_least, rtol=1e-13)


def test_a_thousand_million_trials():
    """The median of so many lies within one of the mean, and the quantiles a normal's number of steps beside it."""
    x = BINOMIAL.ppf(np.array([0.025, 0.5, 0.975]), 0.5, 1e9)
    assert x[1] == 5e8
    half_width = 1.959964 * math.sqrt(1e9) / 2
    np.testing.assert_allclose(x - 5e8, [-half_width, 0, half_width], atol=1)


@pytest.mark.parametrize(("params", "always"), [((0.0, 5), 0), ((1.0, 5), 5), ((0.3, 0), 0)])
def test_constants(params, always, clean):
    np.testing.assert_array_equal(BINOMIAL.ppf(np.array([0.0, 0.5, 1 - 2.0**-53]), *params), always)
    np.testing.assert_array_equal(BINOMIAL.isf(np.array([0.1, 0.9]), *params), always)
    assert BINOMIAL.cdf(always - 1.0, *params) == 0
    assert BINOMIAL.cdf(float(always), *params) == BINOMIAL.sf(float(always), *params) == 1
    assert BINOMIAL.sf(always + 1.0, *params) == 0
    assert BINOMIAL.variance(*params) == 0


@given(p=st.floats(0.001, 0.999), n=st.integers(1, 10_000), k=st.integers(1, 2**53 - 1))
def test_the_quantile_is_the_first_that_reaches(p, n, k):
    u = k * 2.0**-53
    x = BINOMIAL.ppf(np.array([u]), np.array([p]), float(n))[0]
    assert BINOMIAL.cdf(x, p, n) >= u
    assert x == 0 or BINOMIAL.cdf(x - 1, p, n) < u


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((-0.1, 5), "probability", "Probability (-0.1) must be from 0 to 1"),
        ((30, 5), "probability", "Probability (30) must be from 0 to 1"),
        ((0.3, -1), "trials", "Trials (-1) must be a whole number from 0 to 1,000,000,000"),
        ((0.3, 2.5), "trials", "Trials (2.5) must be a whole number from 0 to 1,000,000,000"),
        ((0.3, 2e9), "trials", "Trials (2,000,000,000) must be a whole number from 0 to 1,000,000,000"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = BINOMIAL.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
    assert np.isnan(BINOMIAL.ppf(0.5, *params))
