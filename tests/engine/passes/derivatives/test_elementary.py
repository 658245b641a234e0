"""The rules of elementary functions against mpmath's derivatives, at points on each side of where they bend."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from xlmc.engine.passes.derivatives.rules import RULES
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.fifteen_digits import SNAP_TO_ZERO

ONE = {
    "u-": (lambda x: -x, (-1.7, 0.0)),
    "%": (lambda x: x / 100, (3.0,)),
    "SQRT": (mpmath.sqrt, (0.3, 4.0)),
    "SQRTPI": (lambda x: mpmath.sqrt(mpmath.pi * x), (0.3, 4.0)),
    "EXP": (mpmath.exp, (-1.3, 2.0)),
    "LN": (mpmath.log, (0.3, 4.0)),
    "LOG10": (mpmath.log10, (0.3, 4.0)),
    "SIN": (mpmath.sin, (0.7, -2.0)),
    "COS": (mpmath.cos, (0.7, -2.0)),
    "TAN": (mpmath.tan, (0.7, -1.2)),
    "SEC": (mpmath.sec, (0.7, -1.2)),
    "CSC": (mpmath.csc, (0.7, 2.0)),
    "COT": (mpmath.cot, (0.7, 2.0)),
    "ASIN": (mpmath.asin, (0.3, -0.8)),
    "ACOS": (mpmath.acos, (0.3, -0.8)),
    "ATAN": (mpmath.atan, (0.3, -2.0)),
    "ACOT": (lambda x: mpmath.pi / 2 - mpmath.atan(x), (0.3, -2.0)),
    "SINH": (mpmath.sinh, (0.3, -2.0)),
    "COSH": (mpmath.cosh, (0.3, -2.0)),
    "TANH": (mpmath.tanh, (0.3, -2.0)),
    "SECH": (mpmath.sech, (0.3, -2.0)),
    "CSCH": (mpmath.csch, (0.3, -2.0)),
    "COTH": (mpmath.coth, (0.3, -2.0)),
    "ASINH": (mpmath.asinh, (0.3, -2.0)),
    "ACOSH": (mpmath.acosh, (1.3, 4.0)),
    "ATANH": (mpmath.atanh, (0.3, -0.8)),
    "ACOTH": (mpmath.acoth, (1.3, -4.0)),
    "FISHER": (mpmath.atanh, (0.3, -0.8)),
    "FISHERINV": (mpmath.tanh, (0.3, -2.0)),
    "ABS": (abs, (0.3, -2.0)),
    "LOG": (mpmath.log10, (0.3, 4.0)),
}

TWO = {
    "+": (lambda x, y: x + y, [(1.5, -2.0)]),
    "-": (lambda x, y: x - y, [(1.5, -2.0)]),
    "*": (lambda x, y: x * y, [(1.5, -2.0)]),
    "/": (lambda x, y: x / y, [(1.5, -2.0), (-0.7, 0.3)]),
    "^": (lambda x, y: x**y, [(1.5, -2.5), (0.7, 3.3), (1.3, 1.2), (2.0, 0.5)]),
    "LOG": (lambda x, y: mpmath.log(x) / mpmath.log(y), [(1.5, 3.0), (0.2, 0.7)]),
    "ATAN2": (lambda x, y: mpmath.atan2(y, x), [(1.5, -2.0), (-0.7, 0.3), (-0.7, -1.3), (0.4, 0.9)]),
}


@pytest.mark.parametrize(("name", "x"), [(name, x) for name, (_, points) in ONE.items() for x in points])
def test_one_argument(outcome_of, same_derivatives, name, x):
    same_derivatives(outcome_of(name, x).jet, ONE[name][0], (x,))


@pytest.mark.parametrize(("name", "point"), [(name, point) for name, (_, points) in TWO.items() for point in points])
def test_two_arguments(outcome_of, same_derivatives, name, point):
    same_derivatives(outcome_of(name, *point).jet, TWO[name][0], point)


@pytest.mark.parametrize("x", [-1.5, 0.0, 2.0])
@pytest.mark.parametrize("p", [0.0, 1.0, 2.0, 3.0, 5.0])
def test_whole_powers_of_any_base(outcome_of, x, p):
    """px^(p-1) and p(p-1)x^(p-2): 0 where the factor is 0, also at the base 0."""
    jet = outcome_of("^", x, p, still=(1,)).jet
    assert jet.active == (0,)
    assert jet.first[0, 0] == (0.0 if p == 0 else p * x ** (p - 1))
    assert jet.second[0, 0, 0] == (0.0 if p < 2 else p * (p - 1) * x ** (p - 2))


@pytest.mark.parametrize("x", [-1.5, 0.0])
def test_an_exponent_that_varies_needs_a_base_above_0(outcome_of, x):
    assert np.isnan(outcome_of("^", x, 2.0).jet.first).all()


def test_a_power_of_0_of_a_base_that_varies_with_it(outcome_of):
    """The logarithm of the base is the derivative by the exponent; the one by the base is 0."""
    jet = outcome_of("^", 3.0, 0.0).jet
    assert jet.first[:, 0] == pytest.approx([0.0, np.log(3.0)])
    assert jet.second[:, :, 0] == pytest.approx(np.array([[0.0, 1 / 3], [1 / 3, np.log(3.0) ** 2]]))


def test_an_angle_jumps_on_the_negative_axis_alone(outcome_of):
    assert np.isnan(outcome_of("ATAN2", -2.0, 0.0, still=(0,)).jet.first).all()
    assert outcome_of("ATAN2", -2.0, 0.0, still=(1,)).jet.first.tolist() == [[0.0]]
    positive = outcome_of("ATAN2", 0.5, 0.0).jet
    assert positive.first[:, 0].tolist() == [0.0, 2.0]
    upward = outcome_of("ATAN2", 0.0, 2.0).jet
    assert upward.first[:, 0].tolist() == [-0.5, 0.0]


def test_branches_of_the_angle(outcome_of):
    x, y = np.array([-1.0, -1.0, -1.0, 0.0, 1.0, 1.0]), np.array([-2.0, 0.0, 2.0, -2.0, -2.0, 2.0])
    assert outcome_of("ATAN2", x, y).branches.tolist() == [-1, 1, 1, 0, 0, 0]
    assert outcome_of("ABS", np.array([-2.0, 0.0, 3.0])).branches.tolist() == [-1, 0, 1]


def test_an_absolute_value_has_no_derivative_at_0(outcome_of):
    jet = outcome_of("ABS", np.array([0.0, 2.0])).jet
    assert np.isnan(jet.first[0, 0])
    assert np.isnan(jet.second[0, 0, 0])
    assert jet.first[0, 1] == 1.0


@pytest.mark.parametrize(
    ("x", "divisor", "by_divisor"), [(7.5, 2.0, -3.0), (-7.5, 2.0, 4.0), (7.5, -2.0, 4.0), (1.5, 2.0, 0.0)]
)
def test_a_remainder_moves_with_the_whole_part(outcome_of, x, divisor, by_divisor):
    outcome = outcome_of("MOD", x, divisor)
    assert outcome.jet.first[:, 0].tolist() == [1.0, by_divisor]
    assert not outcome.jet.second.any()
    assert outcome.branches.tolist() == [-by_divisor]


def test_a_remainder_of_0_jumps(outcome_of):
    jet = outcome_of("MOD", np.array([8.0, 7.0]), 2.0).jet
    assert np.isnan(jet.first[:, 0]).all()
    assert jet.first[:, 1].tolist() == [1.0, -3.0]


@pytest.mark.parametrize("name", [REGISTRY["u+"], SNAP_TO_ZERO])
def test_numbers_given_unchanged(outcome_of, name):
    assert outcome_of(name, *[2.5, 1.0, 1.0][: len(name.parameters)]).jet.first.tolist() == [[1.0]]


@pytest.mark.parametrize(
    ("name", "jumps"), [("ATAN2", True), ("MOD", True), ("ABS", False), ("SQRT", False), ("^", False), ("+", False)]
)
def test_which_jump(name, jumps):
    assert RULES[name].jumps is jumps
