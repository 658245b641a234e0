from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value

NUM, VALUE, NA, DIV0 = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA, ErrorCode.DIV0

MIXED = [[3, "2", True], [None, 1, 2]]
"""1, 2 and 3; text, logical and blank cells beside them."""
NONE = [["x", None, True]]
NINE = [[1, 2, 3, 6, 6, 6, 7, 8, 9]]
ELEVEN = [[6, 7, 15, 36, 39, 40, 41, 42, 43, 47, 49]]
TEN = [[13, 12, 11, 8, 4, 3, 2, 1, 1, 1]]
FIVE = [[7], [3.5], [3.5], [1], [2]]
HEIGHTS = [[89, 88, 92, 101, 94, 97, 95]]

HELP = [
    ("PERCENTILE.INC", ([[1, 3, 2, 4]], 0.3), 1.9),
    ("PERCENTILE", ([[1, 3, 2, 4]], 0.3), 1.9),
    ("PERCENTILE.EXC", (NINE, 0.25), 2.5),
    ("PERCENTILE.EXC", (NINE, 0), NUM),
    ("PERCENTILE.EXC", (NINE, 0.01), NUM),
    ("PERCENTILE.EXC", (NINE, 2), NUM),
    ("QUARTILE.INC", ([[1, 2, 4, 7, 8, 9, 10, 12]], 1), 3.5),
    ("QUARTILE", ([[1, 2, 4, 7, 8, 9, 10, 12]], 1), 3.5),
    ("QUARTILE.EXC", (ELEVEN, 1), 15),
    ("QUARTILE.EXC", (ELEVEN, 3), 43),
    ("PERCENTRANK.INC", (TEN, 2), 0.333),
    ("PERCENTRANK", (TEN, 4), 0.555),
    ("PERCENTRANK.INC", (TEN, 8), 0.666),
    ("PERCENTRANK.INC", (TEN, 5), 0.583),
    ("PERCENTRANK.EXC", (NINE, 7), 0.7),
    ("PERCENTRANK.EXC", (NINE, 5.43), 0.381),
    ("PERCENTRANK.EXC", (NINE, 5.43, 1), 0.3),
    ("RANK.EQ", (7, FIVE, 1), 5),
    ("RANK.EQ", (2, FIVE), 4),
    ("RANK", (3.5, FIVE, 1), 3),
    ("RANK.AVG", (94, HEIGHTS), 4),
]

