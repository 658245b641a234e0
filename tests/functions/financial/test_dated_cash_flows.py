from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.functions.families import function_named

NUM, VALUE, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

FLOWS = [[-10000], [2750], [4250], [3250], [2750]]
DATES = [["2008-01-01"], ["2008-03-01"], ["2008-10-30"], ["2009-02-15"], ["2009-04-01"]]

VALUES = [
    ("XNPV", (0.09, FLOWS, DATES), 2086.6476020315),
    ("XNPV", (0.09, [*FLOWS, [None]], [*DATES, [None]]), 2086.6476020315),
    ("XNPV", (1, [[100, 200]], [[40000.9, 40365.1]]), 200),
    ("XNPV", (0, FLOWS, DATES), NUM),
    ("XNPV", (-0.5, FLOWS, DATES), NUM),
    ("XNPV", (0.1, [[100, 200]], [[40000, 39999]]), NUM),
    ("XNPV", (0.1, [[100, 200]], [[-1, 2]]), NUM),
    ("XNPV", (0.1, [[100, 200]], [[40000]]), NUM),
    ("XNPV", (0.1, [[100, 200]], [[40000, "x"]]), VALUE),
    ("XNPV", (0.1, [[True, 200]], [[40000, 40001]]), VALUE),
    ("XNPV", (0.1, [[100, NA]], [["x", 40001]]), NA),
    ("XNPV", (True, FLOWS, DATES), VALUE),
    ("XIRR", (FLOWS, DATES, 0.1), 0.373362533518831),
    ("XIRR", (FLOWS, DATES), 0.373362533518831),
    ("XIRR", ([[15108163.3840923, -75382259.6628424]], [["2000-02-29", "2000-03-31"]]), 165601346.134845),
    ("XIRR", ([[206101714.849377, -156650972.54265]], [["2000-02-29", "2000-03-31"]], -0.1), -0.960452194979854),
    ("XIRR", ([[0, -100, 110]], [[40000, 40100, 40465]]), 0.1),
    ("XIRR", ([[100, 110]], [[40000, 40365]]), NUM),
    ("XIRR", ([[-100, 110]], [[40000, 39000]]), NUM),
    ("XIRR", ([[-100, 110]], [[40000, 40365]], "x"), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-10)


@given(st.floats(0.001, 2.0), st.lists(st.tuples(st.floats(1, 100), st.integers(1, 4000)), min_size=1, max_size=8))
def test_the_rate_is_found_again(evaluate, rate, receipts):
    dates = [[40000.0, *(40000.0 + days for _, days in receipts)]]
    price = evaluate("XNPV", rate, [[0.0, *(x for x, _ in receipts)]], dates)
    found = evaluate("XIRR", [[-price, *(x for x, _ in receipts)]], dates)
    assert found == pytest.approx(rate, rel=1e-8)


def test_dates_count_from_1904_too(value):
    """A serial near the end of the calendar is a date in one system only."""
    arguments = [value(0.1), value([[1, 2]]), value([[2957000, 2957365]])]
    assert function_named("XNPV").body(*arguments).errors.tolist() == [0]
    assert function_named("XNPV").body(*arguments, date1904=True).errors.tolist() == [NUM]
