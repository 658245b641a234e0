from __future__ import annotations

import math
from decimal import ROUND_CEILING, ROUND_DOWN, ROUND_FLOOR, ROUND_HALF_UP, ROUND_UP, Context, Decimal

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named

DIV0, NUM, VALUE, NA = ErrorCode.DIV0, ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

DIGITS = [
    ("ROUND", (2.15, 1), 2.2),
    ("ROUND", (2.149, 1), 2.1),
    ("ROUND", (-1.475, 2), -1.48),
    ("ROUND", (21.5, -1), 20),
    ("ROUND", (626.3, -3), 1000),
    ("ROUND", (1.98, -1), 0),
    ("ROUND", (-50.55, -2), -100),
    ("ROUND", (2.675, 2), 2.68),
    ("ROUND", (1.005, 2), 1.01),
    ("ROUND", (0.285, 2), 0.29),
    ("ROUND", (1.5, 0), 2),
    ("ROUND", (2.5, 0), 3),
    ("ROUND", (-2.5, 0), -3),
    ("ROUND", (0.5 - 2**-54, 0), 1),
    ("ROUND", (0.049999999999999975, 1), 0.1),  # as Excel: the 15 digits it sees are 0.0500000000000000
    ("ROUND", (8.445480112856497, 12), 8.445480112857),
    ("ROUND", (1000.2555 - 999, 3), 1.255),  # 1.25549999999998: no half to 15 digits either
    ("ROUND", (2.5, 0.9), 3),
    ("ROUND", (255, -1.9), 260),
    ("ROUND", (0.1 + 0.2, 20), 0.1 + 0.2),
    ("ROUND", (1e300, 2), 1e300),
    ("ROUND", (123.456, 400), 123.456),
    ("ROUND", (123.456, -400), 0),
    ("ROUND", (123456789012345.25, 0), 123456789012345),
    ("ROUND", (123456789012345.5, 0), 123456789012346),
    ("ROUND", (1234567890123456.25, 0), 1234567890123456),
    ("ROUNDUP", (123456789012345.25, 0), 123456789012345),  # the step is the 15th digit: all round to it
    ("ROUND", (0, 3), 0),
    ("ROUND", ("2.345", "2"), 2.35),
    ("ROUND", (True, None), 1),
    ("ROUND", ("x", 1), VALUE),
    ("ROUND", (NA, "x"), NA),
    ("ROUNDUP", (3.2, 0), 4),
    ("ROUNDUP", (76.9, 0), 77),
    ("ROUNDUP", (3.14159, 3), 3.142),
    ("ROUNDUP", (-3.14159, 1), -3.2),
    ("ROUNDUP", (31415.92654, -2), 31500),
    ("ROUNDUP", (1.1, 1), 1.1),
    ("ROUNDUP", (4.35 * 100, 0), 435),
    ("ROUNDUP", (0.1 + 0.2, 1), 0.3),
    ("ROUNDUP", (1e-300, 0), 1),
    ("ROUNDUP", (0, 0), 0),
    ("ROUNDDOWN", (3.2, 0), 3),
    ("ROUNDDOWN", (76.9, 0), 76),
    ("ROUNDDOWN", (3.14159, 3), 3.141),
    ("ROUNDDOWN", (-3.14159, 1), -3.1),
    ("ROUNDDOWN", (31415.92654, -2), 31400),
    ("ROUNDDOWN", (1.15, 2), 1.15),
    ("ROUNDDOWN", (4.35 * 100, 0), 435),
    ("TRUNC", (8.9,), 8),
    ("TRUNC", (-8.9,), -8),
    ("TRUNC", (0.45,), 0),
    ("TRUNC", (-0.45,), 0),
    ("TRUNC", (12.345, 2), 12.34),
    ("TRUNC", (0.09999999999999995, 1), 0.1),  # 0.100000000000000 to 15 digits
    ("TRUNC", (0.09999999999999994, 1), 0),
    ("INT", (8.9,), 8),
    ("INT", (-8.9,), -9),
    ("INT", (-8,), -8),
    ("INT", (880000000 * 0.00849 / 3,), 2490400),
    ("INT", (123456789 - 0.0000004,), 123456789),
    ("INT", (123456789 - 0.0000005,), 123456788),
    ("INT", (1e14 - 1 + 0.5,), 99999999999999),
    ("INT", (1e14 + 0.5,), 100000000000001),
    ("INT", (2.0**53,), 2.0**53),
    ("INT", (None,), 0),
    ("INT", ("abc",), VALUE),
]

