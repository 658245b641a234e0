from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import ShapeVaries, Value, constant, from_objects

DIV0, NUM, VALUE, NA = ErrorCode.DIV0, ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

NOT_NUMBERS = [[[1, 2], [2, None]], [[1, 2], ["3", 4]], [[1, True], [3, 4]]]

EXACT = [
    ("MMULT", ([[1, 2], [2, 3]], [[1, 2], [2, 3]]), [[5.0, 8.0], [8.0, 13.0]]),
    ("MMULT", ([[1, 2]], [[1], [2]]), [[5.0]]),
    ("MMULT", ([[1], [2]], [[1, 2]]), [[1.0, 2.0], [2.0, 4.0]]),
    ("MMULT", ([[1, 3, 5], [2, 4, 6]], [[10, 13], [11, 14], [12, 15]]), [[103.0, 130.0], [136.0, 172.0]]),
    ("MMULT", (3, [[4]]), [[12.0]]),
    ("MMULT", ([[1, 2]], [[1, 2]]), VALUE),
    ("MMULT", ([[1e308]], [[10]]), [[NUM]]),
    ("MMULT", ([[1, NA]], [[DIV0], [1]]), [[NA]]),
    ("MDETERM", ([[1, 2], [2, 3]],), -1.0),
    ("MDETERM", ([[1, 2], [1, 2]],), 0.0),
    ("MDETERM", ([[7]],), 7.0),
    ("MDETERM", (7,), 7.0),
    ("MDETERM", ([[1, 2]],), VALUE),
    ("MDETERM", ([[1, "x"], [NA, 1]],), VALUE),
    ("MDETERM", ([[1, NA], ["x", 1]],), NA),
    ("MINVERSE", ([[1, 2, 3], [7, 5, 5]],), VALUE),
    ("MINVERSE", ([[1, 2], [1, 2]],), [[NUM, NUM], [NUM, NUM]]),
    ("MINVERSE", ([[4]],), [[0.25]]),
    ("MINVERSE", ([[1, 2], [DIV0, 3]],), [[DIV0, DIV0], [DIV0, DIV0]]),
    ("MUNIT", (3,), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    ("MUNIT", (1.9,), [[1.0]]),
    ("MUNIT", ("2",), [[1.0, 0.0], [0.0, 1.0]]),
    ("MUNIT", (0,), VALUE),
    ("MUNIT", (-1,), VALUE),
    ("MUNIT", (1e9,), VALUE),
    ("MUNIT", ("x",), VALUE),
    ("MUNIT", (NA,), NA),
    ("TRANSPOSE", ([[1, 2], [3, 4], [5, 6]],), [[1.0, 3.0, 5.0], [2.0, 4.0, 6.0]]),
    ("TRANSPOSE", ([["a", True], [NA, None]],), [["a", NA], [True, None]]),
    ("TRANSPOSE", ([[1, 2]],), [[1.0], [2.0]]),
    ("TRANSPOSE", (5,), [[5.0]]),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), EXACT)
def test_table(evaluate, name, arguments, expected):
    assert evaluate(name, *arguments) == expected


@pytest.mark.parametrize("cells", NOT_NUMBERS)
def test_every_cell_must_be_a_number(evaluate, cells):
    assert evaluate("MDETERM", cells) is VALUE
    assert evaluate("MINVERSE", cells) == [[VALUE, VALUE], [VALUE, VALUE]]
    assert evaluate("MMULT", cells, [[1], [1]]) == [[VALUE], [VALUE]]


def test_examples_of_excels_help(evaluate):
    assert evaluate("MDETERM", [[1, 3, 8, 5], [1, 3, 6, 1], [1, 1, 1, 0], [7, 3, 10, 2]]) == pytest.approx(
        88, rel=1e-14
    )
    assert evaluate("MDETERM", [[3, 6, 1], [1, 1, 0], [3, 10, 2]]) == pytest.approx(1, rel=1e-14)
    inverse = evaluate("MINVERSE", [[1, 2, 1], [3, 4, -1], [0, 2, 0]])
    assert np.allclose(inverse, [[0.25, 0.25, -0.75], [0, 0, 0.5], [0.75, -0.25, -0.25]], rtol=1e-14, atol=1e-15)


def _determinant(rows: list[list[int]]) -> Fraction:
    matrix = [[Fraction(x) for x in row] for row in rows]
    result = Fraction(1)
    for i in range(len(matrix)):
        pivot = next((r for r in range(i, len(matrix)) if matrix[r][i]), None)
        if pivot is None:
            return Fraction(0)
        if pivot != i:
            matrix[i], matrix[pivot], result = matrix[pivot], matrix[i], -result
        result *= matrix[i][i]
        for row in matrix[i + 1 :]:
            factor = row[i] / matrix[i][i]
            row[i:] = [a - factor * b for a, b in zip(row[i:], matrix[i][i:], strict=True)]
    return result


