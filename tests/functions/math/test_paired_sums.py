from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.functions.families import function_named
from xlmc.functions.values import Value, constant

DIV0, NUM, VALUE, NA = ErrorCode.DIV0, ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

X, Y = [[2, 3, 9, 1, 8, 7, 5]], [[6, 5, 11, 7, 5, 4, 4]]

TABLE = [
    ("SUMX2MY2", (X, Y), -55),
    ("SUMX2PY2", (X, Y), 521),
    ("SUMXMY2", (X, Y), 79),
    ("SUMXMY2", (2, 4), 4),
    ("SUMX2MY2", ([[1], [2], [3]], [[1, 1, 1]]), 11),
    ("SUMX2PY2", ([[1, 2], [3, 4]], [[1, 1, 1, 1]]), 34),
    ("SUMX2PY2", ([[1, None, "3", True]], [[1, 2, 3, 4]]), 2),
    ("SUMX2PY2", ([[1, 2]], [["x", 2]]), 8),
    ("SUMXMY2", ([[True, "1"]], [[1, 1]]), DIV0),
    ("SUMXMY2", (X, [[1, 2]]), NA),
    ("SUMXMY2", ([[1, DIV0]], [[NA, "x"]]), DIV0),
    ("SUMXMY2", ([[1, "x"]], [[1, NA]]), NA),
    ("SERIESSUM", (2, 3, 4, 5), 40),
    ("SERIESSUM", (2, 2, 1, [[1, 2, 3], [4, 5, 6]]), 1284),
    ("SERIESSUM", (0, 0, 1, [[7, 9]]), 7),
    ("SERIESSUM", (10, 100, 100, [[1, 2, 3]]), 3e300),
    ("SERIESSUM", (10, 100, 100, [[1, 2, 3, 4]]), NUM),
    ("SERIESSUM", (-2, 0.5, 1, [[1]]), NUM),
    ("SERIESSUM", ("1", None, "1", [[None], [2]]), 2),
    ("SERIESSUM", ("x", 1, 1, 1), VALUE),
    ("SERIESSUM", (1, 1, 1, [["0", 5]]), VALUE),
    ("SERIESSUM", (1, 1, 1, [[True]]), VALUE),
    ("SERIESSUM", (1, 1, NA, [[DIV0]]), NA),
    ("SERIESSUM", (1, 1, 1, [[2, DIV0]]), DIV0),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-15)


def test_cosine_by_its_series(evaluate):
    """The example in Excel's own help."""
    coefficients = [[1], [-1 / 2], [1 / 24], [-1 / 720]]
    assert evaluate("SERIESSUM", math.pi / 4, 0, 2, coefficients) == pytest.approx(0.707103214822846, rel=1e-14)


def test_trials_beside_constant_coefficients(value):
    x = Value.of_numbers(np.array([1.0, 2.0, 3.0]))
    result = function_named("SERIESSUM")([x, constant(1.0), constant(2.0), value([[1, 10]])])
    assert result.numbers.tolist() == [11.0, 82.0, 273.0]
    pairs = function_named("SUMXMY2")([value([[1, 2]]), Value.of_numbers(np.arange(6.0).reshape(3, 1, 2))])
    assert pairs.numbers.tolist() == [2.0, 2.0, 18.0]
