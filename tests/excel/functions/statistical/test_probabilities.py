"""Expected values: 60 digits of mpmath."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.excel.functions.statistical.probabilities import (
    binomial_mass,
    by_form,
    degrees_of_freedom,
    deviance,
    incomplete_beta,
    inverse_beta,
    poisson_mass,
    stirling_error,
)

POISSON = [
    ((993702635.0, 993655954.0), 4.2274572874897610619e-6),
    ((0.001, 1e-5), 0.98911316339601736656),
    ((15.5, 700.0), 2.3862451546016633402e-273),
    ((16.5, 3e-5), 2.7531920157196991234e-89),
    ((1e8, 1e8), 0.000039894228006898077774),
    ((40.25, 0.5), 2.2519018224895897447e-61),
    ((3.0, 2.5), 0.21376301724973644575),
    ((1e-10, 1e-10), 0.99999999765513647624),
    ((0.0, 2.0), 0.1353352832366126918940),
    ((0.0, 0.0), 1.0),
    ((3.0, 0.0), 0.0),
    ((30.0, 0.0), 0.0),
]
BINOMIAL = [
    ((0.25, 0.75, 0.125), 0.64575443926246611301),
    ((1e6, 0.5, 0.9999990463256836), 0.42459959432754362535),
    ((3.0, 4.0, 0.5), 0.2734375),
    ((1e8, 1e8, 0.5), 0.000056418958284251930795),
    ((20.0, 1e9, 2.0**-26), 0.040437621266349904044),
    ((0.0, 3.0, 0.25), 0.421875),
    ((3.0, 0.0, 0.25), 0.015625),
    ((0.0, 1e6, 1e-20), 0.99999999999999),
    ((0.0, 0.0, 0.25), 1.0),
    ((0.0, 5.0, 0.0), 1.0),
    ((2.0, 5.0, 0.0), 0.0),
    ((5.0, 0.0, 1.0), 1.0),
    ((5.0, 1.0, 1.0), 0.0),
]


@pytest.mark.parametrize(("arguments", "expected"), POISSON)
def test_poisson_mass(arguments, expected):
    assert poisson_mass(*map(np.array, arguments)) == pytest.approx(expected, rel=2e-13)


@pytest.mark.parametrize(("arguments", "expected"), BINOMIAL)
def test_binomial_mass(arguments, expected):
    x, y, p = map(np.array, arguments)
    assert binomial_mass(x, y, p, 1 - p) == pytest.approx(expected, rel=2e-14)


def test_binomial_mass_loses_no_digits_that_a_thousandth_part_of_the_numbers_has():
    """The product n·p of so large an n is rounded to 1e-16 of itself, which the distance from the mean multiplies."""
    x, n, p = 195998091.0, 824497081.0, 0.23782865394008143
    result = binomial_mass(np.array(x), np.array(n - x), np.array(p), np.array(1 - p))
    assert result == pytest.approx(3.1369369498624496792e-17, rel=5e-11)


@pytest.mark.parametrize(
    ("x", "expected"),
    [
        (1e-8, 8.2914020272061608566),
        (0.5, 0.15342640972002734529),
        (1, 0.08106146679532725822),
        (5, 0.016644691189821192163),
        (15.999, 0.0052079813338524327451),
        (16, 0.0052076559196096404407),
        (100, 0.00083333055563491468338),
        (1e8, 8.3333333333333333056e-10),
    ],
)
def test_stirling_error(x, expected):
    assert stirling_error(np.array(float(x))) == pytest.approx(expected, rel=1e-15, abs=2e-14)


@pytest.mark.parametrize(
    ("x", "mean", "expected"),
    [
        (1e8, 1e8 + 1, 4.9999999666666669167e-9),
        (100, 110, 0.4689820195675139956),
        (3, 1e-5, 34.834623260915014089),
        (5, 5000, 4960.4612236050893147),
        (2, 2, 0.0),
        (1, 1.2, 0.017678443206045366387),
    ],
)
def test_deviance(x, mean, expected):
    assert deviance(np.array(float(x)), np.array(float(mean))) == pytest.approx(expected, rel=2e-15)


def test_no_flag_is_raised_at_the_ends():
    with np.errstate(divide="raise", over="raise", invalid="raise"):
        poisson_mass(np.array([0.0, 0.0, 20.0, 3.0]), np.array([0.0, 1.0, 0.0, 0.0]))
        x, y, p = np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.5])
        binomial_mass(x, y, p, 1 - p)


def _never():
    raise AssertionError("it was asked for")


@pytest.mark.parametrize(
    ("cumulative", "probability", "density", "expected"),
    [
        ([True, False], lambda: np.array([1.0, 2.0]), lambda: np.array([3.0, 4.0]), [1, 4]),
        ([True, True], lambda: np.array([1.0, 2.0]), _never, [1, 2]),
        ([False, False], _never, lambda: np.array([3.0, 4.0]), [3, 4]),
        ([True, True], lambda: np.array([1.0]), _never, [1, 1]),
    ],
)
def test_only_the_form_that_a_trial_asks_for_is_computed(cumulative, probability, density, expected):
    assert by_form(np.array(cumulative), probability, density).tolist() == expected


def test_from_1_to_ten_billion_fractions_dropped():
    given = np.array([0.9, 1, 1.9, 5, 1e10, 1e10 + 0.5, -3])
    valid, freedom = degrees_of_freedom(given)
    assert valid.tolist() == [False, True, True, True, True, False, False]
    assert freedom.tolist() == [1, 1, 1, 5, 1e10, 1, 1]


BELOW = [
    ((0.5, 0.5, 1e-300), 6.3661977236758135105e-151),
    ((3.0, 4.0, 1e-20), 1.9999999999999996709e-59),
    ((200.0, 3.0, 0.25), 4.4369253716407351781e-117),
    ((8.0, 10.0, 0.5), 0.6854705810546875),
]


@pytest.mark.parametrize(("arguments", "expected"), BELOW)
def test_both_ends_keep_their_digits(arguments, expected):
    a, b, x = map(np.array, arguments)
    assert incomplete_beta(a, b, x, 1 - x) == pytest.approx(expected, rel=1e-13)
    assert incomplete_beta(b, a, 1 - x, x) == pytest.approx(1 - expected, rel=1e-13)


@pytest.mark.parametrize(("arguments", "p"), BELOW)
def test_the_inverse_gives_the_number_and_its_complement(arguments, p):
    a, b, x = map(np.array, arguments)
    assert inverse_beta(a, b, np.array(p))[0] == pytest.approx(x, rel=1e-12)
    assert inverse_beta(b, a, np.array(p))[0] == pytest.approx(1 - inverse_beta(b, a, np.array(p))[1], rel=1e-13)


def test_arrays_broadcast():
    a, x = np.array([[1.0], [2.0]]), np.array([0.25, 0.5, 0.75])
    expected = [[0.25, 0.5, 0.75], [0.0625, 0.25, 0.5625]]
    assert incomplete_beta(a, np.array(1.0), x, 1 - x) == pytest.approx(np.array(expected), rel=1e-15)
