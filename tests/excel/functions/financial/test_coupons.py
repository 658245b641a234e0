from __future__ import annotations

from datetime import date

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.financial.coupons import Coupons
from xlmc.excel.functions.values import Value

NUM, VALUE = ErrorCode.NUM, ErrorCode.VALUE

S, M = "2011-01-25", "2011-11-15"


def _serial(text: str) -> int:
    return (date.fromisoformat(text) - date(1899, 12, 30)).days


VALUES = [
    ("COUPDAYBS", (S, M, 2, 1), 71),
    ("COUPDAYS", (S, M, 2, 1), 181),
    ("COUPDAYSNC", (S, M, 2, 1), 110),
    ("COUPDAYS", (S, M, 2), 180),
    ("COUPDAYS", (S, M, 4, 3), 91.25),
    ("COUPDAYS", (S, M, 1, 2), 360),
    ("COUPDAYS", (S, M, 1, 4), 360),
    ("COUPNCD", (S, M, 2, 1), _serial("2011-05-15")),
    ("COUPPCD", (S, M, 2, 1), _serial("2010-11-15")),
    ("COUPPCD", ("2011-05-15", M, 2, 1), _serial("2011-05-15")),
    ("COUPNCD", ("2011-05-15", M, 2, 1), _serial("2011-11-15")),
    ("COUPNUM", ("2007-01-25", "2008-11-15", 2, 1), 4),
    ("COUPPCD", ("2004-03-31", "2008-02-29", 4), _serial("2004-02-29")),
    ("COUPPCD", ("2003-03-31", "2008-02-29", 4), _serial("2003-02-28")),
    ("COUPNCD", ("2003-03-31", "2008-02-29", 2), _serial("2003-08-31")),
    ("COUPPCD", ("2010-10-01", "2012-08-30", 2), _serial("2010-08-30")),
    ("COUPPCD", ("2010-06-01", "2012-08-30", 2), _serial("2010-02-28")),
    ("COUPDAYSNC", ("1980-02-15", "1995-11-30", 4, 0), 15),
    ("COUPDAYSNC", ("1980-02-15", "1995-11-30", 4, 4), 14),
    ("COUPDAYSNC", ("1980-03-15", "2000-02-28", 1, 0), 345),
    ("COUPDAYSNC", ("1980-03-15", "2000-02-28", 1, 4), 343),
    ("COUPDAYSNC", ("1980-03-15", "2008-02-29", 2, 2), 169),
    ("COUPNUM", (M, S, 2), NUM),
    ("COUPNUM", (S, S, 2), NUM),
    ("COUPNUM", (S, M, 3), NUM),
    ("COUPNUM", (S, M, 2, 5), NUM),
    ("COUPNUM", (-1, M, 2), NUM),
    ("COUPNUM", (S, "x", 3), VALUE),
    ("COUPPCD", (10, 20, 1), NUM),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected)


@given(st.integers(30000, 45000), st.integers(1, 9000), st.sampled_from([1, 2, 4]))
def test_settlement_lies_in_its_period(settlement, later, frequency):
    coupons = Coupons(settlement, settlement + later, frequency, 1)
    assert coupons.previous <= settlement < coupons.next <= settlement + later
    assert 27 * 12 / frequency <= coupons.next - coupons.previous <= 31 * 12 / frequency
    assert coupons.days_before + coupons.days_after == coupons.days
    assert (coupons.count - 1) * 12 / frequency * 30.4 - 3 <= later <= coupons.count * 12 / frequency * 31


def test_dates_count_from_1904_too():
    values = [Value.of_numbers(np.array([x])) for x in (_serial(S) - 1462.0, _serial(M) - 1462.0, 2.0)]
    result = function_named("COUPNCD").body(*values, date1904=True)
    assert result.numbers.tolist() == [_serial("2011-05-15") - 1462]


NUM_OF_ACCRUED_INTEREST, VALUE_OF_ACCRUED_INTEREST = ErrorCode.NUM, ErrorCode.VALUE

ISSUE, FIRST, SETTLEMENT = "2008-03-01", "2008-08-31", "2008-05-01"

VALUES_OF_ACCRUED_INTEREST = [
    ((ISSUE, FIRST, SETTLEMENT, 0.1, 1000, 2, 0), 16.6666666666667),
    (("2008-03-05", FIRST, SETTLEMENT, 0.1, 1000, 2, 0, False), 15.5555555555556),
    (("2008-04-05", FIRST, SETTLEMENT, 0.1, 1000, 2, 0, True), 7.22222222222222),
    (("2008-04-05", FIRST, SETTLEMENT, 0.1, 1000, 2), 7.22222222222222),
    (("1990-03-04", "1993-03-31", "1992-03-04", 0.07, 10000, 1, 2), 1400),
    (("1990-03-04", "1993-03-31", "1992-03-04", 0.07, 10000, 1, 0), 1401.94444444444),
    (("1990-03-04", "1993-03-31", "1992-03-04", 0.07, 10000, 2, 1), 1398.07692307692),
    (("1990-03-04", "1993-03-31", "1992-03-04", 0.07, 10000, 2, 3), 1399.04109589041),
    (("1990-03-04", "1993-03-31", "1992-03-04", 0.07, 10000, 4, 4), 1400),
    (("1990-03-04", "2010-07-05", "1992-03-04", 0.07, 10000, 1, 2), 1226.94444444444),
    (("1990-03-04", "2010-07-05", "1992-03-04", 0.07, 10000, 4, 1), 1358.37606837607),
    (("2008-01-31", "2008-07-31", "2009-01-31", 0.1, 1000, 2, 0, True), 100),
    (("2008-01-31", "2008-07-31", "2009-01-31", 0.1, 1000, 2, 0, False), 50),
    (("2008-01-31", "2008-07-31", "2009-04-30", 0.1, 1000, 2, 0, True), 125),
    ((SETTLEMENT, FIRST, ISSUE, 0.1, 1000, 2), NUM_OF_ACCRUED_INTEREST),
    ((ISSUE, FIRST, SETTLEMENT, 0, 1000, 2), NUM_OF_ACCRUED_INTEREST),
    ((ISSUE, FIRST, SETTLEMENT, 0.1, 0, 2), NUM_OF_ACCRUED_INTEREST),
    ((ISSUE, FIRST, SETTLEMENT, 0.1, 1000, 3), NUM_OF_ACCRUED_INTEREST),
    ((ISSUE, FIRST, SETTLEMENT, 0.1, 1000, 2, 5), NUM_OF_ACCRUED_INTEREST),
    ((ISSUE, FIRST, SETTLEMENT, True, 1000, 2), VALUE_OF_ACCRUED_INTEREST),
]


@pytest.mark.parametrize(("arguments", "expected"), VALUES_OF_ACCRUED_INTEREST)
def test_values_accrued_interest(check, arguments, expected):
    check("ACCRINT", arguments, expected, rel=1e-13)


def test_interest_of_periods_adds_up(evaluate):
    """With months of 30 days, days of issue and settlement may be cut anywhere."""
    whole = evaluate("ACCRINT", 40000.0, 40500.0, 41200.0, 0.1, 1000.0, 4.0, 4.0)
    assert whole == pytest.approx(100 * evaluate("YEARFRAC", 40000.0, 41200.0, 4.0), rel=1e-2)
