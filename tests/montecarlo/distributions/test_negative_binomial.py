from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.distributions.geometric import Geometric
from xlmc.montecarlo.distributions.negative_binomial import NegativeBinomial

NEGATIVE_BINOMIAL = NegativeBinomial()


@pytest.mark.parametrize("params", [(0.25, 3), (0.5, 1), (0.9, 50), (1e-4, 2), (0.3, 100_000)])
def test_against_scipy(params, counts_agree):
    probability, shape = params
    counts_agree(NEGATIVE_BINOMIAL, params, stats.nbinom(shape, probability, loc=shape))


def test_against_exact_sums():
    p, shape = Fraction(1, 4), 3
    masses = [math.comb(k - 1, shape - 1) * p**shape * (1 - p) ** (k - shape) for k in range(shape, 40)]
    at_most = [float(sum(masses[: i + 1])) for i in range(len(masses))]
    np.testing.assert_allclose(NEGATIVE_BINOMIAL.cdf(np.arange(3.0, 40), 0.25, 3), at_most, rtol=1e-13)


def test_shape_1_is_geometric():
    u = np.random.default_rng(2).random(1000)
    np.testing.assert_array_equal(NEGATIVE_BINOMIAL.ppf(u, 0.2, 1), Geometric().ppf(u, 0.2))


def test_certain_success_needs_as_many_trials(clean):
    np.testing.assert_array_equal(NEGATIVE_BINOMIAL.ppf(np.array([0.0, 0.9]), 1, 4), 4)


@given(p=st.floats(1e-4, 1), shape=st.integers(1, 1000), k=st.integers(1, 2**53 - 1))
def test_the_quantile_is_the_first_that_reaches(p, shape, k):
    u = k * 2.0**-53
    x = NEGATIVE_BINOMIAL.ppf(np.array([u]), np.array([p]), float(shape))[0]
    assert NEGATIVE_BINOMIAL.cdf(x, p, shape) >= u
    assert NEGATIVE_BINOMIAL.cdf(x - 1, p, shape) < u


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [
        ((0, 3), "probability", "Probability (0) must be above 0 and at most 1"),
        ((0.5, 0), "shape", "Shape (0) must be a whole number from 1 to 1,000,000,000"),
        ((1e-9, 10**6), "probability", "Probability (1e-09) is so small that the count may pass 1E15"),
        ((0.5, 1.5), "shape", "Shape (1.5) must be a whole number from 1 to 1,000,000,000"),
    ],
)
def test_bad_parameters(params, key, message):
    fault = NEGATIVE_BINOMIAL.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