MULTIPLES = [
    ("CEILING", (2.5, 1), 3),
    ("CEILING", (-2.5, -2), -4),
    ("CEILING", (-2.5, 2), -2),
    ("CEILING", (1.5, 0.1), 1.5),
    ("CEILING", (0.234, 0.01), 0.24),
    ("CEILING", (2.5, -1), NUM),
    ("CEILING", (2.5, 0), 0),
    ("CEILING", (0, -1), 0),
    ("CEILING", (1.1, 0.1), 1.1),
    ("CEILING", (1.6, 0.7 + 0.1), 1.6),
    ("CEILING", (-0.5, 1), 0),
    ("FLOOR", (3.7, 2), 2),
    ("FLOOR", (-2.5, -2), -2),
    ("FLOOR", (2.5, -2), NUM),
    ("FLOOR", (1.58, 0.1), 1.5),
    ("FLOOR", (0.234, 0.01), 0.23),
    ("FLOOR", (-2.5, 2), -4),
    ("FLOOR", (2.5, 0), DIV0),
    ("FLOOR", (0, 0), 0),
    ("FLOOR", (7.1, 0.1), 7.1),
    ("FLOOR", (0.6, 0.2), 0.6),
    ("FLOOR", (0.9, 0.1 * 3), 0.9),
    ("CEILING.MATH", (24.3, 5), 25),
    ("CEILING.MATH", (6.7,), 7),
    ("CEILING.MATH", (-8.1, 2), -8),
    ("CEILING.MATH", (-5.5, 2, -1), -6),
    ("CEILING.MATH", (-3.8, -0.2), -3.8),
    ("CEILING.MATH", (-5.5,), -5),
    ("CEILING.MATH", (5.5, 2, 1), 6),
    ("CEILING.MATH", (5.5, -2), 6),
    ("CEILING.MATH", (6.7, 0), 0),
    ("FLOOR.MATH", (24.3, 5), 20),
    ("FLOOR.MATH", (6.7,), 6),
    ("FLOOR.MATH", (-8.1, 2), -10),
    ("FLOOR.MATH", (-5.5, 2, -1), -4),
    ("FLOOR.MATH", (-5.5,), -6),
    ("FLOOR.MATH", (6.7, 0), 0),
    ("MROUND", (10, 3), 9),
    ("MROUND", (-10, -3), -9),
    ("MROUND", (1.3, 0.2), 1.4),
    ("MROUND", (5, -2), NUM),
    ("MROUND", (-5, 2), NUM),
    ("MROUND", (6.05, 0.1), 6.0),
    ("MROUND", (7.05, 0.1), 7.1),
    ("MROUND", (5, 0), 0),
    ("MROUND", (0, -3), 0),
    ("EVEN", (1.5,), 2),
    ("EVEN", (3,), 4),
    ("EVEN", (2,), 2),
    ("EVEN", (-1,), -2),
    ("EVEN", (0,), 0),
    ("ODD", (1.5,), 3),
    ("ODD", (3,), 3),
    ("ODD", (2,), 3),
    ("ODD", (-1,), -1),
    ("ODD", (-2,), -3),
    ("ODD", (0,), 1),
    ("ODD", (-0.0,), 1),
    ("ODD", (NA,), NA),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), DIGITS)
def test_table_of_digits(check, name, arguments, expected):
    check(name, arguments, expected)


@pytest.mark.parametrize(("name", "arguments", "expected"), MULTIPLES)
def test_table_of_multiples(check, name, arguments, expected):
    check(name, arguments, expected, rel=3e-16)  # n times the multiple is rounded once


@pytest.mark.parametrize("name", ["ROUND", "ROUNDUP", "ROUNDDOWN", "TRUNC", "CEILING", "EVEN", "INT"])
def test_zero_has_no_sign(evaluate, name):
    arguments = (-0.0,) if name in ("EVEN", "INT") else (-0.0, 1.0)
    assert math.copysign(1, evaluate(name, *arguments)) == 1


SEEN = Context(prec=15, rounding=ROUND_HALF_UP)
MODES = {"ROUND": ROUND_HALF_UP, "ROUNDUP": ROUND_UP, "ROUNDDOWN": ROUND_DOWN, "TRUNC": ROUND_DOWN}

