from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value, from_objects

DIV0, NUM, VALUE, NA = ErrorCode.DIV0, ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

ARITHMETIC = [
    ("+", (1, 2), 3),
    ("+", ("1", True), 2),
    ("+", (None, 2), 2),
    ("+", ("", 2), VALUE),
    ("+", (1e308, 1e308), NUM),
    ("+", (NA, DIV0), NA),
    ("+", ("x", DIV0), VALUE),
    ("-", (1, "2.5"), -1.5),
    ("*", (3, True), 3),
    ("*", (1e200, -1e200), NUM),
    ("/", (1, 4), 0.25),
    ("/", (1, 0), DIV0),
    ("/", (0, None), DIV0),
    ("/", (1, False), DIV0),
    ("/", (1e300, 1e-300), NUM),
    ("^", (2, 10), 1024),
    ("^", (-2, 2), 4),
    ("^", (-2, 3), -8),
    ("^", (4, 0.5), 2),
    ("^", (-4, 0.5), NUM),
    ("^", (0, 0), NUM),
    ("^", (None, None), NUM),
    ("^", (0, -2), DIV0),
    ("^", (0, 2), 0),
    ("^", (10, 400), NUM),
    ("^", (5, 0), 1),
    ("%", (50,), 0.5),
    ("%", ("7",), 0.07),
    ("u-", (5,), -5),
    ("u-", ("5",), -5),
    ("u-", ("x",), VALUE),
    ("u-", (NA,), NA),
    ("u+", ("x",), "x"),
    ("u+", (True,), True),
    ("u+", (NA,), NA),
]

JOINED = [
    ("&", ("a", "b"), "ab"),
    ("&", (1, 2), "12"),
    ("&", (0.1 + 0.2, " m"), "0.3 m"),
    ("&", (True, None), "TRUE"),
    ("&", ("", None), ""),
    ("&", ("a", NA), NA),
    ("&", (DIV0, NA), DIV0),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), ARITHMETIC + JOINED)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected)


RISING = [-1e300, -1.0, 0.0, 0.5, 2.0, "", "2", "A", "b", "Beta", "C", False, True]
"""Excel's order: numbers, then texts without case, then logicals."""

RELATIONS = {
    "=": lambda i, j: i == j,
    "<>": lambda i, j: i != j,
    "<": lambda i, j: i < j,
    "<=": lambda i, j: i <= j,
    ">": lambda i, j: i > j,
    ">=": lambda i, j: i >= j,
}


@pytest.mark.parametrize("symbol", RELATIONS)
def test_order_of_everything(evaluate, symbol):
    for i, x in enumerate(RISING):
        for j, y in enumerate(RISING):
            assert evaluate(symbol, x, y) is RELATIONS[symbol](i, j), f"{x!r} {symbol} {y!r}"


@pytest.mark.parametrize("symbol", RELATIONS)
def test_order_of_everything_over_trials(symbol):
    left = from_objects(np.array([x for x in RISING for _ in RISING], object))
    right = from_objects(np.array([y for _ in RISING for y in RISING], object))
    places = range(len(RISING))
    expected = [RELATIONS[symbol](i, j) for i in places for j in places]
    assert function_named(symbol)([left, right]).objects().tolist() == expected


@pytest.mark.parametrize(
    ("x", "symbol", "y", "expected"),
    [
        ("abc", "=", "ABC", True),
        ("abc", "<", "ABD", True),
        ("straße", "=", "STRASSE", True),
        (None, "=", 0, True),
        (None, "=", "", True),
        (None, "=", False, True),
        (None, "=", None, True),
        (None, "<", 1, True),
        (None, "<", "a", True),
        (None, "<", True, True),
        (None, ">", -1, True),
        ("1", "=", 1, False),
        (True, "=", 1, False),
        (1e300, "<", "", True),
        ("zzz", "<", False, True),
        (NA, "=", 1, NA),
        (1, "=", NA, NA),
        (DIV0, "<", NA, DIV0),
        ("a", ">", NA, NA),
        (NA, "=", NA, NA),
    ],
)
def test_comparisons(evaluate, x, symbol, y, expected):
    assert evaluate(symbol, x, y) is expected


def test_comparison_of_trials_with_a_range():
    trials = Value.of_numbers(np.array([1.0, 3.0]))
    cells = from_objects(np.array([[[1.0, 2.0, 3.0]]], object))
    assert function_named("<")([trials, cells]).objects().tolist() == [[[False, True, True]], [[False, False, False]]]


def test_arithmetic_of_trials_with_a_range():
    trials = Value.of_numbers(np.array([1.0, 3.0]))
    cells = from_objects(np.array([[[1.0, None], ["2", "x"]]], object))
    expected = [[[2.0, 1.0], [3.0, VALUE]], [[4.0, 3.0], [5.0, VALUE]]]
    assert function_named("+")([trials, cells]).objects().tolist() == expected


@pytest.mark.parametrize(
    ("x", "y", "holds"),
    [([1.0, 2.0], [0.0, 1.0], True), ([0.0, 2.0], [1.0, 1.0], True), ([0.0, 2.0], [0.0, 1.0], False)],
)
def test_guard_of_the_power_turns_zero_to_zero_away(x, y, holds):
    assert function_named("^").guard(np.array(x), np.array(y)) is holds
