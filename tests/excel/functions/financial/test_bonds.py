from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.financial.bonds import annuity

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
        result = evaluate("YIELD", settlement, maturity, rate, pr, redemption, frequency, basis)
        assert result == pytest.approx(yield_, rel=1e-8)


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
    result = evaluate("MDURATION", settlement, maturity, rate, yield_, frequency, basis)
    assert result == pytest.approx((low - high) / (2 * step) / middle, rel=2e-5, abs=1e-6)


def test_an_annuity_is_a_geometric_sum():
    growth = np.array([1.05, 1.0, 0.9])
    expected = [sum(g**-k for k in range(7)) for g in growth]
    assert annuity(np.log(growth), 7) == pytest.approx(expected, rel=1e-14)


NUM_OF_ODD_FIRST_BONDS, VALUE_OF_ODD_FIRST_BONDS = ErrorCode.NUM, ErrorCode.VALUE

SHORT = "2008-11-11", "2021-03-01", "2008-10-15", "2009-03-01"
LONG = "1999-02-28", "2010-06-30", "1998-02-28", "2009-06-30"
MONTH_ENDS = "2002-03-31", "2004-03-31", "2001-03-31", "2003-03-31"

VALUES_OF_ODD_FIRST_BONDS = [
    ("ODDFPRICE", (*SHORT, 0.0785, 0.0625, 100, 2, 1), 113.597717474079),
    ("ODDFPRICE", (*LONG, 0.07, 0.03, 100, 1, 0), 128.0105899192),
    ("ODDFPRICE", (*LONG, 0.07, 0.03, 100, 2, 1), 127.7049586143),
    ("ODDFPRICE", (*LONG, 0.07, 0.03, 100, 2, 2), 127.6193871525),
    ("ODDFPRICE", (*LONG, 0.07, 0.03, 100, 4, 1), 127.5554755738),
    ("ODDFPRICE", (*MONTH_ENDS, 0.1, 0.1, 130, 2, 1), 123.4999641185),
    ("ODDFPRICE", (*MONTH_ENDS, 0.1, 0.1, 130, 4, 3), 123.3392895892),
    ("ODDFPRICE", (*MONTH_ENDS, 0.1, 0.1, 130, 4, 4), 123.3364745004),
    (
        "ODDFPRICE",
        ("2008-11-11", "2021-03-02", "2008-10-15", "2009-03-01", 0.0785, 0.0625, 100, 2, 1),
        NUM_OF_ODD_FIRST_BONDS,
    ),
    (
        "ODDFPRICE",
        ("2008-10-15", "2021-03-01", "2008-11-11", "2009-03-01", 0.0785, 0.0625, 100, 2, 1),
        NUM_OF_ODD_FIRST_BONDS,
    ),
    (
        "ODDFPRICE",
        ("2009-03-01", "2021-03-01", "2008-10-15", "2009-03-01", 0.0785, 0.0625, 100, 2, 1),
        NUM_OF_ODD_FIRST_BONDS,
    ),
    ("ODDFPRICE", (*SHORT, -0.0785, 0.0625, 100, 2, 1), NUM_OF_ODD_FIRST_BONDS),
    ("ODDFPRICE", (*SHORT, 0.0785, -0.0625, 100, 2, 1), NUM_OF_ODD_FIRST_BONDS),
    ("ODDFPRICE", (*SHORT, 0.0785, 0.0625, -100, 2, 1), NUM_OF_ODD_FIRST_BONDS),
    ("ODDFPRICE", (*SHORT, 0.0785, 0.0625, 100, 3, 1), NUM_OF_ODD_FIRST_BONDS),
    ("ODDFPRICE", (*SHORT, True, 0.0625, 100, 3, 1), VALUE_OF_ODD_FIRST_BONDS),
    ("ODDFYIELD", (*SHORT, 0.0575, 84.5, 100, 2, 0), 0.0772455415972),
    ("ODDFYIELD", (*SHORT, 0.0575, -84.5, 100, 2, 0), NUM_OF_ODD_FIRST_BONDS),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES_OF_ODD_FIRST_BONDS)
def test_values_odd_first_bonds(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-11)


