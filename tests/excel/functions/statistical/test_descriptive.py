from __future__ import annotations

import statistics

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from xlmc.errors import ErrorCode

NUM, VALUE, NA, DIV0 = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA, ErrorCode.DIV0

MIXED = [[3, "2", True], [None, 4, 5]]
"""Three numbers; text, logical and blank cells beside them."""
NONE = [["x", None, True]]
MOMENTS = [[3, 4, 5, 2, 3, 4, 5, 6, 4, 7]]

HELP = [
    ("AVEDEV", ([[4, 5, 6, 7, 5, 4, 3]],), "1.020408"),
    ("DEVSQ", ([[4, 5, 8, 7, 11, 4, 3]],), "48"),
    ("GEOMEAN", ([[4, 5, 8, 7, 11, 4, 3]],), "5.476987"),
    ("HARMEAN", ([[4, 5, 8, 7, 11, 4, 3]],), "5.028376"),
    ("KURT", (MOMENTS,), "-0.151799637"),
    ("SKEW", (MOMENTS,), "0.359543071"),
    ("SKEW.P", (MOMENTS,), "0.303193339"),
    ("TRIMMEAN", ([[4, 5, 6, 7, 2, 3, 4, 5, 1, 2, 3]], 0.2), "3.778"),
]


@pytest.mark.parametrize(("name", "arguments", "printed"), HELP)
def test_examples_of_excels_help(shows, name, arguments, printed):
    shows(name, arguments, printed)


