from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import ShapeVaries, Value

NUM, VALUE, NA, DIV0 = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA, ErrorCode.DIV0

MIXED = [[3, "2", True], [None, 2, 2]]
"""3, 2 and 2; text, logical and blank cells beside them."""
SCORES = [[79], [85], [78], [85], [50], [81], [95], [88], [97]]
XS, PS = [[0], [1], [2], [3]], [[0.2], [0.3], [0.1], [0.4]]

TABLE = [
    ("MODE.SNGL", ([[5.6, 4, 4, 3, 2, 4]],), 4),
    ("MODE", ([[5.6, 4, 4, 3, 2, 4]],), 4),
    ("MODE", (MIXED,), 2),
    ("MODE", ([[9, 7], [7, 9]], 1), 9),
    ("MODE", (7, 9, [[9, 7]]), 7),
    ("MODE", ([[3, 2, 1]],), NA),
    ("MODE", ([["x", None]],), NA),
    ("MODE", ([[0.0, -0.0]],), 0),
    ("MODE", (1, 1, "1", DIV0), VALUE),  # Excel takes texts, logicals and blanks in ranges of several cells only
    ("MODE", (2, 2, [[None]]), VALUE),
    ("MODE", (2, 2, [["x"]]), VALUE),
    ("MODE", (2, 2, True), VALUE),
    ("MODE", (2, DIV0, "x"), DIV0),
    ("MODE", ([[2, NA, 2]],), NA),
    ("MODE.MULT", ([[1, 2, 3, 4, 3, 2, 1, 2, 3, 5, 6, 1]],), [[1.0], [2.0], [3.0]]),
    ("MODE.MULT", ([[3, 2, 3, 2, 1]],), [[3.0], [2.0]]),
    ("MODE.MULT", (MIXED,), [[2.0]]),
    ("MODE.MULT", ([[3, 2, 1]],), [[NA]]),
    ("MODE.MULT", ([[3, 3, DIV0]],), [[DIV0]]),
    ("FREQUENCY", (SCORES, [[70], [79], [89]]), [[1.0], [2.0], [4.0], [2.0]]),
    ("FREQUENCY", (SCORES, [[89, 70, 79]]), [[4.0], [1.0], [2.0], [2.0]]),
    ("FREQUENCY", ([[1, 2, 2, 3]], [[2, 2, 1]]), [[2.0], [0.0], [1.0], [1.0]]),
    ("FREQUENCY", (MIXED, [["x", None, 2]]), [[2.0], [1.0]]),
    ("FREQUENCY", (MIXED, [["x"]]), [[3.0]]),
    ("FREQUENCY", ([["x"]], [[1]]), [[0.0], [0.0]]),
    ("FREQUENCY", (5, 5), [[1.0], [0.0]]),
    ("FREQUENCY", ([[1, NA]], [[DIV0, 2]]), [[NA], [NA], [NA]]),
    ("PROB", (XS, PS, 2), 0.1),
    ("PROB", (XS, PS, 1, 3), 0.8),
    ("PROB", (XS, PS, 1.5), 0),
    ("PROB", (XS, PS, 3, 1), 0),
    ("PROB", (XS, PS, [[0], [2]]), [[0.2], [0.1]]),
    ("PROB", ([[0, 1, 2]], [[0.5, 0.5, "x"]], 0, 2), 1),
    ("PROB", (XS, [[0.2], [0.3], [0.1], [0.3]], 2), NUM),
    ("PROB", (XS, [[0.6], [0.3], [0.1], [0]], 2), NUM),
    ("PROB", (XS, [[1.2], [0.3], [0.1], [-0.6]], 2), NUM),
    ("PROB", (XS, [[0.6], [0.4]], 2), NA),
    ("PROB", ([[1, DIV0]], [[NA, 1]], 2), DIV0),
    ("PROB", (XS, PS, "x"), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-15)


@given(st.lists(st.integers(0, 6), min_size=1, max_size=25))
@settings(max_examples=150, deadline=None)
def test_modes_are_those_of_a_counter(evaluate, x):
    counts = Counter(x)
    most = max(counts.values())
    expected = [[float(value)] for value in counts if counts[value] == most] if most > 1 else [[NA]]
    assert evaluate("MODE.MULT", [x]) == expected
    assert evaluate("MODE.SNGL", [x]) == expected[0][0]


@given(st.lists(st.integers(0, 20), min_size=1, max_size=25), st.lists(st.integers(0, 20), min_size=1, max_size=6))
@settings(max_examples=150, deadline=None)
def test_every_number_falls_into_the_lowest_bin_it_fits(evaluate, x, bins):
    expected = [0.0] * (len(bins) + 1)
    for value in x:
        fitting = sorted((limit, place) for place, limit in enumerate(bins) if value <= limit)
        expected[fitting[0][1] if fitting else -1] += 1
    assert evaluate("FREQUENCY", [x], [bins]) == [[count] for count in expected]


def test_as_many_modes_as_differ_between_trials_are_asked_for_trial_by_trial():
    trials = Value.of_numbers(np.array([[[1.0, 1, 2, 2]], [[1, 1, 1, 2]]]))
    with pytest.raises(ShapeVaries):
        function_named("MODE.MULT")([trials])
