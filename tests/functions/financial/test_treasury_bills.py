from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode

NUM, VALUE = ErrorCode.NUM, ErrorCode.VALUE

VALUES = [
    ("TBILLEQ", ("2008-03-31", "2008-06-01", 0.0914), 0.094151493565943),
    ("TBILLEQ", ("2008-03-31", "2009-04-01", 0.0914), NUM),
    ("TBILLEQ", ("2008-03-31", "2009-03-31", 0), NUM),
    ("TBILLEQ", ("2008-03-31", "2009-03-31", 1), NUM),
    ("TBILLPRICE", ("2008-03-31", "2008-06-01", 0.09), 98.45),
    ("TBILLPRICE", ("2008-03-31", "2008-06-01", 9), NUM),
    ("TBILLPRICE", ("2008-03-31", "2008-03-31", 0.09), NUM),
    ("TBILLYIELD", ("2008-03-31", "2008-06-01", 98.45), 0.0914169629253426),
    ("TBILLYIELD", ("2008-03-31", "2008-06-01", 0), NUM),
    ("TBILLYIELD", ("2008-03-31", "2008-06-01", True), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-12)


@given(st.integers(183, 366), st.floats(0.001, 0.3))
def test_beyond_half_a_year_a_coupon_falls_in_between(evaluate, days, discount):
    """Worth 1 + y/2 after half a year, then simple interest; the start is in a leap year, so that 366 days are one."""
    y = evaluate("TBILLEQ", 39448.0, 39448.0 + days, discount)
    x = days / (366 if days == 366 else 365)
    assert (1 + y / 2) * (1 + y * (x - 0.5)) == pytest.approx(1 / (1 - discount * days / 360), rel=1e-9)
