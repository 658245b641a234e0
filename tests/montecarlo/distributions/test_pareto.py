from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

PARETO = FAMILIES["Pareto"]


@pytest.mark.parametrize("params", [(1.0, 3.0), (10.0, 2.5), (1e-6, 80.0), (5e4, 3.0)])
def test_against_scipy(params, quantiles_agree, moments_agree, draws_fit):
    location, shape = params
    oracle = stats.pareto(shape, scale=location)
    quantiles_agree(PARETO, params, oracle)
    moments_agree(PARETO, params, oracle)
    draws_fit(PARETO, params, oracle)


@pytest.mark.parametrize("shape", [1.0, 0.5])
def test_heavy_tails(shape):
    """The largest quantiles are some 1e12 interquartile ranges away, so they are compared as ratios."""
    u = np.array([1e-6, 0.5, 0.999, 1 - 1e-6])
    np.testing.assert_allclose(PARETO.ppf(u, 2.0, shape), stats.pareto(shape, scale=2.0).ppf(u), rtol=1e-12)


def test_moments_that_do_not_exist_are_infinite():
    shapes = np.array([0.5, 1.0, 1.5, 2.0, 3.0])
    np.testing.assert_allclose(PARETO.mean(1.0, shapes), [np.inf, np.inf, 3.0, 2.0, 1.5])
    np.testing.assert_allclose(PARETO.variance(1.0, shapes), [np.inf, np.inf, np.inf, np.inf, 0.75])


def test_above_a_cutoff_it_is_pareto_again(quantiles_agree):
    quantiles_agree(Truncated(PARETO), (1e9, np.inf, 1.0, 3.0), stats.pareto(3.0, scale=1e9))


@pytest.mark.parametrize(
    ("params", "key", "message"),
    [((0, 1), "location", "Location (0) must be above 0"), ((1, 0), "shape", "Shape (0) must be above 0")],
)
def test_bad_parameters(params, key, message):
    fault = PARETO.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
