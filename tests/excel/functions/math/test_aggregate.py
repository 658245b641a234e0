from __future__ import annotations

import statistics

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value, from_objects

DIV0, NUM, VALUE, NA = ErrorCode.DIV0, ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

MIXED = [[1, "2", True], [None, 4, ""]]
"""Two numbers; text, logical and blank cells beside them."""
NONE = [["x", None, True]]
BREAKING = [[1345, 1301, 1368, 1322, 1310, 1370, 1318, 1350, 1303, 1299]]  # the example in Excel's own help

TABLE = [
    ("SUM", (3, 2), 5),
    ("SUM", ("5", 15, True), 21),
    ("SUM", (MIXED, 10), 15),
    ("SUM", (NONE,), 0),
    ("SUM", (None,), 0),
    ("SUM", ("x", 1), VALUE),
    ("SUM", ([[1, NA]], [[DIV0]]), NA),
    ("SUM", ([[1, 2]], DIV0, NA), DIV0),
    ("SUM", (1e308, 1e308), NUM),
    ("PRODUCT", (5, 15, 30), 2250),
    ("PRODUCT", (MIXED, "2"), 8),
    ("PRODUCT", (NONE,), 0),
    ("PRODUCT", (None, 5), 0),
    ("PRODUCT", ([[2, DIV0]],), DIV0),
    ("AVERAGE", ([[10, 7, 9, 27, 2]], 5), 10),
    ("AVERAGE", (MIXED,), 2.5),
    ("AVERAGE", (MIXED, True), 2),
    ("AVERAGE", (1, None), 0.5),
    ("AVERAGE", (NONE,), DIV0),
    ("AVERAGE", ("x",), VALUE),
    ("AVERAGE", (NONE, NA), NA),
    ("MIN", ([[10, 7, 9, 27, 2]], 0), 0),
    ("MIN", (MIXED,), 1),
    ("MIN", (MIXED, False), 0),
    ("MIN", ([[-5, None]],), -5),
    ("MIN", ([[5, None]],), 5),
    ("MIN", (NONE,), 0),
    ("MIN", ("x", 1), VALUE),
    ("MAX", ([[10, 7, 9, 27, 2]], 30), 30),
    ("MAX", (MIXED, "3"), 4),
    ("MAX", ([[-5, None, True]],), -5),
    ("MAX", (NONE,), 0),
    ("MAX", ([[1, NA]],), NA),
    ("COUNT", (MIXED,), 2),
    ("COUNT", (MIXED, "7", "x", True, None, DIV0), 5),
    ("COUNT", ([[1, DIV0, NA]],), 1),
    ("COUNT", (NONE,), 0),
    ("COUNTA", (MIXED,), 5),
    ("COUNTA", (2, "A", "", NA, None, [[DIV0, None]]), 6),
    ("COUNTA", ([[None]],), 0),
    ("COUNTBLANK", (MIXED,), 2),
    ("COUNTBLANK", ([[DIV0, 0, False]],), 0),
    ("COUNTBLANK", ([[None, None]],), 2),
    ("MEDIAN", ([[1, 2, 3, 4, 5]],), 3),
    ("MEDIAN", ([[1, 2, 3, 4, 5, 6]],), 3.5),
    ("MEDIAN", (MIXED,), 2.5),
    ("MEDIAN", ("2", True), 1.5),
    ("MEDIAN", (NONE,), NUM),
    ("MEDIAN", (NONE, NA), NA),
    ("VAR.S", ([[1, 2, 3, 4]],), 5 / 3),
    ("VAR.S", ([[1e9 + 1, 1e9 + 2, 1e9 + 3]],), 1),
    ("VAR.S", (MIXED,), 4.5),
    ("VAR.S", (7,), DIV0),
    ("VAR.S", (NONE,), DIV0),
    ("VAR.P", ([[1, 2, 3, 4]],), 1.25),
    ("VAR.P", (7,), 0),
    ("VAR.P", (NONE,), DIV0),
    ("STDEV.S", ([[2, 4, 4, 4, 5, 5, 7, 9]],), (32 / 7) ** 0.5),
    ("STDEV.S", (7, "x"), VALUE),
    ("STDEV.S", (7,), DIV0),
    ("STDEV.P", ([[2, 4, 4, 4, 5, 5, 7, 9]],), 2),
    ("STDEV.P", (NONE,), DIV0),
    ("STDEV", ([[2, 4]],), 2**0.5),
    ("STDEVP", ([[2, 4]],), 1),
    ("VAR", ([[2, 4]],), 2),
    ("VARP", ([[2, 4]],), 1),
    ("LARGE", ([[3, 4], [5, 2], [3, 4], [5, 6], [4, 7]], 3), 5),
    ("LARGE", ([[3, 4], [5, 2], [3, 4], [5, 6], [4, 7]], 7), 4),
    ("LARGE", (MIXED, 1), 4),
    ("LARGE", (MIXED, 2), 1),
    ("LARGE", (MIXED, 3), NUM),
    ("LARGE", (MIXED, 0), NUM),
    ("LARGE", (MIXED, 1.5), 1),
    ("LARGE", (NONE, 1), NUM),
    ("LARGE", (True, 1), 1),
    ("LARGE", ("2.3", "1"), 2.3),
    ("LARGE", ("x", 1), VALUE),
    ("LARGE", ([[1, NA]], DIV0), NA),
    ("LARGE", ([[1, 2]], DIV0), DIV0),
    ("SMALL", ([[3, 4, 5, 2, 3, 4, 6, 4, 7]], 4), 4),
    ("SMALL", ([[1, 4, 8, 3, 7, 12, 54, 8, 23]], 2), 3),
    ("SMALL", (MIXED, 1.9), 1),
    ("SMALL", (MIXED, 3), NUM),
    ("SMALL", (MIXED, "x"), VALUE),
    ("SUMPRODUCT", ([[3, 4], [8, 6], [1, 9]], [[2, 7], [6, 7], [5, 3]]), 156),
    ("SUMPRODUCT", (MIXED,), 5),
    ("SUMPRODUCT", (MIXED, [[10, 10, 10], [10, 10, 10]]), 50),
    ("SUMPRODUCT", (3, 4), 12),
    ("SUMPRODUCT", (3, [[4]]), 12),
    ("SUMPRODUCT", (2, [[1, 2]]), VALUE),
    ("SUMPRODUCT", ([[1], [2]], [[1, 2]]), VALUE),
    ("SUMPRODUCT", ([["4"]], [[2]]), VALUE),
    ("SUMPRODUCT", ([[None]], [[2]]), 0),
    ("SUMPRODUCT", ([[1, NA]], [[DIV0, 1]]), NA),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=3e-16)


