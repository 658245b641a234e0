"""One oracle for every family: SciPy's own distribution, or any object with `ppf`, `cdf`, `sf`, `mean` and `var`."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.distributions import Truncated

GRID = np.array([1e-6, 1e-4, 0.01, 0.1, 0.245, 0.25, 0.5, 0.75, 0.755, 0.9, 0.99, 1 - 1e-4, 1 - 1e-6])


@pytest.fixture
def quantiles_agree():
    """Quantiles from 1e-6 to 1 - 1e-6 to 1e-9 of the interquartile range; both tails of the distribution function."""

    def agree(family, params, oracle, rtol=0.0):
        scale = oracle.ppf(0.75) - oracle.ppf(0.25)
        expected = oracle.ppf(GRID)
        np.testing.assert_allclose(family.ppf(GRID, *params), expected, rtol=rtol, atol=1e-9 * scale)
        # In a far tail, the last bit of x alone moves a truncated probability by some 1e-13.
        slack = 1e-12 if isinstance(family, Truncated) else 1e-15
        np.testing.assert_allclose(family.cdf(expected, *params), oracle.cdf(expected), rtol=1e-9, atol=slack)
        if not isinstance(family, Truncated):
            upper = oracle.isf(GRID)
            np.testing.assert_allclose(family.isf(GRID, *params), upper, rtol=rtol, atol=1e-9 * scale)
            np.testing.assert_allclose(family.sf(upper, *params), oracle.sf(upper), rtol=1e-9, atol=1e-15)

    return agree


@pytest.fixture
def moments_agree():
    def agree(family, params, oracle, digits=1e-9):
        scale = oracle.std()
        assert family.mean(*params) == pytest.approx(oracle.mean(), abs=digits * scale)
        assert family.variance(*params) == pytest.approx(oracle.var(), rel=digits)

    return agree


@pytest.fixture
def draws_fit():
    """5,000 draws from the grid k·2^-53, Kolmogorov-Smirnov: a right family fails one seed in a thousand."""

    def fit(family, params, oracle, seed=20010311):
        from scipy.stats import kstest

        u = np.random.default_rng(seed).integers(2**53, size=5_000) * 2.0**-53
        assert kstest(family.ppf(u, *params), oracle.cdf).pvalue > 1e-3

    return fit


@pytest.fixture
def clean():
    """Any floating-point flag but underflow is an error."""
    with np.errstate(divide="raise", over="raise", invalid="raise"):
        yield


@pytest.fixture
def counts_agree():
    """A distribution of whole numbers against SciPy's: probabilities to 1e-10, quantiles to the last bit of `cdf`."""

    def agree(family, params, oracle, digits=1e-10):
        low, high = float(oracle.ppf(1e-9)), float(oracle.isf(1e-9))
        k = np.unique(np.rint(np.linspace(low, high, 201)))
        np.testing.assert_allclose(family.cdf(k, *params), oracle.cdf(k), rtol=digits, atol=1e-15)
        np.testing.assert_allclose(family.sf(k, *params), oracle.sf(k - 1), rtol=digits, atol=1e-15)
        np.testing.assert_array_equal(family.cdf(k + 0.5, *params), family.cdf(k, *params))
        np.testing.assert_array_equal(family.sf(k - 0.5, *params), family.sf(k, *params))
        assert family.mean(*params) == pytest.approx(oracle.mean(), rel=1e-9)
        assert family.variance(*params) == pytest.approx(oracle.var(), rel=1e-9)
        jumps_are_exact(family, params, k)
        # The same where parameters vary by trial, which takes the other road.
        columns = [np.full(k.shape, value) for value in params]
        u = np.clip(family.cdf(k, *params), 2.0**-54, 1 - 2.0**-53)
        np.testing.assert_array_equal(family.ppf(u, *columns), family.ppf(u, *params))

    return agree


def jumps_are_exact(family, params, k):
    """At u = F(k) the quantile is k, just above it is more; and so from above."""
    at = family.cdf(k, *params)
    rises = (family.cdf(k - 1, *params) < at) & (at < 1)
    assert rises.any()
    k, at = k[rises], at[rises]
    np.testing.assert_array_equal(family.ppf(at, *params), k)
    np.testing.assert_array_equal(family.ppf(np.nextafter(at, 1), *params) > k, np.nextafter(at, 1) < 1)
    above = family.sf(k + 1, *params)
    falls = (above > 0) & (above < family.sf(k, *params))
    np.testing.assert_array_equal(family.isf(above[falls], *params), k[falls])
    assert (family.isf(np.nextafter(above[falls], 0), *params) > k[falls]).all()
