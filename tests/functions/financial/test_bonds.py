from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.functions.financial.bonds import annuity

NUM, VALUE, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

VALUES = [
    ("PRICE", ("2008-02-15", "2017-11-15", 0.0575, 0.065, 100, 2, 0), 94.6343616213221),
    ("PRICE", ("2008-02-15", "2017-11-15", 0.0575, 0, 100, 2), 156.0625),
    ("PRICE", ("2008-02-15", "2017-11-15", 0, 0, 100, 2), 100),
    ("PRICE", ("2008-02-15", "2008-05-15", 0.06, 0.05, 100, 2), 103 / 1.0125 - 1.5),
    ("PRICE", ("2017-11-15", "2008-02-15", 0.0575, 0.065, 100, 2), NUM),
    ("PRICE", ("2008-02-15", "2017-11-15", -0.01, 0.065, 100, 2), NUM),
    ("PRICE", ("2008-02-15", "2017-11-15", 0.0575, -0.01, 100, 2), NUM),
    ("PRICE", ("2008-02-15", "2017-11-15", 0.0575, 0.065, 0, 2), NUM),
    ("PRICE", ("2008-02-15", "2017-11-15", 0.0575, 0.065, 100, 3), NUM),
    ("PRICE", ("2008-02-15", "2017-11-15", 0.0575, 0.065, 100, 2, 5), NUM),
    ("PRICE", ("2008-02-15", "x", True, NA, 100, 2, 0), VALUE),
    ("YIELD", ("2008-02-15", "2016-11-15", 0.0575, 95.04287, 100, 2, 0), 0.0650000068807546),
    ("YIELD", ("2008-02-15", "2008-05-15", 0.06, 103 / 1.0125 - 1.5, 100, 2), 0.05),
    ("YIELD", ("2008-02-15", "2016-11-15", 0.0575, 0, 100, 2), NUM),
    ("YIELD", ("2008-02-15", "2016-11-15", 0.0575, 95, -100, 2), NUM),
    ("DURATION", ("2018-07-01", "2048-01-01", 0.08, 0.09, 2, 1), 10.9191452815919),
    ("DURATION", ("2018-07-01", "2048-01-01", 0, 0.09, 2, 0), 29.5),
    ("DURATION", ("2018-07-01", "2048-01-01", -0.08, 0.09, 2), NUM),
    ("MDURATION", ("2008-01-01", "2016-01-01", 0.08, 0.09, 2, 1), 5.73566981391884),
    ("MDURATION", ("2008-01-01", "2016-01-01", 0.08, -0.09, 2, 1), NUM),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-11)


bonds = st.tuples(
    st.integers(36526, 40000).map(float),
    st.integers(40001, 48000).map(float),
    st.floats(0.001, 0.15),
    st.floats(0.001, 0.3),
    st.floats(50, 150),
    st.sampled_from([1.0, 2.0, 4.0]),
    st.sampled_from([0.0, 1.0, 2.0, 3.0, 4.0]),
)


@given(bonds)
def test_the_yield_is_found_again(evaluate, bond):
    settlement, maturity, rate, yield_, redemption, frequency, basis = bond
    of_period = (settlement, maturity, frequency, basis)
    if evaluate("COUPDAYS", *of_period) <= evaluate("COUPDAYBS", *of_period):
        return  # by this basis nothing of the period is left to earn a yield in
    pr = evaluate("PRICE", *bond)
    if pr > 0:
        found = evaluate("YIELD", settlement, maturity, rate, pr, redemption, frequency, basis)
        assert found == pytest.approx(yield_, rel=1e-8)


@given(bonds)
def test_modified_duration_is_the_slope_of_the_price_with_interest(evaluate, bond):
    """-dP/dy / P by a central difference, which errs by about 1e-6; true periods only, one coupon left excepted."""
    settlement, maturity, rate, yield_, _, frequency, basis = bond
    if evaluate("COUPNUM", settlement, maturity, frequency, basis) == 1:
        return
    gone = evaluate("COUPDAYBS", settlement, maturity, frequency, basis)
    accrued = 100 * rate / frequency * gone / evaluate("COUPDAYS", settlement, maturity, frequency, basis)
    step = 1e-4
    low, middle, high = (
        evaluate("PRICE", settlement, maturity, rate, yield_ + d, 100.0, frequency, basis) + accrued
        for d in (-step, 0, step)
    )
    found = evaluate("MDURATION", settlement, maturity, rate, yield_, frequency, basis)
    assert found == pytest.approx((low - high) / (2 * step) / middle, rel=2e-5, abs=1e-6)


def test_an_annuity_is_a_geometric_sum():
    growth = np.array([1.05, 1.0, 0.9])
    expected = [sum(g**-k for k in range(7)) for g in growth]
    assert annuity(np.log(growth), 7) == pytest.approx(expected, rel=1e-14)
