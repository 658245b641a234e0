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