@given(
    st.integers(1, 1200),
    st.integers(1, 1200),
    st.floats(0.001, 0.2),
    st.floats(0.001, 0.3),
    st.sampled_from([1.0, 2.0, 4.0]),
    st.sampled_from([0.0, 1.0, 2.0, 3.0, 4.0]),
)
def test_the_yield_is_found_again_odd_first_bonds(evaluate, before, after, rate, yield_, frequency, basis):
    dates = 40000.0, 44256.0, 40000.0 - before, 41334.0 - min(after, 1000) // 365 * 365.0
    dates = (*dates[:3], evaluate("COUPPCD", dates[3], 44256.0, frequency, basis))
    pr = evaluate("ODDFPRICE", *dates, rate, yield_, 100.0, frequency, basis)
    assert isinstance(pr, float)
    if pr > 0:
        result = evaluate("ODDFYIELD", *dates, rate, pr, 100.0, frequency, basis)
        assert result == pytest.approx(yield_, rel=1e-8)


NUM_OF_ODD_LAST_BONDS, VALUE_OF_ODD_LAST_BONDS = ErrorCode.NUM, ErrorCode.VALUE

SHORT_OF_ODD_LAST_BONDS = "2008-02-07", "2008-06-15", "2007-10-15"
LONG_OF_ODD_LAST_BONDS = "1999-02-28", "2000-02-28", "1998-02-28"

VALUES_OF_ODD_LAST_BONDS = [
    ("ODDLPRICE", (*SHORT_OF_ODD_LAST_BONDS, 0.0375, 0.0405, 100, 2, 0), 99.8782860147213),
    ("ODDLPRICE", (*LONG_OF_ODD_LAST_BONDS, 0.07, 0.03, 100, 1, 2), 103.6796116505),
    ("ODDLPRICE", (*LONG_OF_ODD_LAST_BONDS, 0.07, 0.03, 100, 2, 0), 103.7180731889),
    ("ODDLPRICE", (*LONG_OF_ODD_LAST_BONDS, 0.1, 0.03, 130, 4, 0), 135.6854157873),
    ("ODDLPRICE", ("2008-06-15", "2008-02-07", "2007-10-15", 0.0375, 0.0405, 100, 2), NUM_OF_ODD_LAST_BONDS),
    ("ODDLPRICE", ("2007-10-15", "2008-06-15", "2007-10-15", 0.0375, 0.0405, 100, 2), NUM_OF_ODD_LAST_BONDS),
    ("ODDLPRICE", (*SHORT_OF_ODD_LAST_BONDS, -0.0375, 0.0405, 100, 2), NUM_OF_ODD_LAST_BONDS),
    ("ODDLPRICE", (*SHORT_OF_ODD_LAST_BONDS, 0.0375, -0.0405, 100, 2), NUM_OF_ODD_LAST_BONDS),
    ("ODDLPRICE", (*SHORT_OF_ODD_LAST_BONDS, 0.0375, 0.0405, -100, 2), NUM_OF_ODD_LAST_BONDS),
    ("ODDLPRICE", (*SHORT_OF_ODD_LAST_BONDS, 0.0375, 0.0405, 100, 2, -1), NUM_OF_ODD_LAST_BONDS),
    ("ODDLPRICE", (*SHORT_OF_ODD_LAST_BONDS, 0.0375, True, 100, 3), VALUE_OF_ODD_LAST_BONDS),
    ("ODDLYIELD", ("2008-04-20", "2008-06-15", "2007-12-24", 0.0375, 99.875, 100, 2, 0), 0.0451922356291693),
    ("ODDLYIELD", (*SHORT_OF_ODD_LAST_BONDS, 0.0375, 0, 100, 2), NUM_OF_ODD_LAST_BONDS),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES_OF_ODD_LAST_BONDS)
def test_values_odd_last_bonds(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-11)


@pytest.mark.parametrize("basis", [0.0, 1.0, 2.0, 3.0, 4.0])
@pytest.mark.parametrize("frequency", [1.0, 2.0, 4.0])
@pytest.mark.parametrize("maturity", [40100.0, 40800.0])
def test_the_yield_is_found_again_odd_last_bonds(evaluate, basis, frequency, maturity):
    pr = evaluate("ODDLPRICE", 40050.0, maturity, 39900.0, 0.05, 0.07, 100.0, frequency, basis)
    result = evaluate("ODDLYIELD", 40050.0, maturity, 39900.0, 0.05, pr, 100.0, frequency, basis)
    assert result == pytest.approx(0.07, rel=1e-10)
