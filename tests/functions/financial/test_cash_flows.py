from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.functions.families import function_named
from xlmc.functions.values import Value

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
    found = evaluate("IRR", [[-price, *receipts]])
    assert found == pytest.approx(rate, rel=1e-8, abs=1e-9)


def test_trials_and_rates_of_many_cells():
    flows = Value.of_numbers(np.array([[[2.0, 4.0]], [[4.0, 8.0]]]))
    rates = Value.of_numbers(np.array([[[0.0], [1.0]]]))
    assert function_named("NPV")([rates, flows]).numbers.tolist() == [[[6.0], [2.0]], [[12.0], [4.0]]]
