from __future__ import annotations

import math

import pytest

from xlmc.errors import ErrorCode

DIV0, NUM, VALUE = ErrorCode.DIV0, ErrorCode.NUM, ErrorCode.VALUE

TABLE = [
    ("ACOT", (2,), math.atan(0.5)),
    ("ACOT", (0,), math.pi / 2),
    ("ACOT", (-1,), 3 * math.pi / 4),
    ("ACOT", (1e9,), 1e-9),
    ("ACOT", (-1e300,), math.pi),
    ("ACOT", ("x",), VALUE),
    ("ACOTH", (6,), math.log(7 / 5) / 2),
    ("ACOTH", (-2,), -math.log(3) / 2),
    ("ACOTH", (1e100,), 1e-100),
    ("ACOTH", (1,), NUM),
    ("ACOTH", (-0.5,), NUM),
    ("ACOTH", (None,), NUM),
    ("COTH", (2,), math.cosh(2) / math.sinh(2)),
    ("COTH", (-1e-10,), -1e10),
    ("COTH", (1000,), 1),
    ("COTH", (0,), DIV0),
    ("SECH", (0,), 1),
    ("SECH", (-3,), 1 / math.cosh(3)),
    ("SECH", (1e100,), 0),
    ("SECH", (709,), 1 / math.cosh(709)),
    ("CSCH", (1.5,), 1 / math.sinh(1.5)),
    ("CSCH", (-1e-9,), -1e9),
    ("CSCH", (0,), DIV0),
    ("CSCH", (-800,), 0),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-14)


def test_examples_of_excels_help(evaluate):
    assert evaluate("ACOT", 2) == pytest.approx(0.4636, abs=5e-5)
    assert evaluate("ACOTH", 6) == pytest.approx(0.168, abs=5e-4)
    assert evaluate("COTH", 2) == pytest.approx(1.0373, abs=5e-5)
    assert evaluate("CSCH", 1.5) == pytest.approx(0.4696, abs=5e-5)
    assert evaluate("SECH", 45) == pytest.approx(5.73e-20, rel=1e-3)
