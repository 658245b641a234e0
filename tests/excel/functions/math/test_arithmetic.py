from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.math.arithmetic import raise_to_power

DIV0, NUM, VALUE, NA = ErrorCode.DIV0, ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

EXACT = [
    ("ABS", (-4,), 4),
    ("ABS", (0,), 0),
    ("ABS", ("-2.5",), 2.5),
    ("SIGN", (10,), 1),
    ("SIGN", (-1e-300,), -1),
    ("SIGN", (0,), 0),
    ("SQRT", (16,), 4),
    ("SQRT", (-16,), NUM),
    ("SQRT", (True,), 1),
    ("SQRT", (None,), 0),
    ("SQRT", ("four",), VALUE),
    ("SQRTPI", (0,), 0),
    ("SQRTPI", (-1,), NUM),
    ("EXP", (0,), 1),
    ("EXP", (710,), NUM),
    ("EXP", (-800,), 0),
    ("LN", (1,), 0),
    ("LN", (0,), NUM),
    ("LN", (-1,), NUM),
    ("LN", (None,), NUM),
    ("LOG10", (1e5,), 5),
    ("LOG10", (0,), NUM),
    ("LOG10", (NA,), NA),
    ("LOG", (1000,), 3),
    ("LOG", (1e-7,), -7),
    ("LOG", (8, 2), 3),
    ("LOG", (2**-40, 2), -40),
    ("LOG", (10, 1), DIV0),
    ("LOG", (10, 0), NUM),
    ("LOG", (10, -2), NUM),
    ("LOG", (0, 1), NUM),
    ("LOG", (0,), NUM),
    ("LOG", (10, None), NUM),
    ("MOD", (3, 2), 1),
    ("MOD", (-3, 2), 1),
    ("MOD", (3, -2), -1),
    ("MOD", (-3, -2), -1),
    ("MOD", (3, 0), DIV0),
    ("MOD", (0, 0), DIV0),
    ("MOD", ("23", "3"), 2),
    ("MOD", (3, NA), NA),
    ("MOD", (0.9, 0.3), 2.0**-54),
    ("QUOTIENT", (5, 2), 2),
    ("QUOTIENT", (4.5, 3.1), 1),
    ("QUOTIENT", (-10, 3), -3),
    ("QUOTIENT", (1, 0), DIV0),
    ("FACT", (5,), 120),
    ("FACT", (1.9,), 1),
    ("FACT", (0,), 1),
    ("FACT", (-1,), NUM),
    ("FACT", (170,), float(math.factorial(170))),
    ("FACT", (171,), NUM),
    ("FACT", (1e300,), NUM),
    ("FACT", ("abc",), VALUE),
    ("POWER", (5, 2), 25),
    ("POWER", (0, 0), NUM),
    ("POWER", (0, -1), DIV0),
    ("POWER", (-8, 1 / 3), NUM),
    ("SUMSQ", (3, 4), 25),
    ("SUMSQ", ("3", True), 10),
    ("SUMSQ", ([["3", True, None, 2]],), 4),
    ("SUMSQ", ([[2, DIV0]], NA), DIV0),
]

ROUNDED = [
    ("EXP", (1,), math.e),
    ("EXP", (-3.25,), math.exp(-3.25)),
    ("LN", (86,), math.log(86)),
    ("LN", (1e-300,), math.log(1e-300)),
    ("LOG10", (86,), math.log10(86)),
    ("LOG", (86, math.e), math.log(86)),
    ("LOG", (100, 0.1), -2.0),
    ("LOG", (81, 3), 4.0),
    ("SQRTPI", (2,), math.sqrt(2 * math.pi)),
    ("POWER", (98.6, 3.2), 98.6**3.2),
    ("POWER", (4, 1.25), 4**1.25),
    ("MOD", (281.44, 0.02), math.fmod(281.44, 0.02)),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), EXACT)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected)


@pytest.mark.parametrize(("name", "arguments", "expected"), ROUNDED)
def test_table_of_rounded_results(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-15)


@pytest.mark.parametrize("n", range(171))
def test_every_factorial(check, n):
    check("FACT", (n,), float(math.factorial(n)))


@pytest.mark.parametrize(("dividend", "divisor"), [(10, 0.1), (15 * (1.4 - 1), 6), ((1.2 - 1) / 0.2, 1)])
def test_mod_takes_the_doubles_as_they_are(evaluate, dividend, divisor):
    """Excel since 2010 answers all but the whole divisor here, where a decimal remainder would be 0."""
    assert evaluate("MOD", dividend, divisor) == pytest.approx(divisor, rel=1e-14)


@pytest.mark.parametrize("exponent", [2.0, 0.5, -1.0, 3.0])
def test_the_same_to_the_bit_for_one_trial_and_for_many(exponent):
    base = np.random.default_rng(1).uniform(0.1, 3, 1000)
    exponents = np.where(np.arange(1000) == 0, 7.1, exponent)
    together = raise_to_power(base, exponents)
    assert raise_to_power(base[1:], np.array([exponent])).tolist() == together[1:].tolist()
    assert raise_to_power(base[1:], exponent).tolist() == together[1:].tolist()
    assert all(raise_to_power(base[i : i + 1], exponents[i : i + 1])[0] == together[i] for i in range(1000))
    assert all(raise_to_power(float(base[i]), float(exponents[i]))[0] == together[i] for i in range(1000))
