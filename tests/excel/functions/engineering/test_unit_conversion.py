from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.engineering import unit_conversion
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


IN_BASE = {
    "g": "g 1, sg 14593.902937206364, lbm 453.59237, u 1.660538782e-24, ozm 28.349523125, grain 0.06479891, "
    "cwt shweight 45359.237, uk_cwt lcwt hweight 50802.34544, stone 6350.29318, ton 907184.74, "
    "uk_ton LTON brton 1016046.9088",
    "m": "m 1, mi 1609.344, Nmi 1852, in 0.0254, ft 0.3048, yd 0.9144, ang 1e-10, ell 1.143, ly 9460730472580800, "
    "parsec pc 30856775812815500, Picapt Pica 0.0003527777777777778, pica 0.004233333333333333, "
    "survey_mi 1609.3472186944373",
    "sec": "yr 31557600, day d 86400, hr 3600, mn min 60, sec s 1",
    "Pa": "Pa p 1, atm at 101325, mmHg 133.322, psi 6894.757293168362, Torr 133.32236842105263",
    "N": "N 1, dyn dy 1e-5, lbf 4.4482216152605, pond 0.00980665",
    "J": "J 1, e 1e-7, c 4.184, cal 4.1868, eV ev 1.602176487e-19, HPh hh 2684519.5376961729, Wh wh 3600, "
    "flb 1.3558179483314004, BTU btu 1055.05585262",
    "W": "HP h 745.6998715822702, W w 1, PS 735.49875",
    "T": "T 1, ga 0.0001",
    "m3": "tsp 4.92892159375e-6, tspm 5e-6, tbs 1.478676478125e-5, oz 2.95735295625e-5, cup 0.0002365882365, "
    "pt us_pt 0.000473176473, uk_pt 0.00056826125, qt 0.000946352946, uk_qt 0.0011365225, gal 0.003785411784, "
    "uk_gal 0.00454609, l L lt 0.001, ang3 ang^3 1e-30, barrel 0.158987294928, bushel 0.03523907016688, "
    "ft3 ft^3 0.028316846592, in3 in^3 1.6387064e-5, ly3 ly^3 8.467866646237151e47, m3 m^3 1, "
    "mi3 mi^3 4168181825.440579584, yd3 yd^3 0.764554857984, Nmi3 Nmi^3 6352182208, "
    "Picapt3 Picapt^3 Pica3 Pica^3 4.390395661865569e-11, GRT regton 2.8316846592, MTON 1.13267386368",
    "m2": "uk_acre 4046.8564224, us_acre 4046.8726098742523, ang2 ang^2 1e-20, ar 100, ft2 ft^2 0.09290304, ha 10000, "
    "in2 in^2 0.00064516, ly2 ly^2 8.950542107481892e31, m2 m^2 1, Morgen 2500, mi2 mi^2 2589988.110336, "
    "Nmi2 Nmi^2 3429904, Picapt2 Picapt^2 Pica2 Pica^2 1.2445216049382716e-7, yd2 yd^2 0.83612736",
    "bit": "bit 1, byte 8",
    "m/s": "admkn 0.5147733333333333, kn 0.5144444444444445, m/h m/hr 0.0002777777777777778, m/s m/sec 1, mph 0.44704",
}
"""Unit -> names of units of its kind, and how much of it they are: NIST SP 811, Excel's page of CONVERT."""

PREFIXES = (
    "Y 1e24, Z 1e21, E 1e18, P 1e15, T 1e12, G 1e9, M 1e6, k 1000, h 100, da 10, e 10, d 0.1, c 0.01, m 0.001, u 1e-6, "
    "n 1e-9, p 1e-12, f 1e-15, a 1e-18, z 1e-21, y 1e-24"
)
BINARY = "ki 1024, Mi 1048576, Gi 1073741824, Ti 1.099511627776e12, Pi 1.125899906842624e15, Ei 1.152921504606847e18, "
BINARY += "Zi 1.1805916207174113e21, Yi 1.2089258196146292e24"


def test_every_unit_is_as_much_of_its_base_as_it_is():
    wanted, result = {}, {}
    for base, rows in IN_BASE.items():
        for row in rows.split(", "):
            *names, factor = row.split()
            wanted |= dict.fromkeys(names, float(factor))
            result |= {name: _converted(name, base) for name in names}
    assert result == pytest.approx(wanted, rel=1e-14, abs=0)
    assert wanted.keys() == unit_conversion._UNITS.keys() - unit_conversion._TEMPERATURES.keys()


@pytest.mark.parametrize(
    ("listed", "base", "power", "known"),
    [
        (PREFIXES, "m", 1, unit_conversion._PREFIXES),
        (PREFIXES, "m2", 2, unit_conversion._PREFIXES),
        (PREFIXES, "m^3", 3, unit_conversion._PREFIXES),
        (BINARY, "bit", 1, unit_conversion._BINARY_PREFIXES),
    ],
)
def test_every_prefix_is_as_much_as_it_is(listed, base, power, known):
    wanted = {prefix: float(factor) ** power for prefix, factor in (row.split() for row in listed.split(", "))}
    assert {prefix: _converted(f"{prefix}{base}", base) for prefix in wanted} == pytest.approx(wanted, rel=1e-13, abs=0)
    assert wanted.keys() == known.keys()


def _converted(unit, base):
    """How much of a base unit one of a unit is."""
    (result,) = function_named("CONVERT")([constant(1.0), constant(unit), constant(base)]).numbers
    return float(result)


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
    result = function_named("CONVERT")([Value.of_numbers(np.array([100.0, 2.0, 3.0])), units, constant("m")])
    assert result.objects().tolist() == [1.0, 2000.0, NA]


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
