from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from xlmc.errors import ErrorCode

NUM, VALUE, NA, DIV0 = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA, ErrorCode.DIV0

ONE, OTHER = [[3, 4, 5, 8, 9, 1, 2, 4, 5]], [[6, 19, 3, 2, 14, 4, 5, 17, 1]]
ACTUAL, EXPECTED = [[58, 35], [11, 25], [10, 23]], [[45.35, 47.65], [17.56, 18.44], [16.09, 16.91]]
TEN = [[3], [6], [7], [8], [6], [5], [4], [2], [1], [9]]

HELP = [
    ("T.TEST", (ONE, OTHER, 2, 1), "0.196016"),
    ("TTEST", (ONE, OTHER, 2, 1), "0.196016"),
    ("F.TEST", ([[6, 7, 9, 15, 21]], [[20, 28, 31, 38, 40]]), "0.64831785"),
    ("FTEST", ([[6, 7, 9, 15, 21]], [[20, 28, 31, 38, 40]]), "0.64831785"),
    ("CHISQ.TEST", (ACTUAL, EXPECTED), "0.0003082"),
    ("CHITEST", (ACTUAL, EXPECTED), "0.0003082"),
    ("Z.TEST", (TEN, 4), "0.090574"),
    ("ZTEST", (TEN, 6), "0.863043"),
]


@pytest.mark.parametrize(("name", "arguments", "printed"), HELP)
def test_examples_of_excels_help(shows, name, arguments, printed):
    shows(name, arguments, printed)


SIX = [[1, 10, 1, 1, 3, 7]], [[2, 5, None, 1, 4, 8]]

TABLE = [
    ("T.TEST", (*SIX, 1.9, 1.9), stats.ttest_rel([1, 10, 1, 3, 7], [2, 5, 1, 4, 8]).pvalue.item() / 2),
    ("T.TEST", ([[1, 2]], [[1, 2, 3]], 1, 1), NA),
    ("T.TEST", ([[1, 2]], [[1, 2, 3]], 3, 1), NUM),
    ("T.TEST", ([[1, 2]], [[1, 2, 3]], 2, 4), NUM),
    ("T.TEST", ([[1, 2]], [[2, 3]], 2, 1), DIV0),
    ("T.TEST", ([[1, 1]], [[3, 3]], 2, 2), DIV0),
    ("T.TEST", ([[1, "x"]], [[3, 4, 5]], 2, 2), DIV0),
    ("T.TEST", ([[1, "x"]], [[3, 4, 5]], 2, 3), DIV0),
    ("T.TEST", (1, 2, 1, 1), DIV0),
    ("T.TEST", ([[1, NA]], [[DIV0, 5]], "x", 3), NA),
    ("T.TEST", ([[1, 2]], [[3, 5]], "x", 3), VALUE),
    ("F.TEST", ([[1, 1]], [[3, 5]]), DIV0),
    ("F.TEST", ([[1, "2"]], [[3, 5]]), DIV0),
    ("F.TEST", ([[1, NA]], [[3, DIV0]]), NA),
    ("F.TEST", ([[5, None, True, 8]], [[3, 6, False]]), 1),
    ("CHISQ.TEST", ([[1, 10, 1], [2, 5, 1]], [[1, 3, 7, 1, 4, 8]]), 5.433048599998019e-07),
    ("CHISQ.TEST", ([[1, 2]], [[1, 2, 3]]), NA),
    ("CHISQ.TEST", (1, 2), NA),
    ("CHISQ.TEST", ([[1, 2]], [[0, 3]]), DIV0),
    ("CHISQ.TEST", ([[1, 2]], [[-0.001, 3]]), NUM),
    ("CHISQ.TEST", ([[1, "x", 2]], [[1, 0, 2]]), 1),
    ("CHISQ.TEST", ([[1, NA]], [[DIV0, 1]]), NA),
    ("Z.TEST", ([[1, 2, 3, 4]], 1, 1), 0.00134989803163009453),
    ("Z.TEST", ([[None, 2, 3, 4, True]], 1, 1), 0.000266002752569605),
    ("Z.TEST", ([[1, None]], 1), DIV0),
    ("Z.TEST", ([[1, 1]], 1), DIV0),
    ("Z.TEST", ([[None, None]], 1, 1), NA),
    ("Z.TEST", ([[1, 2]], 1, 0), NUM),
    ("Z.TEST", ([[1, NA]], DIV0), NA),
    ("Z.TEST", ([[1, 2]], "x"), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-12)


samples = st.lists(st.integers(-40, 40), min_size=2, max_size=12).filter(lambda x: len(set(x)) > 1)


@given(samples, samples)
@settings(max_examples=100, deadline=None)
def test_tests_of_two_samples_are_scipys(evaluate, x, y):
    for kind, equal in ((2, True), (3, False)):
        expected = float(stats.ttest_ind(x, y, equal_var=equal).pvalue)
        assert evaluate("T.TEST", [x], [y], 2, kind) == pytest.approx(expected, rel=1e-9)
        assert evaluate("T.TEST", [x], [y], 1, kind) == pytest.approx(expected / 2, rel=1e-9)
    ratio = np.var(x, ddof=1) / np.var(y, ddof=1)
    f = stats.f(len(x) - 1, len(y) - 1)
    assert evaluate("F.TEST", [x], [y]) == pytest.approx(2 * min(f.cdf(ratio), f.sf(ratio)), rel=1e-9)


@given(st.lists(st.tuples(st.integers(-40, 40), st.integers(-40, 40)), min_size=2, max_size=12), st.integers(-40, 40))
@settings(max_examples=100, deadline=None)
def test_tests_of_one_sample_are_scipys(evaluate, pairs, centre):
    x, y = ([list(side)] for side in zip(*pairs, strict=True))
    if len({a - b for a, b in pairs}) > 1:
        expected = float(stats.ttest_rel(x[0], y[0]).pvalue)
        assert evaluate("T.TEST", x, y, 2, 1) == pytest.approx(expected, rel=1e-9)
    if len(set(x[0])) > 1:
        error = np.std(x[0], ddof=1) / len(x[0]) ** 0.5
        assert evaluate("Z.TEST", x, centre) == pytest.approx(stats.norm.sf((np.mean(x[0]) - centre) / error), rel=1e-9)


def test_tails_and_kinds_may_be_arrays(evaluate):
    result = evaluate("T.TEST", ONE, OTHER, [[1], [2], [0]], [[1, 2]])
    assert result[2] == [NUM, NUM]
    assert result[1] == pytest.approx([2 * p for p in result[0]])
