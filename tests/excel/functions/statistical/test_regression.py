from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.statistical.regression import fit
from xlmc.excel.functions.values import ShapeVaries, Value, constant

NUM, VALUE, NA, DIV0, REF = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA, ErrorCode.DIV0, ErrorCode.REF

OFFICES = [
    (2310, 2, 2, 20, 142000),
    (2333, 2, 2, 12, 144000),
    (2356, 3, 1.5, 33, 151000),
    (2379, 3, 2, 43, 150000),
    (2402, 2, 3, 53, 139000),
    (2425, 4, 2, 23, 169000),
    (2448, 2, 1.5, 99, 126000),
    (2471, 2, 2, 34, 142900),
    (2494, 3, 3, 23, 163000),
    (2517, 4, 4, 55, 169000),
    (2540, 2, 3, 22, 149000),
]
"""The example of several variables in Excel's help on LINEST."""
X, Y = [list(row[:4]) for row in OFFICES], [[row[4]] for row in OFFICES]
UNITS, MONTHS = [[33100], [47300], [69000], [102000], [150000], [220000]], [[11], [12], [13], [14], [15], [16]]
SALES = [133890, 135000, 135790, 137300, 138130, 139100, 139900, 141120, 141890, 143230, 144000, 145290]


def turned(rows):
    return [list(column) for column in zip(*rows, strict=True)]


def same(result, expected, rel):
    assert len(result) == len(expected)
    for row, wanted in zip(result, expected, strict=True):
        assert [type(item) for item in row] == [type(item) for item in wanted]
        numbers = [(a, b) for a, b in zip(row, wanted, strict=True) if isinstance(b, float)]
        assert [a for a, _ in numbers] == pytest.approx([b for _, b in numbers], rel=rel)
        assert [a for a in row if not isinstance(a, float)] == [b for b in wanted if not isinstance(b, float)]


def test_the_help_on_linest(evaluate):
    expected = [
        [-234.2371645, 2553.21066, 12529.76817, 27.64138737, 52317.83051],
        [13.26801148, 530.6691519, 400.0668382, 5.429374042, 12237.3616],
        [0.996747993, 970.5784629, NA, NA, NA],
        [459.7536742, 6.0, NA, NA, NA],
        [1732393319.0, 5652135.316, NA, NA, NA],
    ]
    same(evaluate("LINEST", Y, X, True, True), expected, 1e-9)
    same(evaluate("LINEST", turned(Y), turned(X), True, True), expected, 1e-9)
    same(evaluate("LINEST", Y, X), expected[:1], 1e-9)


def test_the_help_on_logest_and_growth(evaluate):
    same(evaluate("LOGEST", UNITS, MONTHS), [[1.463275628, 495.3047702]], 1e-9)
    expected = [
        [1.463275628, 495.3047702],
        [0.002633403, 0.035834282],
        [0.99980862, 0.011016315],
        [20896.80114, 4.0],
        [2.53601883, 0.000485437],
    ]
    same(evaluate("LOGEST", UNITS, MONTHS, True, True), expected, 1e-6)
    fitted = [[32618.20377], [47729.42261], [69841.30086], [102197.0734], [149542.4867], [218821.8762]]
    same(evaluate("GROWTH", UNITS, MONTHS), fitted, 1e-9)
    same(evaluate("GROWTH", UNITS, MONTHS, [[17], [18]]), [[320196.7184], [468536.0542]], 1e-9)


def test_the_help_on_trend(evaluate):
    result = evaluate("TREND", turned([SALES]))
    assert [result[0][0], result[11][0]] == pytest.approx([133953.3333, 145153.3333], rel=1e-9)
    assert len(result) == 12
    expected = [[146171.5152], [147189.6970], [148207.8788], [149226.0606], [150244.2424]]
    same(evaluate("TREND", turned([SALES]), None, [[13], [14], [15], [16], [17]]), expected, 1e-9)


POINTS = [[1.0, 3.0, 4.0]]

