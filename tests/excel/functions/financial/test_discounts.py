from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode

NUM, VALUE = ErrorCode.NUM, ErrorCode.VALUE

VALUES = [
    ("DISC", ("2007-01-25", "2007-06-15", 97.975, 100, 1), 0.0524202127659576),
    ("DISC", ("2007-06-15", "2007-01-25", 97.975, 100, 1), NUM),
    ("DISC", ("2007-01-25", "2007-06-15", 0, 100, 1), NUM),
    ("DISC", ("2007-01-25", "2007-06-15", 97, 0, 1), NUM),
    ("DISC", ("2007-01-25", "2007-06-15", 97, 100, 5), NUM),
    ("DISC", ("2007-01-30", "2007-01-31", 97, 100, 0), NUM),
    ("DISC", (True, "2007-06-15", 97, 100), VALUE),
    ("INTRATE", ("2008-02-15", "2008-05-15", 1000000, 1014420, 2), 0.05768),
    ("INTRATE", ("2008-02-15", "2008-05-15", 0, 1014420, 2), NUM),
    ("PRICEDISC", ("2008-02-16", "2008-03-01", 0.0525, 100, 2), 99.7958333333333),
    ("PRICEDISC", ("2008-02-16", "2008-03-01", 0, 100, 2), NUM),
    ("RECEIVED", ("2008-02-15", "2008-05-15", 1000000, 0.0575, 2), 1014584.6544071),
    ("RECEIVED", ("2008-02-15", "2009-05-15", 1000000, 1, 2), NUM),
    ("YIELDDISC", ("2008-02-16", "2008-03-01", 99.795, 100, 2), 0.0528225719868583),
    ("YIELDDISC", ("2008-02-16", "2008-03-01", 0, 100, 2), NUM),
    ("ACCRINTM", ("2008-04-01", "2008-06-15", 0.1, 1000, 3), 20.5479452054795),
    ("ACCRINTM", ("2008-04-01", "2008-06-15", 0.1), 20.5555555555556),
    ("ACCRINTM", ("2008-04-01", "2008-06-15", 0, 1000, 3), NUM),
    ("ACCRINTM", ("2008-06-15", "2008-04-01", 0.1, 1000, 3), NUM),
    ("PRICEMAT", ("2008-02-15", "2008-04-13", "2007-11-11", 0.061, 0.061, 0), 99.9844988755569),
    ("PRICEMAT", ("2008-02-15", "2008-04-13", "2007-11-11", -0.061, 0.061, 0), NUM),
    ("PRICEMAT", ("2008-04-13", "2008-02-15", "2007-11-11", 0.061, 0.061, 0), NUM),
    ("PRICEMAT", ("2008-02-15", "2008-04-13", "2008-02-16", 0.061, 0.061, 0), NUM),
    ("YIELDMAT", ("2008-03-15", "2008-11-03", "2007-11-08", 0.0625, 100.0123, 0), 0.0609543336915386),
    ("YIELDMAT", ("2008-03-15", "2008-11-03", "2007-11-08", 0.0625, 0, 0), NUM),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-12)


@pytest.mark.parametrize("basis", [0.0, 1.0, 2.0, 3.0, 4.0])
def test_prices_and_rates_are_inverse(evaluate, basis):
    dates = 39500.0, 39800.0
    price = evaluate("PRICEDISC", *dates, 0.07, 100.0, basis)
    assert evaluate("DISC", *dates, price, 100.0, basis) == pytest.approx(0.07)
    received = evaluate("RECEIVED", *dates, price, 0.07, basis)
    assert received == pytest.approx(100)
    assert evaluate("YIELDDISC", *dates, price, received, basis) == evaluate("INTRATE", *dates, price, received, basis)
    price = evaluate("PRICEMAT", *dates, 39000.0, 0.05, 0.08, basis)
    assert evaluate("YIELDMAT", *dates, 39000.0, 0.05, price, basis) == pytest.approx(0.08)


NUM_OF_TREASURY_BILLS, VALUE_OF_TREASURY_BILLS = ErrorCode.NUM, ErrorCode.VALUE

VALUES_OF_TREASURY_BILLS = [
    ("TBILLEQ", ("2008-03-31", "2008-06-01", 0.0914), 0.094151493565943),
    ("TBILLEQ", ("2008-03-31", "2009-04-01", 0.0914), NUM_OF_TREASURY_BILLS),
    ("TBILLEQ", ("2008-03-31", "2009-03-31", 0), NUM_OF_TREASURY_BILLS),
    ("TBILLEQ", ("2008-03-31", "2009-03-31", 1), NUM_OF_TREASURY_BILLS),
    ("TBILLPRICE", ("2008-03-31", "2008-06-01", 0.09), 98.45),
    ("TBILLPRICE", ("2008-03-31", "2008-06-01", 9), NUM_OF_TREASURY_BILLS),
    ("TBILLPRICE", ("2008-03-31", "2008-03-31", 0.09), NUM_OF_TREASURY_BILLS),
    ("TBILLYIELD", ("2008-03-31", "2008-06-01", 98.45), 0.0914169629253426),
    ("TBILLYIELD", ("2008-03-31", "2008-06-01", 0), NUM_OF_TREASURY_BILLS),
    ("TBILLYIELD", ("2008-03-31", "2008-06-01", True), VALUE_OF_TREASURY_BILLS),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES_OF_TREASURY_BILLS)
def test_values_treasury_bills(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-12)


@given(st.integers(183, 366), st.floats(0.001, 0.3))
def test_beyond_half_a_year_a_coupon_falls_in_between(evaluate, days, discount):
    """Worth 1 + y/2 after half a year, then simple interest; the start is in a leap year, so that 366 days are one."""
    y = evaluate("TBILLEQ", 39448.0, 39448.0 + days, discount)
    x = days / (366 if days == 366 else 365)
    assert (1 + y / 2) * (1 + y * (x - 0.5)) == pytest.approx(1 / (1 - discount * days / 360), rel=1e-9)
