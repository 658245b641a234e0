from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.functions.engineering.complex_numbers import common_suffix, read, written

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
def test_written(number, expected):
    assert written(*number) == expected


parts = st.floats(-1e300, 1e300, allow_subnormal=False)


@given(parts, parts, st.sampled_from("ij"))
@settings(max_examples=300, deadline=None)
def test_what_is_written_reads_as_itself_to_15_digits(x, y, suffix):
    text = written(complex(x, y), suffix)
    number, found = read(text)
    assert math.isclose(number.real, x, rel_tol=1e-14, abs_tol=1e-300)
    assert math.isclose(number.imag, y, rel_tol=1e-14, abs_tol=1e-300)
    assert found == (suffix if y else "")
    assert written(number, suffix) == text


@pytest.mark.parametrize(
    ("suffixes", "expected"),
    [(("i", "i"), "i"), (("", "j"), "j"), (("", ""), ""), (("i", "j"), VALUE), (("j", "", "i"), VALUE), ((), "")],
)
def test_common_suffix(suffixes, expected):
    assert common_suffix(*suffixes) == expected