TABLE = [
    ("LINEST", ([[1], [9], [5], [7]], [[0], [4], [2], [3]]), [[2.0, 1.0]]),
    ("LINEST", ([[1], [9], [5], [7]], [[0], [4], [2], [3]], None), [[2.0, 1.0]]),
    ("LINEST", (POINTS, None, None, None), [[1.5, -1 / 3]]),
    ("LINEST", (POINTS, [[1, 2, 3]], False), [[19 / 14, 0.0]]),
    ("LINEST", (POINTS, [[1, 1, 1]]), [[0.0, 8 / 3]]),
    ("LINEST", ([[1, 2]], [[1, 2]], True, True), [[1.0, 0.0], [0.0, 0.0], [1.0, 0.0], [NUM, 0.0], [0.5, 0.0]]),
    ("LINEST", (7, 3), [[0.0, 7.0]]),
    ("LINEST", ([[1, 2], [3, 4]], [[1, 2], [3, 4]]), [[1.0, 0.0]]),
    ("LINEST", (POINTS, [[1, 2]]), REF),
    ("LINEST", (POINTS, [[1], [2], [3]]), REF),
    ("LINEST", ([[1, None, 4]],), [[VALUE, VALUE]]),
    ("LINEST", (POINTS, [[1, "2", 3]]), [[VALUE, VALUE]]),
    ("LINEST", (POINTS, [[1, NA, "x"]], DIV0), [[NA, NA]]),
    ("LINEST", (POINTS, None, DIV0), [[DIV0, DIV0]]),
    ("LOGEST", ([[2, 4, 8]],), [[2.0, 1.0]]),
    ("LOGEST", ([[2, 4, 0]],), [[NUM, NUM]]),
    ("LOGEST", ([[2, 4, -1]], [[1, 2, True]]), [[VALUE, VALUE]]),
    ("TREND", (POINTS, [[1, 2, 3]], [[0], [4]]), [[-1 / 3], [17 / 3]]),
    ("TREND", (POINTS, [[1, 2, 3]], 4, False), [[38 / 7]]),
    ("TREND", (Y, X, [[2500, 3, 2]]), REF),
    ("TREND", (Y, turned(X)), REF),
    ("TREND", (POINTS, None, [["x"]]), [[VALUE]]),
    ("GROWTH", ([[2, 4, 8]], [[1, 2, 3]], [[4, 5]]), [[16.0, 32.0]]),
    ("GROWTH", ([[2, 4, 0]],), [[NUM, NUM, NUM]]),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(evaluate, name, arguments, expected):
    result = evaluate(name, *arguments)
    if isinstance(expected, ErrorCode):
        assert result == expected
    else:
        assert np.shape(result) == np.shape(expected)
        for a, b in zip(np.ravel(np.array(result, object)), np.ravel(np.array(expected, object)), strict=True):
            assert a == (pytest.approx(b, rel=1e-13, abs=1e-14) if isinstance(b, float) else b)


def test_through_zero_the_intercept_has_no_error(evaluate):
    result = evaluate("LINEST", POINTS, [[1, 2, 3]], False, True)
    slope, rest = 19 / 14, sum((y - 19 / 14 * x) ** 2 for x, y in zip((1, 2, 3), POINTS[0], strict=True))
    same(result[:2], [[slope, 0.0], [(rest / 2 / 14) ** 0.5, NA]], 1e-12)
    same(result[3:], [[(26 - rest) / (rest / 2), 2.0], [26 - rest, rest]], 1e-12)


def test_several_variables_are_predicted_in_columns_and_rows(evaluate):
    new = [[2500, 3, 2, 25], [2310, 2, 2, 20]]
    plane, *_ = np.linalg.lstsq(np.insert(np.array(X, float), 0, 1, axis=1), np.array(Y, float))
    expected = (np.insert(np.array(new, float), 0, 1, axis=1) @ plane).tolist()
    same(evaluate("TREND", Y, X, new), expected, 1e-9)
    same(evaluate("TREND", turned(Y), turned(X), turned(new)), turned(expected), 1e-9)


def test_two_variables_are_predicted_together(evaluate):
    x, y = [[1, 5], [2, 3], [4, 4], [7, 1]], [[2 + 3 * a - 4 * b] for a, b in [(1, 5), (2, 3), (4, 4), (7, 1)]]
    same(evaluate("TREND", y, x, [[3, 2], [5, 5]]), [[3.0], [-3.0]], 1e-12)
    same(evaluate("TREND", turned(y), turned(x), [[3, 5], [2, 5]]), [[3.0, -3.0]], 1e-12)


def test_a_shape_that_differs_between_trials_is_asked_for_trial_by_trial(value):
    stats = Value.of_logicals(np.array([True, False]))
    with pytest.raises(ShapeVaries):
        function_named("LINEST")([value(POINTS), constant(None), constant(True), stats])


def test_trials_have_lines_of_their_own(value):
    ys = Value.of_numbers(np.array([[[1.0, 2, 3]], [[2, 4, 9]]]))
    result = function_named("LINEST")([ys, value([[1, 2, 3]])]).numbers
    assert result == pytest.approx(np.array([[[1, 0]], [[3.5, -2]]]), abs=1e-14)


LONGLEY = np.array(
    [
        (60323, 83.0, 234289, 2356, 1590, 107608, 1947),
        (61122, 88.5, 259426, 2325, 1456, 108632, 1948),
        (60171, 88.2, 258054, 3682, 1616, 109773, 1949),
        (61187, 89.5, 284599, 3351, 1650, 110929, 1950),
        (63221, 96.2, 328975, 2099, 3099, 112075, 1951),
        (63639, 98.1, 346999, 1932, 3594, 113270, 1952),
        (64989, 99.0, 365385, 1870, 3547, 115094, 1953),
        (63761, 100.0, 363112, 3578, 3350, 116219, 1954),
        (66019, 101.2, 397469, 2904, 3048, 117388, 1955),
        (67857, 104.6, 419180, 2822, 2857, 118734, 1956),
        (68169, 108.4, 442769, 2936, 2798, 120445, 1957),
        (66513, 110.8, 444546, 4681, 2637, 121950, 1958),
        (68655, 112.6, 482704, 3813, 2552, 123366, 1959),
        (69564, 114.2, 502601, 3931, 2514, 125368, 1960),
        (69331, 115.7, 518173, 4806, 2572, 127852, 1961),
        (70551, 116.9, 554894, 4007, 2827, 130081, 1962),
    ]
)
"""Longley's data, on which programs lose many digits; certified in NIST's Statistical Reference Datasets."""


def fitted(y, x, free=True):
    x = np.asarray(x, float)
    return fit(np.asarray(y, float)[None], x.reshape(1, x.shape[0], -1), np.array([free]))


def test_longley():
    result = fitted(LONGLEY[:, 0], LONGLEY[:, 1:])
    slopes = [
        15.0618722713733,
        -0.0358191792925910,
        -2.02022980381683,
        -1.03322686717359,
        -0.0511041056535807,
        1829.15146461355,
    ]
    errors = [
        84.9149257747669,
        0.0334910077722432,
        0.488399681651699,
        0.214274163161675,
        0.226073200069370,
        455.478499142212,
    ]
    deviation = np.sqrt(result.residual / result.freedom)
    assert result.slopes[0] == pytest.approx(slopes, rel=1e-11)
    assert result.intercept == pytest.approx(-3482258.63459582, rel=1e-11)
    assert result.slope_spread[0] * deviation == pytest.approx(errors, rel=1e-11)
    assert result.intercept_spread * deviation == pytest.approx(890420.383607373, rel=1e-11)
    assert result.residual == pytest.approx(836424.055505915, rel=1e-11)
    assert result.regression == pytest.approx(184172401.944494, rel=1e-11)
    assert (result.used.item(), result.freedom.item()) == (6, 9)


def _exact(y, x):
    """The coefficients by the normal equations, in fractions."""
    rows = [[Fraction(value) for value in row] for row in x]
    p = len(rows[0])
    system = [
        [sum(row[i] * row[j] for row in rows) for j in range(p)] + [sum(r[i] * t for r, t in zip(rows, y, strict=True))]
        for i in range(p)
    ]
    for i in range(p):
        pivot = next(k for k in range(i, p) if system[k][i] != 0)
        system[i], system[pivot] = system[pivot], system[i]
        system[i] = [value / system[i][i] for value in system[i]]
        for k in range(p):
            if k != i:
                system[k] = [a - system[k][i] * b for a, b in zip(system[k], system[i], strict=True)]
    return [float(row[-1]) for row in system]


integers = st.integers(-20, 20)


@given(st.integers(1, 3).flatmap(lambda p: st.lists(st.tuples(*[integers] * (p + 1)), min_size=p + 3, max_size=9)))
@settings(max_examples=100, deadline=None)
def test_planes_are_exact(rows):
    y, x = [row[0] for row in rows], [row[1:] for row in rows]
    with_one = [(*row, 1) for row in x]
    for design, free in ((with_one, True), (x, False)):
        if np.linalg.matrix_rank(np.array(design, float)) < len(design[0]):
            continue
        result, exact = fitted(y, x, free), _exact(y, design)
        coefficients = [*result.slopes[0], *([result.intercept.item()] if free else [])]
        assert coefficients == pytest.approx(exact, rel=1e-10, abs=1e-11)


def test_a_column_that_depends_on_others_is_left_out():
    x = np.array([[1, 2, 3], [2, 0, 2], [5, 1, 6], [7, 9, 16], [4, 4, 8.0]])
    y = x[:, 0] + 2 * x[:, 1] + 5
    result = fitted(y, x)
    assert result.slopes[0] == pytest.approx([1, 2, 0])
    assert result.slope_spread[0, 2] == 0
    assert (result.used.item(), result.freedom.item()) == (2, 2)


def test_a_column_of_equal_numbers_is_the_intercept():
    result = fitted([1, 2, 4], [[0.1], [0.1], [0.1]])
    assert result.slopes[0] == [0]
    assert result.intercept == pytest.approx(7 / 3)
    assert result.freedom == 2


def test_through_zero_or_not_is_asked_of_each_trial():
    y, x = np.array([[1.0, 3.0, 4.0]]), np.array([[[1.0], [2.0], [3.0]]])
    both = fit(y, x, np.array([True, False]))
    for trial, free in enumerate([True, False]):
        alone = fit(y, x, np.array([free]))
        assert both.slopes[trial] == alone.slopes[0]
        assert both.intercept[trial] == alone.intercept[0]
        assert both.at(x)[trial].tolist() == alone.at(x)[0].tolist()