def test_ranks_may_be_a_range(evaluate):
    assert evaluate("LARGE", [[1, 5, 3]], [[1, 3, 4]]) == [[5.0, 1.0, NUM]]


@pytest.mark.parametrize(
    ("name", "expected"),
    [("STDEV.S", 27.46391571984), ("STDEV.P", 26.05455814), ("VAR.S", 754.26666667), ("VAR.P", 678.84)],
)
def test_examples_of_excels_help(check, name, expected):
    check(name, (BREAKING,), expected, rel=1e-9)


numbers = st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=12)


@given(numbers)
@settings(max_examples=100, deadline=None)
@pytest.mark.parametrize(
    ("name", "reference", "power"),
    [
        ("VAR.S", statistics.variance, 2),
        ("VAR.P", statistics.pvariance, 2),
        ("AVERAGE", statistics.fmean, 1),
        ("MEDIAN", statistics.median, 1),
    ],
)
def test_agrees_with_exact_fractions(name, reference, power, x):
    scale = max(abs(value) for value in x) ** power
    result = function_named(name).body(np.array([x]), np.ones((1, len(x)), bool))[0]
    assert result == pytest.approx(reference(x), rel=1e-12, abs=1e-13 * scale)


# Excel has no numbers below 2.2e-308: it makes them 0.
@given(st.lists(st.floats(-1e6, 1e6, allow_subnormal=False), min_size=2, max_size=12), st.integers(1, 12))
@settings(max_examples=100, deadline=None)
def test_ranks_are_those_of_the_sorted_numbers(evaluate, x, rank):
    rank = min(rank, len(x))
    assert evaluate("SMALL", [x], rank) == sorted(x)[rank - 1]
    assert evaluate("LARGE", [x], rank) == sorted(x)[-rank]


def test_trials_have_counts_of_their_own():
    cells = np.empty((3, 1, 2), object)
    cells[:, 0, 0] = [1.0, "x", NA]
    cells[:, 0, 1] = [3.0, 5.0, 7.0]
    trials = from_objects(cells)
    results = {name: function_named(name)([trials]).objects().tolist() for name in ("SUM", "AVERAGE", "COUNT", "VAR.S")}
    assert results == {
        "SUM": [4.0, 5.0, NA],
        "AVERAGE": [2.0, 5.0, NA],
        "COUNT": [2.0, 1.0, 1.0],
        "VAR.S": [2.0, DIV0, NA],
    }


def test_constants_beside_trials_count_in_each():
    trials = Value.of_numbers(np.array([1.0, 2.0]))
    tenth = from_objects(np.full((1, 1, 1), 10.0, object))
    assert function_named("SUM")([trials, tenth]).objects().tolist() == [11.0, 12.0]
    assert function_named("SUMPRODUCT")([trials, tenth]).objects().tolist() == [10.0, 20.0]
    assert function_named("COUNTA")([trials, tenth]).objects().tolist() == [2.0, 2.0]
    assert function_named("LARGE")([tenth, trials]).objects().tolist() == [10.0, NUM]
