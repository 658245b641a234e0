from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode

NUM, VALUE, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

TABLE = [
    ("ERF", (0,), 0),
    ("ERF", (1,), 0.8427007929497148693),
    ("ERF", (-1,), -0.8427007929497148693),
    ("ERF", (0, 1), 0.8427007929497148693),
    ("ERF", (1, 0), -0.8427007929497148693),
    ("ERF", (-1, 1), 2 * 0.8427007929497148693),
    ("ERF", (1, 2), 0.1526214720692377843),
    ("ERF", (-2, -1), 0.1526214720692377843),
    ("ERF", (5, 6), 1.5374597944280348502e-12 - 2.1519736712498913117e-17),
    ("ERF", (3, 3), 0),
    ("ERF", (1, None), -0.8427007929497148693),
    ("ERF", ("1",), 0.8427007929497148693),
    ("ERF", ("x",), VALUE),
    ("ERF", (1, NA), NA),
    ("ERF.PRECISE", (0.5,), 0.5204998778130465377),
    ("ERFC", (1,), 0.1572992070502851307),
    ("ERFC", (-1,), 1.8427007929497148693),
    ("ERFC", (5,), 1.5374597944280348502e-12),
    ("ERFC", (26,), 5.6631924088561428464e-296),
    ("ERFC.PRECISE", (1,), 0.1572992070502851307),
    ("BESSELJ", (1, 0), 0.7651976865579665514),
    ("BESSELJ", (1, 1.9), 0.4400505857449335160),
    ("BESSELJ", (-1, 1), -0.4400505857449335160),
    ("BESSELJ", (0, 0), 1),
    ("BESSELJ", (0, 3), 0),
    ("BESSELJ", (1, -1), NUM),
    ("BESSELJ", (1, -0.5), 0.7651976865579665514),
    ("BESSELJ", ("x", 1), VALUE),
    ("BESSELI", (1, 0), 1.2660658777520083356),
    ("BESSELI", (-1, 1), -0.5651591039924850272),
    ("BESSELI", (1, -1), NUM),
    ("BESSELI", (1000, 0), NUM),
    ("BESSELY", (1, 0), 0.0882569642156769579),
    ("BESSELY", (1, 1), -0.7812128213002887165),
    ("BESSELY", (0, 0), NUM),
    ("BESSELY", (-1, 0), NUM),
    ("BESSELY", (1, -1), NUM),
    ("BESSELK", (1, 0), 0.4210244382407083333),
    ("BESSELK", (1, 1), 0.6019072301972345747),
    ("BESSELK", (0, 0), NUM),
    ("BESSELK", (1, -1), NUM),
    ("BESSELK", (NA, -1), NA),
    ("DELTA", (5, 4), 0),
    ("DELTA", (5, 5), 1),
    ("DELTA", (0.5, 0), 0),
    ("DELTA", (0,), 1),
    ("DELTA", ("5", 5), 1),
    ("DELTA", ("x", 5), VALUE),
    ("GESTEP", (5, 4), 1),
    ("GESTEP", (5, 5), 1),
    ("GESTEP", (-4, -5), 1),
    ("GESTEP", (-1,), 0),
    ("GESTEP", (None, "0"), 1),
    ("GESTEP", (1, "x"), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=2e-15)


@pytest.mark.parametrize(
    ("name", "arguments", "expected"),
    [("BESSELI", (1.5, 1), 0.981666428), ("BESSELK", (1.5, 1), 0.277387804), ("BESSELY", (2.5, 1), 0.145918138)],
)
def test_examples_of_excels_help(evaluate, name, arguments, expected):
    assert evaluate(name, *arguments) == pytest.approx(expected, abs=5e-9)


@given(st.floats(0.1, 60), st.integers(0, 12))
@settings(max_examples=100, deadline=None)
def test_wronskians(evaluate, x, n):
    """J and Y, I and K together know 2/πx and 1/x."""
    j, y, i, k = (
        [evaluate(name, x, order) for order in (n, n + 1)] for name in ("BESSELJ", "BESSELY", "BESSELI", "BESSELK")
    )
    assert j[1] * y[0] - j[0] * y[1] == pytest.approx(2 / (math.pi * x), rel=1e-9)
    assert i[0] * k[1] + i[1] * k[0] == pytest.approx(1 / x, rel=1e-9)


@given(st.floats(-6, 6), st.floats(-6, 6))
@settings(max_examples=100, deadline=None)
def test_growth_of_the_error_function(evaluate, lower, upper):
    assert evaluate("ERF", lower, upper) == pytest.approx(math.erf(upper) - math.erf(lower), rel=1e-12, abs=5e-16)
    assert evaluate("ERF", lower, upper) == -evaluate("ERF", upper, lower)
