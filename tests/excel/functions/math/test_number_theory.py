from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value

DIV0, NUM, VALUE, NA = ErrorCode.DIV0, ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

MIXED = [["1", 2, None]]

TABLE = [
    ("GCD", (5, 2), 1),
    ("GCD", (24, 36), 12),
    ("GCD", (7, 1), 1),
    ("GCD", (5, 0), 5),
    ("GCD", (0, 0), 0),
    ("GCD", (24.9, 36.9), 12),
    ("GCD", ([[120, 240], ["60", "150"]],), 30),
    ("GCD", ([[24, None]],), 24),
    ("GCD", ([[24, "one"]],), VALUE),
    ("GCD", ([[24, True]],), VALUE),
    ("GCD", (-1,), NUM),
    ("GCD", (-0.00037, 2), NUM),
    ("GCD", (9.007e15,), 9.007e15),
    ("GCD", (9.008e15,), NUM),
    ("GCD", (4, [[DIV0, NA]]), DIV0),
    ("GCD", ("x", -1), VALUE),
    ("GCD", (-1, "x"), NUM),
    ("LCM", (5, 2), 10),
    ("LCM", (24, 36), 72),
    ("LCM", ([[1, 2, 3], [4, 5, 6]],), 60),
    ("LCM", (5, 0), 0),
    ("LCM", (MIXED,), 2),
    ("LCM", (24.9, 36.9), 72),
    ("LCM", (-1, 2), NUM),
    ("LCM", (2**26 + 1, 2**26), 2**52 + 2**26),
    ("LCM", (2**27 + 1, 2**26), NUM),
    ("LCM", (2**27 + 1, 2**26, 0), NUM),
    ("LCM", (1e16,), NUM),
    ("COMBIN", (8, 2), 28),
    ("COMBIN", (19, 7), 50388),
    ("COMBIN", (20.1, 2.9), 190),
    ("COMBIN", (5, 5.5), 1),
    ("COMBIN", (0, 0), 1),
    ("COMBIN", (5, 6), NUM),
    ("COMBIN", (-1, 0), NUM),
    ("COMBIN", (0.1, -0.1), NUM),
    ("COMBIN", (2147483647, 1), NUM),
    ("COMBIN", (2147483646, 1), 2147483646),
    ("COMBIN", (5e301, 6), NUM),
    ("COMBIN", (1100, 550), NUM),
    ("COMBIN", ("x", 1), VALUE),
    ("COMBIN", (True, None), 1),
    ("COMBINA", (4, 3), 20),
    ("COMBINA", (10, 3), 220),
    ("COMBINA", (10, 15), 1307504),
    ("COMBINA", (0, 0.4), 1),
    ("COMBINA", (1, 0), 1),
    ("COMBINA", (0, 3), NUM),
    ("COMBINA", (-1, 2), NUM),
    ("COMBINA", (2, -2), NUM),
    ("COMBINA", (2147483648, 1), NUM),
    ("PERMUT", (100, 3), 970200),
    ("PERMUT", (3, 2), 6),
    ("PERMUT", (3.9, 2.9), 6),
    ("PERMUT", (170, 170), float(math.factorial(170))),
    ("PERMUT", (171, 171), NUM),
    ("PERMUT", (1e9, 2), 1e9 * (1e9 - 1)),
    ("PERMUT", (2, 3), NUM),
    ("PERMUT", (0, 0), NUM),
    ("PERMUT", (3, -1), NUM),
    ("PERMUTATIONA", (3, 2), 9),
    ("PERMUTATIONA", (2.9, 2.9), 4),
    ("PERMUTATIONA", (0, 0), 1),
    ("PERMUTATIONA", (0, 1), NUM),
    ("PERMUTATIONA", (-1, 1), NUM),
    ("PERMUTATIONA", (10, 309), NUM),
    ("FACTDOUBLE", (6,), 48),
    ("FACTDOUBLE", (7,), 105),
    ("FACTDOUBLE", (0,), 1),
    ("FACTDOUBLE", (-1,), 1),
    ("FACTDOUBLE", (-1.5,), NUM),
    ("FACTDOUBLE", (2.8,), 2),
    ("FACTDOUBLE", (300,), float(math.prod(range(2, 301, 2)))),
    ("FACTDOUBLE", (301,), NUM),
    ("FACTDOUBLE", ("x",), VALUE),
    ("FACTDOUBLE", ("6",), 48),
    ("MULTINOMIAL", (2, 3, 4), 1260),
    ("MULTINOMIAL", (5,), 1),
    ("MULTINOMIAL", ([[2, None], [5, "3"]],), 2520),
    ("MULTINOMIAL", (2.9, 3.9), 10),
    ("MULTINOMIAL", (5, -1), NUM),
    ("MULTINOMIAL", (1e100,), NUM),
    ("MULTINOMIAL", ([[True, 5]],), VALUE),
    ("MULTINOMIAL", (5, DIV0), DIV0),
    ("ISEVEN", (-1,), False),
    ("ISEVEN", (2.5,), True),
    ("ISEVEN", (0,), True),
    ("ISEVEN", (None,), True),
    ("ISEVEN", ("4",), True),
    ("ISEVEN", ("four",), VALUE),
    ("ISEVEN", (NA,), NA),
    ("ISODD", (-1,), True),
    ("ISODD", (2.5,), False),
    ("ISODD", (5.9,), True),
    ("ISODD", ("x",), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-14 if arguments == (170, 170) else 0.0)


@given(st.integers(0, 1100), st.integers(0, 1100))
@example(1029, 514)
@example(170, 85)
@settings(max_examples=200, deadline=None)
def test_ways_to_choose_agree_with_whole_numbers(evaluate, n, k):
    result = evaluate("COMBIN", n, k)
    exact = math.comb(n, k)
    if k > n or exact >= 2**1024:
        assert result is NUM
    else:
        assert result == pytest.approx(exact, rel=1e-13)
        assert result == exact or exact > 2**50


@given(st.lists(st.integers(0, 60), min_size=1, max_size=5))
@settings(max_examples=100, deadline=None)
def test_multinomials_are_quotients_of_factorials(evaluate, counts):
    exact = math.factorial(sum(counts)) // math.prod(math.factorial(count) for count in counts)
    assert evaluate("MULTINOMIAL", [counts]) == pytest.approx(exact, rel=1e-13)


@given(st.lists(st.integers(1, 10**6), min_size=1, max_size=4))
@settings(max_examples=100, deadline=None)
def test_divisors_and_multiples(evaluate, numbers):
    assert evaluate("GCD", [numbers]) == math.gcd(*numbers)
    multiple = math.lcm(*numbers)
    assert evaluate("LCM", [numbers]) == (multiple if multiple < 2**53 else NUM)


def test_few_chosen_beside_many_take_nothing_of_them():
    """The loop over factors runs as far as the trial with the most of them."""
    number, chosen = Value.of_numbers(np.array([5.0, 1000.0, 3.0])), Value.of_numbers(np.array([2.0, 200.0, 7.0]))
    for name, few in (("COMBIN", 10.0), ("COMBINA", 15.0), ("PERMUT", 20.0)):
        assert function_named(name)([number, chosen]).objects()[0] == few
