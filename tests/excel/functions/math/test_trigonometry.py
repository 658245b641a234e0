from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.math.trigonometry import Within

DIV0, NUM, VALUE, NA = ErrorCode.DIV0, ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA
BIG = 2.0**27
ULPS = 1e-15  # NumPy's vector functions are within 4 units in the last place

CLOSED_FORMS = [
    ("SIN", (math.pi / 6,), 0.5),
    ("COS", (math.pi / 3,), 0.5),
    ("TAN", (math.pi / 4,), 1.0),
    ("SEC", (math.pi / 3,), 2.0),
    ("CSC", (math.pi / 6,), 2.0),
    ("COT", (math.pi / 4,), 1.0),
    ("ASIN", (1,), math.pi / 2),
    ("ACOS", (-1,), math.pi),
    ("ACOS", (-0.5,), 2 * math.pi / 3),
    ("ATAN", (1,), math.pi / 4),
    ("SINH", (0,), 0.0),
    ("COSH", (0,), 1.0),
    ("TANH", (40,), 1.0),
    ("ASINH", (math.sinh(1.5),), 1.5),
    ("ACOSH", (math.cosh(1.5),), 1.5),
    ("ATANH", (0.5,), math.log(3) / 2),
    ("ATAN2", (1, 1), math.pi / 4),
    ("ATAN2", (0, 1), math.pi / 2),
    ("ATAN2", (1, 0), 0.0),
    ("ATAN2", (-1, -1), -3 * math.pi / 4),
    ("ATAN2", (-1, 0), math.pi),
    ("ATAN2", (-1, -0.0), math.pi),
    ("RADIANS", (270,), 1.5 * math.pi),
    ("DEGREES", (math.pi,), 180.0),
    ("PI", (), math.pi),
]

ERRORS = [
    ("ASIN", (1.0000001,), NUM),
    ("ACOS", (-1.0000001,), NUM),
    ("ACOSH", (0.9999999,), NUM),
    ("ATANH", (1,), NUM),
    ("ATANH", (-1,), NUM),
    ("ATANH", (1.5,), NUM),
    ("SINH", (711,), NUM),
    ("COSH", (-711,), NUM),
    ("ATAN2", (0, 0), DIV0),
    ("CSC", (0,), DIV0),
    ("COT", (0,), DIV0),
    *[(name, (x,), NUM) for name in ("SIN", "COS", "TAN", "SEC", "CSC", "COT") for x in (BIG, -BIG, 1e300)],
]

COERCED = [
    ("SIN", ("0",), 0.0),
    ("SIN", (" 90% ",), math.sin(0.9)),
    ("COS", (None,), 1.0),
    ("TAN", (True,), math.tan(1)),
    ("SIN", ("abc",), VALUE),
    ("SIN", ("",), VALUE),
    ("COS", (NA,), NA),
    ("ATAN2", (NA, DIV0), NA),
    ("ATAN2", ("abc", DIV0), VALUE),
    ("ATAN2", (1, DIV0), DIV0),
    ("CSC", (False,), DIV0),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), CLOSED_FORMS + ERRORS + COERCED)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=ULPS)


REFERENCE = {
    "SIN": math.sin,
    "COS": math.cos,
    "TAN": math.tan,
    "SEC": lambda x: 1 / math.cos(x),
    "CSC": lambda x: 1 / math.sin(x),
    "COT": lambda x: 1 / math.tan(x),
    "ATAN": math.atan,
    "SINH": math.sinh,
    "COSH": math.cosh,
    "TANH": math.tanh,
    "ASINH": math.asinh,
    "RADIANS": math.radians,
    "DEGREES": math.degrees,
}


@pytest.mark.parametrize("name", REFERENCE)
@pytest.mark.parametrize("x", [-100.0, -2.5, -0.1, 1e-9, 0.3, 1.5707, 2.0, 30.0, 700.0])
def test_agrees_with_the_c_library(check, name, x):
    check(name, (x,), REFERENCE[name](x), rel=ULPS)


@pytest.mark.parametrize("name", ["ASIN", "ACOS", "ATANH"])
@pytest.mark.parametrize("x", [-0.99, -0.5, 1e-9, 0.1, 0.75])
def test_agrees_with_the_c_library_within_one(check, name, x):
    reference = {"ASIN": math.asin, "ACOS": math.acos, "ATANH": math.atanh}[name]
    check(name, (x,), reference(x), rel=ULPS)


