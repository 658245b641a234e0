from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions.geometric import Geomet, Geometric

GEOMET = Geomet()


@pytest.mark.parametrize("probability", [0.25, 0.5, 0.9, 1e-3])
def test_against_scipy(probability, counts_agree):
    counts_agree(GEOMET, (probability,), stats.geom(probability, loc=-1))


def test_failures_are_one_fewer_than_trials():
    u = np.random.default_rng(1).random(1000)
    np.testing.assert_array_equal(GEOMET.ppf(u, 0.1) + 1, Geometric().ppf(u, 0.1))


def test_bad_probability():
    assert GEOMET.check(0) == "Probability (0) must be above 0 and at most 1"
