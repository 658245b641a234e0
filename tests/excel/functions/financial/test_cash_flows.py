from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value

NUM, VALUE, DIV0, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.DIV0, ErrorCode.NA

FLOWS = [[-70000], [12000], [15000], [18000], [21000], [26000]]

VALUES = [
    ("NPV", (0.1, -10000, 3000, 4200, 6800), 1188.4434123352207),
    ("NPV", (0.08, [[8000], [9200], [10000], [12000], [14500]]), 41922.0615549214),
    ("NPV", (0.08, [[8000], [9200], [10000], [12000], [14500]], -9000), 36250.5349129837),
    ("NPV", (1, [[8, None, "x", True, 8]], "8"), 7),
    ("NPV", (1, True, None), 0.5),
    ("NPV", (1, "x"), VALUE),
    ("NPV", (1, [[1, NA]], "x"), NA),
    ("NPV", ("x", [[NA]]), VALUE),
    ("NPV", (-1, 1), DIV0),
    ("IRR", (FLOWS,), 0.0866309480365316),
    ("IRR", (FLOWS[:5],), -0.0212448482734104),
    ("IRR", (FLOWS[:3], -0.1), -0.443506941334741),
    ("IRR", ([[-2860, None, None, 8860]],), 8860 / 2860 - 1),
    ("IRR", ([[-2860, 0, 0, 8860]],), (8860 / 2860) ** (1 / 3) - 1),
    ("IRR", ([[0, 0, -100, 150, 0]],), 0.5),
    ("IRR", ([[-100, "x", True, 150]],), 0.5),
    ("IRR", ([[100, 150]],), NUM),
    ("IRR", ([[-100, 150, NA]],), NA),
    ("IRR", ([[-100, 150]], -1), NUM),
    ("IRR", ([[-100, 150]], "x"), VALUE),
    ("IRR", ([[-100, 230, -132]], 0.0), 0.1),
    ("IRR", ([[-100, 230, -132]], 0.3), 0.2),
    ("IRR", ([[-100, 10, -100]],), NUM),
    ("MIRR", ([[-120000], [39000], [30000], [21000], [37000], [46000]], 0.1, 0.12), 0.126094130365905),
    ("MIRR", ([[-120000], [39000], [30000], [21000]], 0.1, 0.12), -0.048044655249981),
    ("MIRR", ([[-120000], [39000], [30000], [21000], [37000], [46000]], 0.1, 0.14), 0.134759110828315),
    ("MIRR", ([[1, 2]], 0.1, 0.1), DIV0),
    ("MIRR", ([[-1, 2]], "x", NA), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-11)


@given(st.floats(-0.6, 3.0), st.lists(st.floats(1, 100), min_size=1, max_size=12))
def test_the_rate_is_found_again(evaluate, rate, receipts):
    """What the receipts are worth at a rate is the price at which that is their return."""
    price = sum(x / (1 + rate) ** (i + 1) for i, x in enumerate(receipts))
    result = evaluate("IRR", [[-price, *receipts]])
    assert result == pytest.approx(rate, rel=1e-8, abs=1e-9)


def test_trials_and_rates_of_many_cells():
    flows = Value.of_numbers(np.array([[[2.0, 4.0]], [[4.0, 8.0]]]))
    rates = Value.of_numbers(np.array([[[0.0], [1.0]]]))
    assert function_named("NPV")([rates, flows]).numbers.tolist() == [[[6.0], [2.0]], [[12.0], [4.0]]]


NUM_OF_DATED_CASH_FLOWS, VALUE_OF_DATED_CASH_FLOWS, NA_OF_DATED_CASH_FLOWS = (
    ErrorCode.NUM,
    ErrorCode.VALUE,
    ErrorCode.NA,
)

FLOWS_OF_DATED_CASH_FLOWS = [[-10000], [2750], [4250], [3250], [2750]]
DATES = [["2008-01-01"], ["2008-03-01"], ["2008-10-30"], ["2009-02-15"], ["2009-04-01"]]

VALUES_OF_DATED_CASH_FLOWS = [
    ("XNPV", (0.09, FLOWS_OF_DATED_CASH_FLOWS, DATES), 2086.6476020315),
    ("XNPV", (0.09, [*FLOWS_OF_DATED_CASH_FLOWS, [None]], [*DATES, [None]]), 2086.6476020315),
    ("XNPV", (1, [[100, 200]], [[40000.9, 40365.1]]), 200),
    ("XNPV", (0, FLOWS_OF_DATED_CASH_FLOWS, DATES), NUM_OF_DATED_CASH_FLOWS),
    ("XNPV", (-0.5, FLOWS_OF_DATED_CASH_FLOWS, DATES), NUM_OF_DATED_CASH_FLOWS),
    ("XNPV", (0.1, [[100, 200]], [[40000, 39999]]), NUM_OF_DATED_CASH_FLOWS),
    ("XNPV", (0.1, [[100, 200]], [[-1, 2]]), NUM_OF_DATED_CASH_FLOWS),
    ("XNPV", (0.1, [[100, 200]], [[40000]]), NUM_OF_DATED_CASH_FLOWS),
    ("XNPV", (0.1, [[100, 200]], [[40000, "x"]]), VALUE_OF_DATED_CASH_FLOWS),
    ("XNPV", (0.1, [[True, 200]], [[40000, 40001]]), VALUE_OF_DATED_CASH_FLOWS),
    ("XNPV", (0.1, [[100, NA_OF_DATED_CASH_FLOWS]], [["x", 40001]]), NA_OF_DATED_CASH_FLOWS),
    ("XNPV", (True, FLOWS_OF_DATED_CASH_FLOWS, DATES), VALUE_OF_DATED_CASH_FLOWS),
    ("XIRR", (FLOWS_OF_DATED_CASH_FLOWS, DATES, 0.1), 0.373362533518831),
    ("XIRR", (FLOWS_OF_DATED_CASH_FLOWS, DATES), 0.373362533518831),
    ("XIRR", ([[15108163.3840923, -75382259.6628424]], [["2000-02-29", "2000-03-31"]]), 165601346.134845),
    ("XIRR", ([[206101714.849377, -156650972.54265]], [["2000-02-29", "2000-03-31"]], -0.1), -0.960452194979854),
    ("XIRR", ([[0, -100, 110]], [[40000, 40100, 40465]]), 0.1),
    ("XIRR", ([[100, 110]], [[40000, 40365]]), NUM_OF_DATED_CASH_FLOWS),
    ("XIRR", ([[-100, 110]], [[40000, 39000]]), NUM_OF_DATED_CASH_FLOWS),
    ("XIRR", ([[-100, 110]], [[40000, 40365]], "x"), VALUE_OF_DATED_CASH_FLOWS),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES_OF_DATED_CASH_FLOWS)
def test_values_dated_cash_flows(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-10)


@given(st.floats(0.001, 2.0), st.lists(st.tuples(st.floats(1, 100), st.integers(1, 4000)), min_size=1, max_size=8))
def test_the_rate_is_found_again_dated_cash_flows(evaluate, rate, receipts):
    dates = [[40000.0, *(40000.0 + days for _, days in receipts)]]
    price = evaluate("XNPV", rate, [[0.0, *(x for x, _ in receipts)]], dates)
    result = evaluate("XIRR", [[-price, *(x for x, _ in receipts)]], dates)
    assert result == pytest.approx(rate, rel=1e-8)


def test_dates_count_from_1904_too(value):
    """A serial near the end of the calendar is a date in one system only."""
    arguments = [value(0.1), value([[1, 2]]), value([[2957000, 2957365]])]
    assert function_named("XNPV").body(*arguments).errors.tolist() == [0]
    assert function_named("XNPV").body(*arguments, date1904=True).errors.tolist() == [NUM_OF_DATED_CASH_FLOWS]
