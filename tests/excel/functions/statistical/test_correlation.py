from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from xlmc.errors import ErrorCode

NUM, VALUE, NA, DIV0 = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA, ErrorCode.DIV0

Y, X = [[2], [3], [9], [1], [8], [7], [5]], [[6], [5], [11], [7], [5], [4], [4]]

HELP = [
    ("CORREL", ([[3, 2, 4, 5, 6]], [[9, 7, 12, 15, 17]]), "0.997054486"),
    ("PEARSON", ([[9, 7, 5, 3, 1]], [[10, 6, 1, 5, 3]]), "0.699379"),
    ("RSQ", (Y, X), "0.05795"),
    ("SLOPE", (Y, X), "0.305556"),
    ("INTERCEPT", ([[2, 3, 9, 1, 8]], [[6, 5, 11, 7, 5]]), "0.0483871"),
    ("STEYX", (Y, X), "3.305719"),
    ("COVARIANCE.P", ([[3, 2, 4, 5, 6]], [[9, 7, 12, 15, 17]]), "5.2"),
    ("COVAR", ([[3, 2, 4, 5, 6]], [[9, 7, 12, 15, 17]]), "5.2"),
    ("COVARIANCE.S", ([[2, 4, 8]], [[5, 11, 12]]), "9.666666667"),
    ("FORECAST.LINEAR", (30, [[6, 7, 9, 15, 21]], [[20, 28, 31, 38, 40]]), "10.607253"),
    ("FORECAST", (30, [[6, 7, 9, 15, 21]], [[20, 28, 31, 38, 40]]), "10.607253"),
]


@pytest.mark.parametrize(("name", "arguments", "printed"), HELP)
def test_examples_of_excels_help(shows, name, arguments, printed):
    shows(name, arguments, printed)


PAIRED = ["CORREL", "RSQ", "SLOPE", "INTERCEPT", "STEYX", "COVARIANCE.P", "COVARIANCE.S"]


@pytest.mark.parametrize("name", PAIRED)
def test_only_pairs_of_numbers_count(evaluate, name):
    ys, xs = [[1, "2", 4, True, 5, None]], [[2, 50, 3, 60, 7, 70]]
    assert evaluate(name, ys, xs) == evaluate(name, [[1, 4, 5]], [[2, 3, 7]])


@pytest.mark.parametrize("name", PAIRED)
def test_errors(check, name):
    check(name, ([[1, 2]], [[1, 2, 3]]), NA)
    check(name, ([[1, DIV0]], [[NA, 2]]), DIV0)
    check(name, ([[1, 2]], [[NA, 2]]), NA)
    check(name, ("x", 1), VALUE)
    check(name, ([["x", None]], [[1, 2]]), DIV0)


TABLE = [
    ("CORREL", ([[1, 2, 3]], [[1], [2], [3]]), 1),
    ("CORREL", ([[1, 2]], [[0.1, 0.1]]), DIV0),
    ("CORREL", (42, 43), DIV0),
    ("RSQ", ([[0.1, 0.1, 0.1]], [[1, 2, 3]]), DIV0),
    ("SLOPE", ([[0.1, 0.1, 0.1]], [[1, 2, 3]]), 0),
    ("SLOPE", ([[1, 2, 3]], [[0.1, 0.1, 0.1]]), DIV0),
    ("INTERCEPT", ([[1, 2, 3]], [[0.1, 0.1, 0.1]]), DIV0),
    ("STEYX", ([[1, 2]], [[1, 2]]), DIV0),
    ("STEYX", ([[1, 2, 3]], [[2, 4, 6]]), 0),
    ("COVARIANCE.P", (42, 43), 0),
    ("COVARIANCE.S", (42, 43), DIV0),
    ("FORECAST", (3, [[1, 2]], [[1, 2]]), 3),
    ("FORECAST", ("3", [[1, 2]], [[1, 2]]), 3),
    ("FORECAST", ([[3], [4]], [[1, 2]], [[1, 2]]), [[3.0], [4.0]]),
    ("FORECAST", (3, [[1, 2]], [[1, 1]]), DIV0),
    ("FORECAST", (3, [[1, 2]], [[1]]), NA),
    ("FORECAST", ("x", [[1, NA]], [[1, 2]]), VALUE),
    ("FORECAST", (3, [[1, NA]], [[1, 2]]), NA),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-15)


columns = st.integers(3, 20).flatmap(lambda k: st.lists(st.tuples(*[st.integers(-99, 99)] * 2), min_size=k, max_size=k))


@given(columns.filter(lambda pairs: min(len(set(side)) for side in zip(*pairs, strict=True)) > 1))
@settings(max_examples=100, deadline=None)
def test_the_line_is_scipys(evaluate, pairs):
    x, y = ([list(side)] for side in zip(*pairs, strict=True))
    line = stats.linregress(x[0], y[0])
    covariance = np.cov(x[0], y[0])[0, 1]
    expected = {"SLOPE": line.slope, "INTERCEPT": line.intercept, "CORREL": line.rvalue, "RSQ": line.rvalue**2}
    for name, value in expected.items():
        assert evaluate(name, y, x) == pytest.approx(float(value), rel=1e-9, abs=1e-9)
    assert evaluate("COVARIANCE.S", x, y) == pytest.approx(covariance, rel=1e-12, abs=1e-12)
    assert evaluate("FORECAST", 7, y, x) == pytest.approx(line.intercept + 7 * line.slope, rel=1e-9, abs=1e-9)
    off = np.array(y[0]) - line.intercept - line.slope * np.array(x[0])
    assert evaluate("STEYX", y, x) == pytest.approx(np.sqrt((off @ off) / (len(off) - 2)), rel=1e-6, abs=1e-6)