few_digits = st.builds(lambda n, e: float(f"{n}e{e}"), st.integers(-(10**9), 10**9), st.integers(-12, 6))
nearly = st.builds(
    lambda x, steps: float(np.array(x).view(np.int64).__add__(steps).view(np.float64)) if x else 0.0,
    few_digits,
    st.integers(-60, 60),
)
numbers = few_digits | nearly | st.floats(-1e12, 1e12).filter(lambda x: x == 0 or abs(x) > 1e-12)


def _as_excel_sees(x: float) -> Decimal:
    return SEEN.plus(Decimal(x))


@given(numbers, st.integers(-8, 22))
@settings(max_examples=300, deadline=None)
@example(2.675, 2)
@example(1.005, 2)
@example(-0.000125, 5)
@example(1.25e-10, 11)
@example(999999999999999.0, -14)
@example(0.09999999999999995, 1)  # the double nearest to 0.1 is farther away than half a unit of the 15th digit
@example(-0.09999999999999995, 1)
@pytest.mark.parametrize("name", MODES)
def test_rounds_the_fifteen_digits_that_excel_shows(name, x, digits):
    seen = _as_excel_sees(x)
    assume(seen.adjusted() + digits < 14)
    expected = float(seen.quantize(Decimal(1).scaleb(-digits), MODES[name], Context(prec=400)))
    assert function_named(name).body(np.array([x]), np.array([float(digits)]))[0] == expected


@given(numbers)
@settings(max_examples=300, deadline=None)
def test_int_goes_down_from_the_fifteen_digits_that_excel_shows(x):
    seen = _as_excel_sees(x)
    assume(seen.adjusted() < 14)
    expected = float(seen.to_integral_value(ROUND_FLOOR))
    assert function_named("INT").body(np.array([x]))[0] == expected


@given(numbers, st.sampled_from([0.1, 0.2, 0.25, 0.3, 0.7, 1.0, 2.0, 3.0, 5.0, 0.01, 0.05]))
@settings(max_examples=300, deadline=None)
@pytest.mark.parametrize(("name", "mode"), [("FLOOR", ROUND_FLOOR), ("CEILING", ROUND_CEILING)])
def test_multiples_are_those_of_the_quotient_that_excel_shows(name, mode, x, multiple):
    whole = _as_excel_sees(x / multiple).to_integral_value(mode)
    assume(abs(whole) < 10**14)
    assert function_named(name).body(np.array([x]), np.array([multiple]))[0] == float(whole) * multiple


@given(numbers.filter(lambda x: abs(x) < 1e6), st.integers(0, 4))
@settings(max_examples=200, deadline=None)
@pytest.mark.parametrize("name", ["ROUND", "ROUNDUP", "ROUNDDOWN"])
def test_rounding_twice_is_rounding_once(name, x, digits):
    body = function_named(name).body
    once = body(np.array([x]), np.array([float(digits)]))
    assert body(once, np.array([float(digits)])) == once


VALUE_OF_PRECISE_ROUNDING = ErrorCode.VALUE

TABLE = [
    ("CEILING.PRECISE", (4.3,), 5),
    ("CEILING.PRECISE", (-4.3,), -4),
    ("CEILING.PRECISE", (4.3, 2), 6),
    ("CEILING.PRECISE", (4.3, -2), 6),
    ("CEILING.PRECISE", (-4.3, 2), -4),
    ("CEILING.PRECISE", (-4.3, -2), -4),
    ("CEILING.PRECISE", (23.5, 0), 0),
    ("CEILING.PRECISE", (-23.5,), -23),
    ("CEILING.PRECISE", (7.1, 0.1), 7.1),
    ("CEILING.PRECISE", ("x",), VALUE_OF_PRECISE_ROUNDING),
    ("FLOOR.PRECISE", (-3.2, -1), -4),
    ("FLOOR.PRECISE", (3.2, 1), 3),
    ("FLOOR.PRECISE", (-3.2, 1), -4),
    ("FLOOR.PRECISE", (3.2, -1), 3),
    ("FLOOR.PRECISE", (3.2,), 3),
    ("FLOOR.PRECISE", (3.2, 0), 0),
    ("FLOOR.PRECISE", (7.1, 0.1), 7.1),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-15)


@pytest.mark.parametrize("alias", ["ISO.CEILING", "ECMA.CEILING"])
def test_other_names(alias):
    assert function_named(alias) is function_named("CEILING.PRECISE")
