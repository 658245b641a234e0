from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value, constant, from_objects

EVERY = np.arange(1.0, 4000.0)
NUM, VALUE, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

TABLE = [
    ("ROMAN", (499,), "CDXCIX"),
    ("ROMAN", (499, 0), "CDXCIX"),
    ("ROMAN", (499, 1), "LDVLIV"),
    ("ROMAN", (499, 2), "XDIX"),
    ("ROMAN", (499, 3), "VDIV"),
    ("ROMAN", (499, 4), "ID"),
    ("ROMAN", (499, True), "CDXCIX"),
    ("ROMAN", (499, False), "ID"),
    ("ROMAN", (999.99, 0.9), "CMXCIX"),
    ("ROMAN", (999, 1), "LMVLIV"),
    ("ROMAN", (999, 2), "XMIX"),
    ("ROMAN", (999, 3), "VMIV"),
    ("ROMAN", (999, 4), "IM"),
    ("ROMAN", (3046, 1), "MMMVLI"),
    ("ROMAN", (3999, 1), "MMMLMVLIV"),
    ("ROMAN", ("2013",), "MMXIII"),
    ("ROMAN", (0,), ""),
    ("ROMAN", (None,), ""),
    ("ROMAN", (4000,), VALUE),
    ("ROMAN", (-1,), VALUE),
    ("ROMAN", (1, 5), VALUE),
    ("ROMAN", (1, -1), VALUE),
    ("ROMAN", ("x",), VALUE),
    ("ROMAN", (NA, 9), NA),
    ("ARABIC", ("LVII",), 57),
    ("ARABIC", ("mcmxii",), 1912),
    ("ARABIC", ("-MMXI",), -2011),
    ("ARABIC", ("  XIV  ",), 14),
    ("ARABIC", ("",), 0),
    ("ARABIC", (None,), 0),
    ("ARABIC", ("IIX",), 8),
    ("ARABIC", ("IIIIIIV",), -1),
    ("ARABIC", ("IIIIIIIIM",), 992),
    ("ARABIC", ("CIVIIX",), 102),
    ("ARABIC", ("XMXIIVXL",), 1013),
    ("ARABIC", ("IIIIMIXVC",), 1080),
    ("ARABIC", ("M" * 255,), 255000),
    ("ARABIC", ("M" * 256,), VALUE),
    ("ARABIC", ("-",), NUM),
    ("ARABIC", ("- I",), VALUE),
    ("ARABIC", ("roman",), VALUE),
    ("ARABIC", (5,), VALUE),
    ("BASE", (7, 2), "111"),
    ("BASE", (100, 16), "64"),
    ("BASE", (15, 2, 10), "0000001111"),
    ("BASE", (255, 2, 3), "11111111"),
    ("BASE", (35, 36), "Z"),
    ("BASE", (0, 36), "0"),
    ("BASE", (0, 10, 0), ""),
    ("BASE", (7.9, 2.9, 4.9), "0111"),
    ("BASE", (9.007e15, 36), "2GOPQOE5GCG"),
    ("BASE", (9.008e15, 36), NUM),
    ("BASE", (-1, 2), NUM),
    ("BASE", (0, 1), NUM),
    ("BASE", (0, 37), NUM),
    ("BASE", (0, 2, 256), NUM),
    ("BASE", (0, 2, -1), NUM),
    ("BASE", ("x", 2), VALUE),
    ("DECIMAL", ("FF", 16), 255),
    ("DECIMAL", (111, 2), 7),
    ("DECIMAL", ("zap", 36), 45745),
    ("DECIMAL", ("  1234", 10), 1234),
    ("DECIMAL", ("123", 10.9), 123),
    ("DECIMAL", ("", 10), 0),
    ("DECIMAL", ("1F", 10), NUM),
    ("DECIMAL", ("-1", 10), NUM),
    ("DECIMAL", ("1_0", 10), NUM),
    ("DECIMAL", ("0b1", 2), NUM),
    ("DECIMAL", ("0", 1), NUM),
    ("DECIMAL", ("0", 37), NUM),
    ("DECIMAL", ("0" * 255, 10), 0),
    ("DECIMAL", ("0" * 256, 10), VALUE),
    ("DECIMAL", ("Z" * 198, 36), 1.4057081148316923e308),
    ("DECIMAL", ("Z" * 199, 36), NUM),
    ("DECIMAL", ("1", NA), NA),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-15)


@cache
def numerals(form):
    """Those of 1 to 3999, in one call of the function."""
    return function_named("ROMAN")([Value.of_numbers(EVERY), constant(form)]).objects()


@pytest.mark.parametrize("form", [1, 4])
def test_every_numeral_reads_as_its_number(form):
    result = numerals(form)
    assert function_named("ARABIC")([from_objects(result)]).objects().tolist() == EVERY.tolist()
    assert max(map(len, result)) < 16
    assert all(len(new) <= len(old) for new, old in zip(result, numerals(form - 1), strict=True))


def test_the_classic_form_reads_as_its_number_and_repeats_no_letter_four_times():
    result = numerals(0)
    assert function_named("ARABIC")([from_objects(result)]).objects().tolist() == EVERY.tolist()
    for numeral in result:
        assert not any(letter * 4 in numeral for letter in "IXCM")
        assert not any(letter * 2 in numeral for letter in "VLD")


@given(st.integers(0, 2**53 - 1), st.integers(2, 36))
@settings(max_examples=200, deadline=None)
def test_digits_read_as_their_number(evaluate, number, radix):
    digits = evaluate("BASE", number, radix)
    assert int(digits, radix) == number
    assert evaluate("DECIMAL", digits.lower(), radix) == number