square = st.integers(1, 5).flatmap(
    lambda size: st.lists(st.lists(st.integers(-9, 9), min_size=size, max_size=size), min_size=size, max_size=size)
)


@given(square)
@settings(max_examples=100, deadline=None)
def test_determinants_and_inverses_agree_with_fractions(evaluate, rows):
    exact = _determinant(rows)
    assert evaluate("MDETERM", rows) == pytest.approx(float(exact), rel=1e-10, abs=1e-10)
    if exact:
        product = evaluate("MMULT", evaluate("MINVERSE", rows), rows)
        assert np.allclose(product, np.eye(len(rows)), rtol=0, atol=1e-8)


def test_trials_have_matrices_of_their_own():
    matrices = np.array([[[1.0, 2.0], [2.0, 3.0]], [[1.0, 2.0], [2.0, 4.0]], [[0.0, 1.0], [1.0, 0.0]]])
    trials = Value.of_numbers(matrices)
    inverses = function_named("MINVERSE")([trials]).objects()
    assert np.allclose(inverses[0].astype(float), [[-3, 2], [2, -1]], rtol=1e-14)
    assert inverses[1].tolist() == [[NUM, NUM], [NUM, NUM]]
    assert inverses[2].tolist() == [[0.0, 1.0], [1.0, 0.0]]
    vector = from_objects(np.array([[[1.0], [10.0]]], object))
    products = function_named("MMULT")([trials, vector])
    assert products.numbers.tolist() == [[[21.0], [32.0]], [[21.0], [42.0]], [[10.0], [1.0]]]


def test_a_tiny_matrix_is_not_singular(evaluate):
    assert evaluate("MINVERSE", [[1e-200, 0], [0, 1e-200]]) == [[1e200, 0.0], [0.0, 1e200]]


def test_unit_matrices_of_several_sizes_cannot_be_one_array():
    sizes = Value.of_numbers(np.array([2.0, 2.9]))
    assert function_named("MUNIT")([sizes]).shape == (1, 2, 2)
    with pytest.raises(ShapeVaries):
        function_named("MUNIT")([Value.of_numbers(np.array([2.0, 3.0]))])
    with pytest.raises(ShapeVaries):
        function_named("MUNIT")([from_objects(np.array([2.0, "x"], object))])


DIV0_OF_PAIRED_SUMS, NUM_OF_PAIRED_SUMS, VALUE_OF_PAIRED_SUMS, NA_OF_PAIRED_SUMS = (
    ErrorCode.DIV0,
    ErrorCode.NUM,
    ErrorCode.VALUE,
    ErrorCode.NA,
)

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
    ("SUMXMY2", ([[True, "1"]], [[1, 1]]), DIV0_OF_PAIRED_SUMS),
    ("SUMXMY2", (X, [[1, 2]]), NA_OF_PAIRED_SUMS),
    ("SUMXMY2", ([[1, DIV0_OF_PAIRED_SUMS]], [[NA_OF_PAIRED_SUMS, "x"]]), DIV0_OF_PAIRED_SUMS),
    ("SUMXMY2", ([[1, "x"]], [[1, NA_OF_PAIRED_SUMS]]), NA_OF_PAIRED_SUMS),
    ("SERIESSUM", (2, 3, 4, 5), 40),
    ("SERIESSUM", (2, 2, 1, [[1, 2, 3], [4, 5, 6]]), 1284),
    ("SERIESSUM", (0, 0, 1, [[7, 9]]), NUM_OF_PAIRED_SUMS),
    ("SERIESSUM", (10, 100, 100, [[1, 2, 3]]), 3e300),
    ("SERIESSUM", (10, 100, 100, [[1, 2, 3, 4]]), NUM_OF_PAIRED_SUMS),
    ("SERIESSUM", (-2, 0.5, 1, [[1]]), NUM_OF_PAIRED_SUMS),
    ("SERIESSUM", ("1", None, "1", [[None], [2]]), 2),
    ("SERIESSUM", ("x", 1, 1, 1), VALUE_OF_PAIRED_SUMS),
    ("SERIESSUM", (1, 1, 1, [["0", 5]]), VALUE_OF_PAIRED_SUMS),
    ("SERIESSUM", (1, 1, 1, [[True]]), VALUE_OF_PAIRED_SUMS),
    ("SERIESSUM", (1, 1, NA_OF_PAIRED_SUMS, [[DIV0_OF_PAIRED_SUMS]]), NA_OF_PAIRED_SUMS),
    ("SERIESSUM", (1, 1, 1, [[2, DIV0_OF_PAIRED_SUMS]]), DIV0_OF_PAIRED_SUMS),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table_paired_sums(check, name, arguments, expected):
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
