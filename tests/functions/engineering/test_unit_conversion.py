from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.functions.families import function_named
from xlmc.functions.values import Value, constant, from_objects

VALUE, NA, DIV0 = ErrorCode.VALUE, ErrorCode.NA, ErrorCode.DIV0

TABLE = [
    ((1, "lbm", "kg"), 0.45359237),
    ((68, "F", "C"), 20),
    ((2.5, "ft", "sec"), NA),
    ((100, "ft", "m"), 30.48),
    ((6, "tsp", "tbs"), 2),
    ((6, "gal", "l"), 22.712470704),
    ((6, "mi", "km"), 9.656064),
    ((6, "km", "mi"), 3.728227153424),
    ((6, "in", "ft"), 0.5),
    ((6, "cm", "in"), 2.36220472440945),
    ((100, "km/h", "mph"), 62.1371192237334),
    ((1, "m2", "mm2"), 1e6),
    ((1, "km3", "m3"), 1e9),
    ((16, "bit", "byte"), 2),
    ((1, "kibyte", "bit"), 8192),
    ((2, "Gibit", "Mibyte"), 256),
    ((100, "hl", "dal"), 1000),
    ((3, "mmHg", "Torr"), 3 * 133.322 * 760 / 101325),
    ((1, "yr", "day"), 365.25),
    ((1, "N", "lbf"), 0.224808943099711),
    ((1, "T", "ga"), 10000),
    ((0, "C", "K"), 273.15),
    ((0, "K", "C"), -273.15),
    ((0, "K", "F"), -459.67),
    ((100, "C", "Rank"), 671.67),
    ((100, "C", "Reau"), 80),
    ((-40, "fah", "cel"), -40),
    ((1941, "K", "Reau"), 1334.28),
    ((1, "kK", "C"), 726.85),
    (("2", "m", "cm"), 200),
    ((None, "m", "cm"), 0),
    ((1, "m", "M"), NA),
    ((1, "", ""), NA),
    ((1, None, "m"), NA),
    ((1, 5, "m"), NA),
    ((1, "kpt", "lt"), NA),
    (("three", "ft", "yds"), VALUE),
    ((DIV0, NA, "m"), DIV0),
    ((1, "m", DIV0), DIV0),
]


@pytest.mark.parametrize(("arguments", "expected"), TABLE)
def test_table(check, arguments, expected):
    check("CONVERT", arguments, expected, rel=1e-14)


UNITS = ["g", "lbm", "m", "mi", "parsec", "hr", "psi", "dyn", "BTU", "PS", "ga", "F", "K", "Rank", "bushel", "ha", "kn"]


@pytest.mark.parametrize("unit", UNITS)
@given(x=st.floats(-1e6, 1e6))
@settings(max_examples=30, deadline=None)
def test_there_and_back(evaluate, unit, x):
    others = [other for other in UNITS if evaluate("CONVERT", 1, unit, other) is not NA]
    for other in others:
        there = evaluate("CONVERT", x, unit, other)
        assert evaluate("CONVERT", there, other, unit) == pytest.approx(x, rel=1e-12, abs=1e-9)


def test_units_may_differ_between_trials():
    units = from_objects(np.array(["cm", "km", "s"], object))
    found = function_named("CONVERT")([Value.of_numbers(np.array([100.0, 2.0, 3.0])), units, constant("m")])
    assert found.objects().tolist() == [1.0, 2000.0, NA]
