from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions.negative_binomial import NegativeBinomial, Negbin

NEGBIN = Negbin()


@pytest.mark.parametrize("params", [(0.25, 3), (0.9, 50), (0.01, 2)])
def test_against_scipy(params, counts_agree):
    probability, shape = params
    counts_agree(NEGBIN, params, stats.nbinom(shape, probability))


def test_failures_are_trials_without_the_successes():
    u = np.random.default_rng(1).random(1000)
    np.testing.assert_array_equal(NEGBIN.ppf(u, 0.1, 4) + 4, NegativeBinomial().ppf(u, 0.1, 4))


def test_bad_shape():
    assert NEGBIN.check(0.5, 0) == "Shape (0) must be a whole number from 1 to 1,000,000,000"