TABLE = [
    ("PERCENTILE.INC", (MIXED, 0), 1),
    ("PERCENTILE.INC", (MIXED, 1), 3),
    ("PERCENTILE.INC", (MIXED, "50%"), 2),
    ("PERCENTILE.INC", (MIXED, 1.1), NUM),
    ("PERCENTILE.INC", (MIXED, -0.1), NUM),
    ("PERCENTILE.INC", (NONE, 0.5), NUM),
    ("PERCENTILE.INC", ("x", 0.5), VALUE),
    ("PERCENTILE.INC", (7, 0.5), 7),
    ("PERCENTILE.INC", ([[1, NA]], DIV0), NA),
    ("PERCENTILE.INC", ([[1, 2]], DIV0), DIV0),
    ("PERCENTILE.EXC", (MIXED, 0.25), 1),
    ("PERCENTILE.EXC", (MIXED, 0.75), 3),
    ("PERCENTILE.EXC", (MIXED, 0.76), NUM),
    ("PERCENTILE.EXC", (NONE, 0.5), NUM),
    ("QUARTILE.INC", (MIXED, 0), 1),
    ("QUARTILE.INC", (MIXED, 4.9), 3),
    ("QUARTILE.INC", (MIXED, 5), NUM),
    ("QUARTILE.INC", (MIXED, -1), NUM),
    ("QUARTILE.EXC", (MIXED, 2), 2),
    ("QUARTILE.EXC", (MIXED, 0), NUM),
    ("QUARTILE.EXC", (MIXED, 4), NUM),
    ("PERCENTRANK.INC", (MIXED, 1), 0),
    ("PERCENTRANK.INC", (MIXED, 3), 1),
    ("PERCENTRANK.INC", (MIXED, 4), NA),
    ("PERCENTRANK.INC", (MIXED, 0.9), NA),
    ("PERCENTRANK.INC", (MIXED, 2, 0), NUM),
    ("PERCENTRANK.INC", (MIXED, 2, None), NUM),
    ("PERCENTRANK.INC", (NONE, 2), NUM),
    ("PERCENTRANK.INC", ([[5]], 5), 1),
    ("PERCENTRANK.INC", ([[5]], 6), NA),
    ("PERCENTRANK.INC", ([[*range(101)]], 29, 2), 0.29),  # 0.29·100 is 28.999999999999996 in doubles
    ("PERCENTRANK.INC", ([[1, 2, 3, 4]], 2, 40), 0.333333333333333),
    ("PERCENTRANK.EXC", (MIXED, 1), 0.25),
    ("PERCENTRANK.EXC", (MIXED, 4), NA),
    ("RANK.EQ", (3, MIXED), 1),
    ("RANK.EQ", (3, MIXED, 1), 3),
    ("RANK.EQ", (2.5, MIXED), NA),
    ("RANK.EQ", ("x", MIXED), VALUE),
    ("RANK.EQ", ("2", MIXED), 2),
    ("RANK.EQ", (DIV0, [[NA]]), DIV0),
    ("RANK.EQ", (1, [[NA]], DIV0), NA),
    ("RANK.EQ", (1, NONE), NA),
    ("RANK.AVG", (3.5, FIVE, 1), 3.5),
    ("RANK.AVG", (3.5, FIVE), 2.5),
    ("RANK.AVG", (4, FIVE), NA),
    ("PERCENTILE.INC", (MIXED, [[0, 0.5], [1, 2]]), [[1.0, 2.0], [3.0, NUM]]),
    ("RANK.EQ", ([[3, 9]], MIXED), [[1.0, NA]]),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), HELP + TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=4e-16)


samples = st.lists(st.integers(-50, 50).map(lambda i: i / 4), min_size=1, max_size=25)


@given(samples, st.floats(0, 1))
@settings(max_examples=150, deadline=None)
def test_quantiles_are_numpys(evaluate, x, share):
    assert evaluate("PERCENTILE.INC", [x], share) == pytest.approx(np.quantile(x, share), rel=1e-12, abs=1e-12)
    place = share * (len(x) + 1)
    if 1 <= place <= len(x):
        expected = np.quantile(x, share, method="weibull")
        assert evaluate("PERCENTILE.EXC", [x], share) == pytest.approx(expected, rel=1e-12, abs=1e-12)


@given(samples, st.data())
@settings(max_examples=150, deadline=None)
def test_ranks_are_scipys(evaluate, x, data):
    at = data.draw(st.integers(0, len(x) - 1))
    falling = [-value for value in x]
    assert evaluate("RANK.EQ", x[at], [x]) == stats.rankdata(falling, "min")[at]
    assert evaluate("RANK.EQ", x[at], [x], 1) == stats.rankdata(x, "min")[at]
    assert evaluate("RANK.AVG", x[at], [x]) == stats.rankdata(falling)[at]
    assert evaluate("RANK.AVG", x[at], [x], 1) == stats.rankdata(x)[at]


@given(st.lists(st.integers(-50, 50), min_size=2, max_size=25, unique=True), st.floats(0, 1))
@settings(max_examples=150, deadline=None)
def test_the_rank_of_a_quantile_is_its_share(evaluate, x, share):
    quantile = evaluate("PERCENTILE.INC", [x], share)
    assert evaluate("PERCENTRANK.INC", [x], quantile, 14) == pytest.approx(share, abs=3e-14)


def test_a_constant_sample_is_asked_at_a_place_for_every_trial(value):
    places = Value.of_numbers(np.array([0.0, 0.5, 2.0]))
    result = function_named("PERCENTILE.INC")([value([[1, 2, 3]]), places]).objects()
    assert result.tolist() == [1.0, 2.0, NUM]
