from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.distributions import FAMILIES, ByPercentiles, Truncated

REACTION = ByPercentiles(FAMILIES["Normal"], (), (10.0, 90.0))
SPREAD = 2 * stats.norm.ppf(0.9)


def test_it_is_the_member_with_these_percentiles(quantiles_agree, moments_agree, draws_fit):
    oracle = stats.norm(1.4, 1.2 / SPREAD)
    quantiles_agree(REACTION, (0.8, 2.0), oracle)
    moments_agree(REACTION, (0.8, 2.0), oracle)
    draws_fit(REACTION, (0.8, 2.0), oracle)
    assert REACTION.member(p10=0.8, p90=2.0) == pytest.approx((1.4, 1.2 / SPREAD), rel=1e-14)
    assert REACTION.support(0.8, 2.0) == (-np.inf, np.inf)


def test_given_parameters_come_first():
    family = ByPercentiles(FAMILIES["Gamma"], ("location",), (2.5, 97.5))
    assert family.keys == ("location", "p2.5", "p97.5")
    assert [spec.heading for spec in family.parameters] == ["Location", "P2.5", "P97.5"]
    params = (1.0, 2.0, 9.0)
    np.testing.assert_allclose(family.ppf(np.array([0.025, 0.975]), *params), [2, 9], rtol=1e-12)
    assert family.member(*params)[0] == 1.0


def test_truncation_comes_after():
    cut = Truncated(REACTION)
    assert cut.check(1.0, 1.5, 0.8, 2.0) is None
    expected = Truncated(FAMILIES["Normal"]).ppf(0.25, 1.0, 1.5, 1.4, 1.2 / SPREAD)
    assert cut.ppf(0.25, 1.0, 1.5, 0.8, 2.0) == pytest.approx(expected, rel=1e-12)


def test_out_may_be_u():
    u = np.array([0.0, 0.1, 0.9])
    expected = REACTION.ppf(u, 0.8, 2.0)
    assert REACTION.ppf(u, 0.8, 2.0, out=u) is u
    np.testing.assert_array_equal(u, expected)


@pytest.mark.parametrize(
    ("family", "params", "key", "message"),
    [
        (REACTION, (2.0, 0.8), "p10", "P10 (2) is not below P90 (0.8)"),
        (REACTION, (2.0, 2.0), "p10", "P10 (2) is not below P90 (2)"),
        (REACTION, (np.nan, 2.0), "p10", "P10 (nan) must be a number between -1E150 and 1E150"),
        (
            ByPercentiles(FAMILIES["Normal"], ("mean",), (90.0,)),
            (5.0, 4.0),
            "p90",
            "No single Normal has Mean 5, P90 4",
        ),
        (
            ByPercentiles(FAMILIES["Triangular"], (), (10.0, 50.0, 90.0)),
            (3.0, 5.0, 9.0),
            "p90",
            "No single Triangular has P10 3, P50 5, P90 9",
        ),
    ],
)
def test_bad_percentiles(family, params, key, message):
    fault = family.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint
    assert np.isnan(family.ppf(0.5, *params))
    assert family.valid(*params) is False
    with pytest.raises(ValueError, match=message.split(" (")[0]):
        family.member(*params)


def test_percentiles_are_numbers():
    with pytest.raises(TypeError, match="Normal by percentiles takes numbers, not one for each trial"):
        REACTION.ppf(0.5, np.array([0.8, 0.9]), 2.0)
