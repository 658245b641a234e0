from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.functions.statistical.regression import fit

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
    found = fitted(LONGLEY[:, 0], LONGLEY[:, 1:])
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
    deviation = np.sqrt(found.residual / found.freedom)
    assert found.slopes[0] == pytest.approx(slopes, rel=1e-11)
    assert found.intercept == pytest.approx(-3482258.63459582, rel=1e-11)
    assert found.slope_spread[0] * deviation == pytest.approx(errors, rel=1e-11)
    assert found.intercept_spread * deviation == pytest.approx(890420.383607373, rel=1e-11)
    assert found.residual == pytest.approx(836424.055505915, rel=1e-11)
    assert found.regression == pytest.approx(184172401.944494, rel=1e-11)
    assert (found.used.item(), found.freedom.item()) == (6, 9)


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
        found, exact = fitted(y, x, free), _exact(y, design)
        coefficients = [*found.slopes[0], *([found.intercept.item()] if free else [])]
        assert coefficients == pytest.approx(exact, rel=1e-10, abs=1e-11)


def test_a_column_that_depends_on_others_is_left_out():
    x = np.array([[1, 2, 3], [2, 0, 2], [5, 1, 6], [7, 9, 16], [4, 4, 8.0]])
    y = x[:, 0] + 2 * x[:, 1] + 5
    found = fitted(y, x)
    assert found.slopes[0] == pytest.approx([1, 2, 0])
    assert found.slope_spread[0, 2] == 0
    assert (found.used.item(), found.freedom.item()) == (2, 2)


def test_a_column_of_equal_numbers_is_the_intercept():
    found = fitted([1, 2, 4], [[0.1], [0.1], [0.1]])
    assert found.slopes[0] == [0]
    assert found.intercept == pytest.approx(7 / 3)
    assert found.freedom == 2


def test_through_zero_or_not_is_asked_of_each_trial():
    y, x = np.array([[1.0, 3.0, 4.0]]), np.array([[[1.0], [2.0], [3.0]]])
    both = fit(y, x, np.array([True, False]))
    for trial, free in enumerate([True, False]):
        alone = fit(y, x, np.array([free]))
        assert both.slopes[trial] == alone.slopes[0]
        assert both.intercept[trial] == alone.intercept[0]
        assert both.at(x)[trial].tolist() == alone.at(x)[0].tolist()