TABLE = [
    ("AVEDEV", (MIXED,), 2 / 3),
    ("AVEDEV", (True, False), 0.5),
    ("AVEDEV", (1,), 0),
    ("AVEDEV", (NONE,), NUM),
    ("AVEDEV", ("x",), VALUE),
    ("AVEDEV", ([[1, NA]],), NA),
    ("DEVSQ", (MIXED,), 2),
    ("DEVSQ", ("1", "2", 2), 2 / 3),
    ("DEVSQ", ([[0.1, 0.1, 0.1]],), 0),
    ("DEVSQ", (NONE,), NUM),
    ("GEOMEAN", (2, 8), 4),
    ("GEOMEAN", (4e300, 4e-300), 4),
    ("GEOMEAN", (2, 0), NUM),
    ("GEOMEAN", (2, -8), NUM),
    ("GEOMEAN", (NONE,), NUM),
    ("HARMEAN", (2, "6"), 3),
    ("HARMEAN", (2, 0), NUM),
    ("HARMEAN", (NONE, DIV0), DIV0),
    ("HARMEAN", (NONE,), NUM),
    ("SKEW", ([[1, 0, 0, False, None, "0"]],), 3**0.5),
    ("SKEW", (True, False, None), 3**0.5),
    ("SKEW", (1, 2), DIV0),
    ("SKEW", (0.1, 0.1, 0.1), DIV0),
    ("SKEW.P", (1, 2), DIV0),
    ("SKEW.P", (0.1, 0.1, 0.1), DIV0),
    ("KURT", (1, 2, 3), DIV0),
    ("KURT", (0.1, 0.1, 0.1, 0.1), DIV0),
    ("KURT", ("x", 2, 3), VALUE),
    ("TRIMMEAN", ([[1, 2, 3, 100, None, "x"]], 0.5), 2.5),
    ("TRIMMEAN", ([[1, 2, 3, 100]], 0.49), 26.5),
    ("TRIMMEAN", ([[1, 2, 3, 100]], 0), 26.5),
    ("TRIMMEAN", ([[1, 2, 3, 100]], 1), NUM),
    ("TRIMMEAN", ([[1, 2, 3, 100]], -0.1), NUM),
    ("TRIMMEAN", (NONE, 0.1), NUM),
    ("TRIMMEAN", ([[1, NA]], DIV0), NA),
    ("TRIMMEAN", ([[1, 2]], "x"), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-14)


samples = st.lists(st.floats(-1e3, 1e3), min_size=4, max_size=30).filter(lambda x: statistics.pstdev(x) > 1e-3)


@given(samples)
@settings(max_examples=100, deadline=None)
def test_moments_are_scipys(evaluate, x):
    assert evaluate("SKEW", [x]) == pytest.approx(float(stats.skew(x, bias=False)), rel=1e-9, abs=1e-9)
    assert evaluate("SKEW.P", [x]) == pytest.approx(float(stats.skew(x)), rel=1e-9, abs=1e-9)
    assert evaluate("KURT", [x]) == pytest.approx(float(stats.kurtosis(x, bias=False)), rel=1e-9, abs=1e-9)
    mean = statistics.fmean(x)
    assert evaluate("DEVSQ", [x]) == pytest.approx(len(x) * statistics.pvariance(x), rel=1e-12)
    assert evaluate("AVEDEV", [x]) == pytest.approx(statistics.fmean(abs(v - mean) for v in x), rel=1e-12)


@given(st.lists(st.floats(1e-3, 1e3), min_size=1, max_size=30))
@settings(max_examples=100, deadline=None)
def test_means_are_pythons(evaluate, x):
    assert evaluate("GEOMEAN", [x]) == pytest.approx(statistics.geometric_mean(x), rel=1e-12)
    assert evaluate("HARMEAN", [x]) == pytest.approx(statistics.harmonic_mean(x), rel=1e-12)


@given(samples, st.floats(0, 0.99))
@settings(max_examples=100, deadline=None)
def test_the_trimmed_mean_is_scipys(evaluate, x, share):
    assert evaluate("TRIMMEAN", [x], share) == pytest.approx(float(stats.trim_mean(x, share / 2)), rel=1e-9, abs=1e-9)


def test_a_shift_costs_no_digits(evaluate):
    x = np.array(MOMENTS[0]) + 2.0**40
    assert evaluate("KURT", [x.tolist()]) == pytest.approx(evaluate("KURT", MOMENTS), rel=1e-13)


NUM_OF_ANY_KIND, VALUE_OF_ANY_KIND, NA_OF_ANY_KIND, DIV0_OF_ANY_KIND = (
    ErrorCode.NUM,
    ErrorCode.VALUE,
    ErrorCode.NA,
    ErrorCode.DIV0,
)

MIXED_OF_ANY_KIND = [[10, "12", True], [None, False, 4]]
"""10, 0, 1, 0 and 4."""
BLANK = [[None, None]]
BREAKING = [[1345, 1301, 1368, 1322, 1310, 1370, 1318, 1350, 1303, 1299]]  # the example in Excel's own help

HELP_OF_ANY_KIND = [
    ("AVERAGEA", ([[10, 7, 9, 2, "Not available"]],), "5.6"),
    ("AVERAGEA", ([[10, 7, 9, 2, None]],), "7"),
    ("MAXA", ([[0, 0.2, 0.5, 0.4, True]],), "1"),
    ("MINA", ([[False, 0.2, 0.5, 0.4, 0.8]],), "0"),
    ("STDEVA", (BREAKING,), "27.46391572"),
    ("STDEVPA", (BREAKING,), "26.05455814"),
    ("VARA", (BREAKING,), "754.2666667"),
    ("VARPA", (BREAKING,), "678.84"),
]


@pytest.mark.parametrize(("name", "arguments", "printed"), HELP_OF_ANY_KIND)
def test_examples_of_excels_help_any_kind(shows, name, arguments, printed):
    shows(name, arguments, printed)


TABLE_OF_ANY_KIND = [
    ("AVERAGEA", (MIXED_OF_ANY_KIND,), 3),
    ("AVERAGEA", ("1", 1, [[False]], None), 0.5),
    ("AVERAGEA", ("TRUE", 1), VALUE_OF_ANY_KIND),
    ("AVERAGEA", (BLANK,), DIV0_OF_ANY_KIND),
    ("AVERAGEA", ([[1, NA_OF_ANY_KIND]], DIV0_OF_ANY_KIND), NA_OF_ANY_KIND),
    ("MAXA", (MIXED_OF_ANY_KIND, 3), 10),
    ("MAXA", ([["x", -1]],), 0),
    ("MAXA", ([[None, -1]],), -1),
    ("MAXA", (None, -1), 0),
    ("MAXA", (BLANK,), 0),
    ("MINA", (MIXED_OF_ANY_KIND, 3), 0),
    ("MINA", ("-23", [["x"]], BLANK), -23),
    ("MINA", ("x", 1), VALUE_OF_ANY_KIND),
    ("MINA", (BLANK,), 0),
    ("VARA", (MIXED_OF_ANY_KIND,), 18),
    ("VARA", ([[True]],), DIV0_OF_ANY_KIND),
    ("VARA", (BLANK,), DIV0_OF_ANY_KIND),
    ("VARA", ([[0.1, 0.1, 0.1]],), 0),
    ("VARPA", (MIXED_OF_ANY_KIND,), 14.4),
    ("VARPA", ([[True]],), 0),
    ("VARPA", (BLANK,), DIV0_OF_ANY_KIND),
    ("STDEVA", (MIXED_OF_ANY_KIND,), 18**0.5),
    ("STDEVA", ([["x"]],), DIV0_OF_ANY_KIND),
    ("STDEVPA", (MIXED_OF_ANY_KIND,), 14.4**0.5),
    ("STDEVPA", (BLANK,), DIV0_OF_ANY_KIND),
    ("STDEVPA", ([[NA_OF_ANY_KIND]],), NA_OF_ANY_KIND),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE_OF_ANY_KIND)
def test_table_any_kind(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-15)
