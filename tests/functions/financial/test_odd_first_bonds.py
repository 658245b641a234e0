from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode

NUM, VALUE = ErrorCode.NUM, ErrorCode.VALUE

SHORT = "2008-11-11", "2021-03-01", "2008-10-15", "2009-03-01"
LONG = "1999-02-28", "2010-06-30", "1998-02-28", "2009-06-30"
MONTH_ENDS = "2002-03-31", "2004-03-31", "2001-03-31", "2003-03-31"

VALUES = [
    ("ODDFPRICE", (*SHORT, 0.0785, 0.0625, 100, 2, 1), 113.597717474079),
    ("ODDFPRICE", (*LONG, 0.07, 0.03, 100, 1, 0), 128.0105899192),
    ("ODDFPRICE", (*LONG, 0.07, 0.03, 100, 2, 1), 127.7049586143),
    ("ODDFPRICE", (*LONG, 0.07, 0.03, 100, 2, 2), 127.6193871525),
    ("ODDFPRICE", (*LONG, 0.07, 0.03, 100, 4, 1), 127.5554755738),
    ("ODDFPRICE", (*MONTH_ENDS, 0.1, 0.1, 130, 2, 1), 123.4999641185),
    ("ODDFPRICE", (*MONTH_ENDS, 0.1, 0.1, 130, 4, 3), 123.3392895892),
    ("ODDFPRICE", (*MONTH_ENDS, 0.1, 0.1, 130, 4, 4), 123.3364745004),
    ("ODDFPRICE", ("2008-11-11", "2021-03-02", "2008-10-15", "2009-03-01", 0.0785, 0.0625, 100, 2, 1), NUM),
    ("ODDFPRICE", ("2008-10-15", "2021-03-01", "2008-11-11", "2009-03-01", 0.0785, 0.0625, 100, 2, 1), NUM),
    ("ODDFPRICE", ("2009-03-01", "2021-03-01", "2008-10-15", "2009-03-01", 0.0785, 0.0625, 100, 2, 1), NUM),
    ("ODDFPRICE", (*SHORT, -0.0785, 0.0625, 100, 2, 1), NUM),
    ("ODDFPRICE", (*SHORT, 0.0785, -0.0625, 100, 2, 1), NUM),
    ("ODDFPRICE", (*SHORT, 0.0785, 0.0625, -100, 2, 1), NUM),
    ("ODDFPRICE", (*SHORT, 0.0785, 0.0625, 100, 3, 1), NUM),
    ("ODDFPRICE", (*SHORT, True, 0.0625, 100, 3, 1), VALUE),
    ("ODDFYIELD", (*SHORT, 0.0575, 84.5, 100, 2, 0), 0.0772455415972),
    ("ODDFYIELD", (*SHORT, 0.0575, -84.5, 100, 2, 0), NUM),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-11)


@given(
    st.integers(1, 1200),
    st.integers(1, 1200),
    st.floats(0.001, 0.2),
    st.floats(0.001, 0.3),
    st.sampled_from([1.0, 2.0, 4.0]),
    st.sampled_from([0.0, 1.0, 2.0, 3.0, 4.0]),
)
def test_the_yield_is_found_again(evaluate, before, after, rate, yield_, frequency, basis):
    dates = 40000.0, 44256.0, 40000.0 - before, 41334.0 - min(after, 1000) // 365 * 365.0
    dates = (*dates[:3], evaluate("COUPPCD", dates[3], 44256.0, frequency, basis))
    pr = evaluate("ODDFPRICE", *dates, rate, yield_, 100.0, frequency, basis)
    assert isinstance(pr, float)
    if pr > 0:
        found = evaluate("ODDFYIELD", *dates, rate, pr, 100.0, frequency, basis)
        assert found == pytest.approx(yield_, rel=1e-8)
