from __future__ import annotations

import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

EXPONENTIAL = FAMILIES["Exponential"]


@pytest.mark.parametrize("rate", [1.0, 0.05, 1e-6, 3e5])
def test_against_scipy(rate, quantiles_agree, moments_agree, draws_fit):
    oracle = stats.expon(scale=1 / rate)
    quantiles_agree(EXPONENTIAL, (rate,), oracle)
    moments_agree(EXPONENTIAL, (rate,), oracle)
    draws_fit(EXPONENTIAL, (rate,), oracle)


def test_it_has_no_memory(quantiles_agree):
    """Truncated 600 means out, where 1 - cdf is 0, it is the same distribution shifted."""
    quantiles_agree(Truncated(EXPONENTIAL), (300.0, float("inf"), 2.0), stats.expon(loc=300.0, scale=0.5))
    assert EXPONENTIAL.sf(300.0, 2.0) == pytest.approx(2.6503965530043108e-261, rel=1e-12)


@pytest.mark.parametrize(("rate", "shown"), [(0, "0"), (-2, "-2")])
def test_rate_must_be_positive(rate, shown):
    fault = EXPONENTIAL.fault(rate)
    assert (fault.key, fault.message) == ("rate", f"Rate ({shown}) must be above 0")
    assert "1 / mean" in fault.hint
