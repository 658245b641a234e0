from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode

NUM, VALUE = ErrorCode.NUM, ErrorCode.VALUE

ISSUE, FIRST, SETTLEMENT = "2008-03-01", "2008-08-31", "2008-05-01"

VALUES = [
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
    ((SETTLEMENT, FIRST, ISSUE, 0.1, 1000, 2), NUM),
    ((ISSUE, FIRST, SETTLEMENT, 0, 1000, 2), NUM),
    ((ISSUE, FIRST, SETTLEMENT, 0.1, 0, 2), NUM),
    ((ISSUE, FIRST, SETTLEMENT, 0.1, 1000, 3), NUM),
    ((ISSUE, FIRST, SETTLEMENT, 0.1, 1000, 2, 5), NUM),
    ((ISSUE, FIRST, SETTLEMENT, True, 1000, 2), VALUE),
]


@pytest.mark.parametrize(("arguments", "expected"), VALUES)
def test_values(check, arguments, expected):
    check("ACCRINT", arguments, expected, rel=1e-13)


def test_interest_of_periods_adds_up(evaluate):
    """With months of 30 days, days of issue and settlement may be cut anywhere."""
    whole = evaluate("ACCRINT", 40000.0, 40500.0, 41200.0, 0.1, 1000.0, 4.0, 4.0)
    assert whole == pytest.approx(100 * evaluate("YEARFRAC", 40000.0, 41200.0, 4.0), rel=1e-2)
