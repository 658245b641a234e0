"""Expected values of functions are those of Excel's help, to the digits that Excel shows today."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.engineering.complex_numbers import common_suffix, read, write
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import constant, from_objects

NUM, VALUE = ErrorCode.NUM, ErrorCode.VALUE

READ = [
    ("3+4i", (3 + 4j, "i")),
    ("3-4j", (3 - 4j, "j")),
    ("-2.5", (-2.5 + 0j, "")),
    ("+7", (7 + 0j, "")),
    ("i", (1j, "i")),
    ("-j", (-1j, "j")),
    ("+i", (1j, "i")),
    ("2i", (2j, "i")),
    ("0-j", (-1j, "j")),
    (".5-.25i", (0.5 - 0.25j, "i")),
    ("5.+1.i", (5 + 1j, "i")),
    ("1.5e2+2.5E-3i", (150 + 0.0025j, "i")),
    ("-1e+2-1e-2j", (-100 - 0.01j, "j")),
    (2.0, (2 + 0j, "")),
    ("", (0j, "")),
    (None, (0j, "")),
    (True, VALUE),
    ("abc", NUM),
    ("3+4I", NUM),
    ("3+4k", NUM),
    ("3i4", NUM),
    ("3++4i", NUM),
    ("3 4i", NUM),
    ("3 + 4i", NUM),
    ("i+3", NUM),
    ("3+", NUM),
    ("ii", NUM),
    ("--1", NUM),
    ("e5", NUM),
    ("1e400", NUM),
    ("1e400i", NUM),
    ("٣", NUM),
]


@pytest.mark.parametrize(("item", "expected"), READ)
def test_read(item, expected):
    assert read(item) == expected


WRITTEN = [
    ((0j, ""), "0"),
    ((complex(-0.0, -0.0), "i"), "0"),
    ((3 + 4j, "i"), "3+4i"),
    ((3 - 4j, "j"), "3-4j"),
    ((1j, "j"), "j"),
    ((-1j, ""), "-i"),
    ((2 + 1j, "i"), "2+i"),
    ((2 - 1j, "i"), "2-i"),
    ((5 + 0j, "i"), "5"),
    ((0.1 + 0.2 + 0j, "i"), "0.3"),
    ((complex(0, math.nextafter(1, 0)), "j"), "j"),
    ((complex(7.75702968155393e-18, -0.9999999999999999), "j"), "7.75702968155393E-18-j"),
    ((complex(2.57039272660676e-21, 1), "i"), "2.57039272660676E-21+i"),
    ((complex(8.98347764697156e-05, 1.00001320743478), "i"), "0.0000898347764697156+1.00001320743478i"),
    ((complex(-1.6343988925314e-08, -0.999999974296243), "i"), "-1.6343988925314E-08-0.999999974296243i"),
    ((1e-19 + 0j, "i"), "0.0000000000000000001"),
    ((1e-20 + 0j, "i"), "1E-20"),
    ((1e20 + 0j, "i"), "100000000000000000000"),
    ((1e21 + 0j, "i"), "1E+21"),
    ((1.5e300 - 2.5e-300j, "i"), "1.5E+300-2.5E-300i"),
    ((1e-7j, "i"), "0.0000001i"),
    ((complex(math.inf, 1), "i"), NUM),
    ((complex(1, math.nan), "i"), NUM),
]


@pytest.mark.parametrize(("number", "expected"), WRITTEN)
def test_write(number, expected):
    assert write(*number) == expected


parts = st.floats(-1e300, 1e300, allow_subnormal=False)


@given(parts, parts, st.sampled_from("ij"))
@settings(max_examples=300, deadline=None)
def test_what_is_written_reads_as_itself_to_15_digits(x, y, suffix):
    text = write(complex(x, y), suffix)
    number, result = read(text)
    assert math.isclose(number.real, x, rel_tol=1e-14, abs_tol=1e-300)
    assert math.isclose(number.imag, y, rel_tol=1e-14, abs_tol=1e-300)
    assert result == (suffix if y else "")
    assert write(number, suffix) == text


@pytest.mark.parametrize(
    ("suffixes", "expected"),
    [(("i", "i"), "i"), (("", "j"), "j"), (("", ""), ""), (("i", "j"), VALUE), (("j", "", "i"), VALUE), ((), "")],
)
def test_common_suffix(suffixes, expected):
    assert common_suffix(*suffixes) == expected


DIV0, NUM_OF_COMPLEX_FUNCTIONS, VALUE_OF_COMPLEX_FUNCTIONS, NA = (
    ErrorCode.DIV0,
    ErrorCode.NUM,
    ErrorCode.VALUE,
    ErrorCode.NA,
)

TABLE = [
    ("COMPLEX", (3, 4), "3+4i"),
    ("COMPLEX", (3, 4, "j"), "3+4j"),
    ("COMPLEX", (0, 1), "i"),
    ("COMPLEX", (1, 0), "1"),
    ("COMPLEX", (1, -1), "1-i"),
    ("COMPLEX", ("1.5", None, ""), "1.5"),
    ("COMPLEX", (3, 4, "I"), VALUE_OF_COMPLEX_FUNCTIONS),
    ("COMPLEX", (3, 4, 5), VALUE_OF_COMPLEX_FUNCTIONS),
    ("COMPLEX", ("x", 4), VALUE_OF_COMPLEX_FUNCTIONS),
    ("COMPLEX", (3, "x"), VALUE_OF_COMPLEX_FUNCTIONS),
    ("COMPLEX", (NA, "x", "k"), NA),
    ("IMREAL", ("6-9i",), 6),
    ("IMREAL", ("i",), 0),
    ("IMREAL", (4,), 4),
    ("IMREAL", ("x",), NUM_OF_COMPLEX_FUNCTIONS),
    ("IMREAL", (None,), 0),
    ("IMAGINARY", ("3+4i",), 4),
    ("IMAGINARY", ("0-j",), -1),
    ("IMAGINARY", (4,), 0),
    ("IMABS", ("5+12i",), 13),
    ("IMABS", ("3e200+4e200i",), 5e200),
    ("IMARGUMENT", ("-1",), cmath.pi),
    ("IMARGUMENT", (0,), DIV0),
    ("IMARGUMENT", ("0j",), DIV0),
    ("IMCONJUGATE", ("3+4i",), "3-4i"),
    ("IMCONJUGATE", ("12.7-32j",), "12.7+32j"),
    ("IMCOS", ("1+i",), "0.833730025131149-0.988897705762865i"),
    ("IMCOS", ("4+3i",), "-6.58066304055116+7.58155274274654i"),
    ("IMSIN", ("4+3i",), "-7.61923172032141-6.548120040911i"),
    ("IMTAN", ("4+3i",), "0.00490825806749606+1.00070953606723i"),
    ("IMSEC", ("4+3i",), "-0.065294027857947-0.0752249603027732i"),
    ("IMCSC", ("4+3i",), "-0.0754898329158637+0.0648774713706355i"),
    ("IMCOT", ("4+3i",), "0.00490118239430447-0.999266927805902i"),
    ("IMCOT", ("2-i",), "-0.171383612909185+0.821329797493852i"),
    ("IMCOT", (0.5,), "1.83048772171245"),
    ("IMSINH", ("4+3i",), "-27.0168132580039+3.85373803791938i"),
    ("IMCOSH", ("4+3i",), "-27.0349456030742+3.85115333481178i"),
    ("IMSECH", ("4+3i",), "-0.0362534969158689-0.00516434460775318i"),
    ("IMCSCH", ("4+3i",), "-0.036275889628626-0.0051744731840194i"),
    ("IMEXP", ("1+i",), "1.46869393991589+2.28735528717884i"),
    ("IMEXP", ("2+4i",), "-4.82980938326939-5.59205609364098i"),
    ("IMEXP", (1000,), NUM_OF_COMPLEX_FUNCTIONS),
    ("IMLN", ("3+4i",), "1.6094379124341+0.927295218001612i"),
    ("IMLN", ("2+4i",), "1.497866136777+1.10714871779409i"),
    ("IMLN", (0,), NUM_OF_COMPLEX_FUNCTIONS),
    ("IMLOG10", ("3+4i",), "0.698970004336019+0.402719196273373i"),
    ("IMLOG10", (100,), "2"),
    ("IMLOG10", ("0",), NUM_OF_COMPLEX_FUNCTIONS),
    ("IMLOG2", ("3+4i",), "2.32192809488736+1.33780421245098i"),
    ("IMLOG2", (8,), "3"),
    ("IMLOG2", (0,), NUM_OF_COMPLEX_FUNCTIONS),
    ("IMSQRT", ("1+i",), "1.09868411346781+0.455089860562227i"),
    ("IMSQRT", ("1+j",), "1.09868411346781+0.455089860562227j"),
    ("IMSQRT", (4,), "2"),
    ("IMSQRT", (0,), "0"),
    ("IMPOWER", ("2+3i", 3), "-46+9.00000000000001i"),
    ("IMPOWER", ("4+3i", 3), "-44+117i"),
    ("IMPOWER", ("2", 10), "1024"),
    ("IMPOWER", (0, 2), "0"),
    ("IMPOWER", (0, 0), NUM_OF_COMPLEX_FUNCTIONS),
    ("IMPOWER", (0, -1), NUM_OF_COMPLEX_FUNCTIONS),
    ("IMPOWER", (10, 400), NUM_OF_COMPLEX_FUNCTIONS),
    ("IMPOWER", ("2+3i", "x"), VALUE_OF_COMPLEX_FUNCTIONS),
    ("IMPOWER", ("x", "x"), NUM_OF_COMPLEX_FUNCTIONS),
    ("IMSUB", ("13+4i", "5+3i"), "8+i"),
    ("IMSUB", (1, "1+j"), "-j"),
    ("IMDIV", ("-238+240i", "10+24i"), "5+12i"),
    ("IMDIV", ("1+i", 0), NUM_OF_COMPLEX_FUNCTIONS),
    ("IMDIV", ("3+4i", "5-3j"), VALUE_OF_COMPLEX_FUNCTIONS),
    ("IMSUM", ("3+4i", "5-3i"), "8+i"),
    ("IMSUM", ("1+j", 5, 6), "12+j"),
    ("IMSUM", ([["1+i", None], [2, ""]],), "3+i"),
    ("IMSUM", ([[None]],), "0"),
    ("IMSUM", ("1+i", "1+j"), VALUE_OF_COMPLEX_FUNCTIONS),
    ("IMSUM", ([["n", 1]],), NUM_OF_COMPLEX_FUNCTIONS),
    ("IMSUM", ([["i", NA]], "x"), NA),
    ("IMPRODUCT", ("3+4i", "5-3i"), "27+11i"),
    ("IMPRODUCT", ("1+2i", 30), "30+60i"),
    ("IMPRODUCT", (2, 3, 4), "24"),
    ("IMPRODUCT", ("1.3-2j", "-3.4+3j", "2.3-6j"), "67.834+15.13j"),
    ("IMPRODUCT", ([["i", "i", None]],), "-1"),
    ("IMPRODUCT", ("1e200", "1e200"), NUM_OF_COMPLEX_FUNCTIONS),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-15)


@pytest.mark.parametrize("name", ["IMCOT", "IMCSC", "IMCSCH"])
def test_poles(check, name):
    check(name, (0,), NUM_OF_COMPLEX_FUNCTIONS)


@pytest.mark.parametrize("name", ["IMSIN", "IMTAN", "IMSECH", "IMLN", "IMSQRT", "IMCONJUGATE"])
def test_what_is_no_complex_number(check, name):
    check(name, ("4+3I",), NUM_OF_COMPLEX_FUNCTIONS)
    check(name, (False,), VALUE_OF_COMPLEX_FUNCTIONS)
    check(name, (DIV0,), DIV0)


coefficients = st.floats(-5, 5).filter(lambda x: abs(x) > 1e-3)


@given(coefficients, coefficients)
@settings(max_examples=100, deadline=None)
@pytest.mark.parametrize(
    ("name", "formula"),
    [
        ("IMSEC", lambda z: 2 / (cmath.exp(1j * z) + cmath.exp(-1j * z))),
        ("IMCSC", lambda z: 2j / (cmath.exp(1j * z) - cmath.exp(-1j * z))),
        ("IMCOT", lambda z: cmath.cos(z) / cmath.sin(z)),
        ("IMSECH", lambda z: 2 / (cmath.exp(z) + cmath.exp(-z))),
        ("IMCSCH", lambda z: 2 / (cmath.exp(z) - cmath.exp(-z))),
        ("IMLOG2", lambda z: cmath.log(z, 2)),
        ("IMSQRT", cmath.sqrt),
    ],
)
def test_functions_are_what_their_formulas_say(evaluate, name, formula, x, y):
    argument = write(complex(x, y), "i")
    (result, _), (z, _) = read(evaluate(name, argument)), read(argument)
    assert result == pytest.approx(formula(z), rel=1e-10, abs=1e-13)


def test_trials_and_constants_go_together():
    trials = from_objects(np.array(["1+i", 2.0, "x"], object))
    assert function_named("IMSUM")([trials, constant("i")]).objects().tolist() == [
        "1+2i",
        "2+i",
        NUM_OF_COMPLEX_FUNCTIONS,
    ]
    assert function_named("IMDIV")([trials, constant(2.0)]).objects().tolist() == [
        "0.5+0.5i",
        "1",
        NUM_OF_COMPLEX_FUNCTIONS,
    ]
