from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.excel.functions.statistical.probabilities import poisson_mass
from xlmc.montecarlo.distributions.poisson import Poisson

POISSON = Poisson()


@pytest.mark.parametrize("rate", [1e-3, 0.7, 4.0, 1234.5, 9e4])
def test_against_scipy(rate, counts_agree):
    counts_agree(POISSON, (rate,), stats.poisson(rate))


def test_against_exact_sums():
    """Rate 2: sums of 2^k/k! in whole numbers, times e^-2."""
    at_most = [math.exp(-2) * math.fsum(2.0**j / math.factorial(j) for j in range(k + 1)) for k in range(25)]
    np.testing.assert_allclose(POISSON.cdf(np.arange(25.0), 2), at_most, rtol=1e-14)


@pytest.mark.parametrize("rate", [1.2e5, 1e6, 1e8])
def test_large_rates_against_sums_of_masses(rate):
    """Masses by Loader's expansion, added up over 14 standard deviations either way; SciPy is no oracle out there."""
    reach = math.floor(14 * math.sqrt(rate))
    k = np.arange(rate - reach, rate + reach + 1)
    masses = poisson_mass(k, rate)
    at_most, at_least = np.cumsum(masses), np.cumsum(masses[::-1])[::-1]
    seen = np.linspace(0, k.size - 1, 2001).astype(int)
    for function, expected in ((POISSON.cdf, at_most), (POISSON.sf, at_least)):
        possible = seen[expected[seen] > 1e-28]
        np.testing.assert_allclose(function(k[possible], rate), expected[possible], rtol=1e-12)
    assert (np.diff(POISSON.cdf(k[seen], rate)) >= 0).all()
    middle = seen[(at_most[seen] > 1e-9) & (at_least[seen] > 1e-3)]
    x = POISSON.ppf(at_most[middle], rate)
    assert (np.abs(x - k[middle]) <= 1).all()  # the sums are not the last bit of the distribution function
    assert abs(POISSON.ppf(0.5, rate) - rate) <= 1


def test_a_tiny_rate_hardly_ever_happens(clean):
    assert POISSON.ppf(1 - 2.0**-53, 1e-20) == 0
    assert POISSON.sf(1.0, 1e-20) == pytest.approx(1e-20, rel=1e-12)
    assert POISSON.cdf(1e300, 1e-20) == 1


@given(rate=st.floats(1e-6, 1e6), k=st.integers(1, 2**53 - 1))
def test_the_quantile_is_the_first_that_reaches(rate, k):
    u = k * 2.0**-53
    x = POISSON.ppf(np.array([u]), np.array([rate]))[0]
    assert POISSON.cdf(x, rate) >= u
    assert x == 0 or POISSON.cdf(x - 1, rate) < u


@pytest.mark.parametrize(("rate", "shown"), [(-1, "-1"), (-4, "-4"), (2e9, "2,000,000,000")])
def test_bad_rates(rate, shown):
    fault = POISSON.fault(rate)
    assert (fault.key, fault.message) == ("rate", f"Rate ({shown}) must be from 0 to 1,000,000,000")
    assert fault.hint
