from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.engineering.unit_conversion import unit_named
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value, constant, from_objects

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


EXCEL = {  # as Excel's help and tables of its constants have them
    "sg": 14593.9029372064,
    "grain": 0.06479891,
    "ozm": 28.349523125,
    "stone": 6350.29318,
    "ton": 907184.74,
    "uk_ton": 1016046.9088,
    "uk_cwt": 50802.34544,
    "survey_mi": 1609.34721869444,
    "ell": 1.143,
    "psi": 6894.75729316836,
    "Torr": 133.322368421053,
    "HPh": 2684519.53769617,
    "flb": 1.3558179483314,
    "HP": 745.69987158227,
    "tsp": 0.00000492892159375,
    "gal": 0.003785411784,
    "barrel": 0.158987294928,
    "us_acre": 4046.87260987425,
    "uk_acre": 4046.8564224,
    "GRT": 2.8316846592,
    "MTON": 1.13267386368,
    "ly3": 8.46786664623715e47,
    "Nmi3": 6352182208.0,
    "Picapt2": 0.000000124452160493827,
    "Pica3": 4.39039566186557e-11,
    "pica": 0.00423333333333333,
    "admkn": 0.514773333333333,
    "kn": 0.514444444444444,
    "mph": 0.44704,
}


@pytest.mark.parametrize("name", EXCEL)
def test_scales(name):
    assert unit_named(name).scale == pytest.approx(EXCEL[name], rel=1e-14)


@pytest.mark.parametrize(
    ("name", "group", "prefix"),
    [
        ("kg", "mass", 1e3),
        ("um", "length", 1e-6),
        ("dam", "length", 10.0),
        ("em", "length", 10.0),
        ("dm", "length", 0.1),
        ("mmHg", "pressure", 1.0),
        ("mmmHg", "pressure", 1e-3),
        ("min", "time", 1.0),
        ("ms", "time", 1e-3),
        ("pc", "length", 1.0),
        ("Mpc", "length", 1e6),
        ("cal", "energy", 1.0),
        ("kcal", "energy", 1e3),
        ("km/h", "speed", 1e3),
        ("km2", "area", 1e6),
        ("cm^3", "volume", pytest.approx(1e-6)),
        ("dal", "volume", 10.0),
        ("ml", "volume", 1e-3),
        ("mK", "temperature", 1e-3),
        ("Mibit", "information", 2.0**20),
        ("Yibyte", "information", 2.0**80),
        ("Mbit", "information", 1e6),
    ],
)
def test_prefixes(name, group, prefix):
    unit = unit_named(name)
    assert (unit.group, unit.prefix) == (group, prefix)


@pytest.mark.parametrize(
    "name", ["", "xyz", "M", "Kg", "kft", "kim", "dasg", "kC", "kha", "kk", "kkm", "mM", "M2", "FT"]
)
def test_what_is_no_unit(name):
    assert unit_named(name) is None


@pytest.mark.parametrize(
    "names",
    ["cwt shweight", "uk_cwt lcwt hweight", "LTON uk_ton brton", "day d", "mn min", "at atm", "eV ev", "HPh hh", "W w"],
)
def test_names_of_one_unit(names):
    assert len({unit_named(name) for name in names.split()}) == 1