@pytest.mark.parametrize("name", ["SIN", "COS", "TAN", "SEC", "CSC", "COT"])
def test_angles_just_below_the_limit_are_computed(check, name):
    x = float(np.nextafter(BIG, 0))
    check(name, (x,), REFERENCE[name](x), rel=ULPS)


@pytest.mark.parametrize("name", ["SIN", "COS", "TAN"])
def test_guard_turns_large_and_unknown_angles_away(name):
    guard = function_named(name).guard
    assert guard(np.array([-1e8, 1e8]))
    assert guard(np.empty(0))
    assert not guard(np.array([1.0, BIG]))
    assert not guard(np.array([1.0, -BIG]))
    assert not guard(np.array([1.0, np.nan]))


def test_a_range_gives_a_range(evaluate):
    assert evaluate("ATAN2", [[1, 0], ["x", None]], 0) == [[0.0, DIV0], [VALUE, DIV0]]


DIV0_OF_RECIPROCAL_TRIGONOMETRY, NUM_OF_RECIPROCAL_TRIGONOMETRY, VALUE_OF_RECIPROCAL_TRIGONOMETRY = (
    ErrorCode.DIV0,
    ErrorCode.NUM,
    ErrorCode.VALUE,
)

TABLE = [
    ("ACOT", (2,), math.atan(0.5)),
    ("ACOT", (0,), math.pi / 2),
    ("ACOT", (-1,), 3 * math.pi / 4),
    ("ACOT", (1e9,), 1e-9),
    ("ACOT", (-1e300,), math.pi),
    ("ACOT", ("x",), VALUE_OF_RECIPROCAL_TRIGONOMETRY),
    ("ACOTH", (6,), math.log(7 / 5) / 2),
    ("ACOTH", (-2,), -math.log(3) / 2),
    ("ACOTH", (1e100,), 1e-100),
    ("ACOTH", (1,), NUM_OF_RECIPROCAL_TRIGONOMETRY),
    ("ACOTH", (-0.5,), NUM_OF_RECIPROCAL_TRIGONOMETRY),
    ("ACOTH", (None,), NUM_OF_RECIPROCAL_TRIGONOMETRY),
    ("COTH", (2,), math.cosh(2) / math.sinh(2)),
    ("COTH", (-1e-10,), -1e10),
    ("COTH", (1000,), 1),
    ("COTH", (0,), DIV0_OF_RECIPROCAL_TRIGONOMETRY),
    ("SECH", (0,), 1),
    ("SECH", (-3,), 1 / math.cosh(3)),
    ("SECH", (1e100,), 0),
    ("SECH", (709,), 1 / math.cosh(709)),
    ("CSCH", (1.5,), 1 / math.sinh(1.5)),
    ("CSCH", (-1e-9,), -1e9),
    ("CSCH", (0,), DIV0_OF_RECIPROCAL_TRIGONOMETRY),
    ("CSCH", (-800,), 0),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table_reciprocal_trigonometry(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-14)


def test_examples_of_excels_help(evaluate):
    assert evaluate("ACOT", 2) == pytest.approx(0.4636, abs=5e-5)
    assert evaluate("ACOTH", 6) == pytest.approx(0.168, abs=5e-4)
    assert evaluate("COTH", 2) == pytest.approx(1.0373, abs=5e-5)
    assert evaluate("CSCH", 1.5) == pytest.approx(0.4696, abs=5e-5)
    assert evaluate("SECH", 45) == pytest.approx(5.73e-20, rel=1e-3)


@pytest.mark.parametrize(
    ("low", "high", "kept"),
    [
        (-49.0, 49.0, True),
        (0.0, 49.0, True),
        (0.0, 50.0, False),
        (-50.0, 0.0, False),
        (-51.0, -1.0, False),
        (1.0, 51.0, False),
        (-np.inf, 1.0, False),
        (-1.0, np.inf, False),
        (np.nan, 1.0, False),
    ],
)
def test_numbers_are_surely_within_where_rounding_cannot_put_them_past_the_limit(low, high, kept):
    guard = Within(100.0)
    assert guard.surely(low, high) is kept
    assert guard(np.array([low, high])) or not kept
