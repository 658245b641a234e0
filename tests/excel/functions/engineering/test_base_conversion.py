"""Expected values are Excel's: from its help, and from a workbook it saved that tries lengths and limits."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode

NUM, VALUE, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

TABLE = [
    ("BIN2DEC", (1100100,), 100),
    ("BIN2DEC", ("1111111111",), -1),
    ("BIN2DEC", (1000000000,), -512),
    ("BIN2DEC", (111111111,), 511),
    ("BIN2DEC", (10000000000,), NUM),
    ("BIN2DEC", (2,), NUM),
    ("BIN2DEC", (-1,), NUM),
    ("BIN2DEC", (1.5,), NUM),
    ("BIN2DEC", ("0b1",), NUM),
    ("BIN2DEC", (" 1",), NUM),
    ("BIN2DEC", ("",), 0),
    ("BIN2DEC", (None,), 0),
    ("BIN2DEC", ("A",), NUM),
    ("BIN2DEC", (NA,), NA),
    ("BIN2HEX", (11111011, 4), "00FB"),
    ("BIN2HEX", (1110,), "E"),
    ("BIN2HEX", (1111111111,), "FFFFFFFFFF"),
    ("BIN2HEX", (1000000000, 1), "FFFFFFFE00"),
    ("BIN2OCT", (1001, 3), "011"),
    ("BIN2OCT", (1100100,), "144"),
    ("BIN2OCT", (1111111111,), "7777777777"),
    ("BIN2OCT", (1001010101,), "7777777125"),
    ("BIN2OCT", (None,), "0"),
    ("DEC2BIN", (9, 4), "1001"),
    ("DEC2BIN", (-100,), "1110011100"),
    ("DEC2BIN", (0, 3), "000"),
    ("DEC2BIN", (9, 3), NUM),
    ("DEC2BIN", (511,), "111111111"),
    ("DEC2BIN", (512,), NUM),
    ("DEC2BIN", (-512,), "1000000000"),
    ("DEC2BIN", (-513,), NUM),
    ("DEC2BIN", (9.9,), "1001"),
    ("DEC2BIN", (-9.9,), "1111110111"),
    ("DEC2BIN", ("9",), "1001"),
    ("DEC2BIN", (None,), "0"),
    ("DEC2BIN", ("",), VALUE),
    ("DEC2BIN", ("E", 1), VALUE),
    ("DEC2BIN", ("E", 0), NUM),
    ("DEC2BIN", ("E", 11), NUM),
    ("DEC2BIN", (-25, 1), "1111100111"),
    ("DEC2BIN", (-25, 0), NUM),
    ("DEC2BIN", (-25, 11), NUM),
    ("DEC2BIN", (1, 3.9), "001"),
    ("DEC2BIN", (1, "x"), VALUE),
    ("DEC2BIN", (1, True), VALUE),
    ("DEC2BIN", ("E", NA), NA),
    ("DEC2HEX", (100, 4), "0064"),
    ("DEC2HEX", (-54,), "FFFFFFFFCA"),
    ("DEC2HEX", (28,), "1C"),
    ("DEC2HEX", (64, 1), NUM),
    ("DEC2HEX", (549755813887,), "7FFFFFFFFF"),
    ("DEC2HEX", (549755813888,), NUM),
    ("DEC2HEX", (-549755813888,), "8000000000"),
    ("DEC2HEX", (1e300,), NUM),
    ("DEC2OCT", (58, 3), "072"),
    ("DEC2OCT", (-100,), "7777777634"),
    ("DEC2OCT", (536870911,), "3777777777"),
    ("DEC2OCT", (536870912,), NUM),
    ("HEX2BIN", ("F", 8), "00001111"),
    ("HEX2BIN", ("B7",), "10110111"),
    ("HEX2BIN", ("FFFFFFFFFF",), "1111111111"),
    ("HEX2BIN", ("1ff",), "111111111"),
    ("HEX2BIN", (200,), NUM),
    ("HEX2BIN", ("FFFFFFFDFF",), NUM),
    ("HEX2DEC", ("A5",), 165),
    ("HEX2DEC", ("FFFFFFFF5B",), -165),
    ("HEX2DEC", ("3DA408B9",), 1034160313),
    ("HEX2DEC", (255,), 597),
    ("HEX2DEC", (8000000000,), -549755813888),
    ("HEX2DEC", ("0x1F",), NUM),
    ("HEX2DEC", ("G",), NUM),
    ("HEX2DEC", ("-A",), NUM),
    ("HEX2OCT", ("F", 3), "017"),
    ("HEX2OCT", ("3B4E",), "35516"),
    ("HEX2OCT", ("FFFFFFFF00",), "7777777400"),
    ("HEX2OCT", ("1FFFFFFF",), "3777777777"),
    ("HEX2OCT", ("20000000",), NUM),
    ("HEX2OCT", ("FFE0000000",), "4000000000"),
    ("OCT2BIN", (3, 3), "011"),
    ("OCT2BIN", (7777777000,), "1000000000"),
    ("OCT2BIN", (777,), "111111111"),
    ("OCT2BIN", (1000,), NUM),
    ("OCT2DEC", (54,), 44),
    ("OCT2DEC", (7777777533,), -165),
    ("OCT2DEC", (4000000000,), -536870912),
    ("OCT2DEC", (8,), NUM),
    ("OCT2HEX", (100, 4), "0040"),
    ("OCT2HEX", (7777777533,), "FFFFFFFF5B"),
    ("OCT2HEX", (4444444444,), "FFE4924924"),
]

BASES = {"BIN": 2, "OCT": 8, "HEX": 16}


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected)


@pytest.mark.parametrize("name", BASES)
@given(data=st.data())
@settings(max_examples=100, deadline=None)
def test_digits_read_as_their_number(evaluate, name, data):
    half = BASES[name] ** 10 // 2
    number = data.draw(st.integers(-half, half - 1))
    digits = evaluate(f"DEC2{name}", number)
    assert evaluate(f"{name}2DEC", digits) == number
    assert len(digits) == 10 or number >= 0
    for other, base in BASES.items():
        if other != name:
            fits = -(base**10) // 2 <= number < base**10 // 2
            assert evaluate(f"{name}2{other}", digits) == (evaluate(f"DEC2{other}", number) if fits else NUM)


NUM_OF_BITS, VALUE_OF_BITS, NA_OF_BITS = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

TABLE_OF_BITS = [
    ("BITAND", (1, 5), 1),
    ("BITAND", (13, 25), 9),
    ("BITAND", (2**48 - 1, 2**48 - 1), 2**48 - 1),
    ("BITAND", (2**48, 1), NUM_OF_BITS),
    ("BITAND", (-1, 5), NUM_OF_BITS),
    ("BITAND", (1.5, 1), NUM_OF_BITS),
    ("BITAND", ("x", 1), VALUE_OF_BITS),
    ("BITAND", (True, None), 0),
    ("BITAND", (NA_OF_BITS, -1), NA_OF_BITS),
    ("BITOR", (23, 10), 31),
    ("BITOR", (True, 4), 5),
    ("BITOR", (1, -1), NUM_OF_BITS),
    ("BITXOR", (5, 3), 6),
    ("BITXOR", (2**47, 1), 2**47 + 1),
    ("BITXOR", (1, 1e300), NUM_OF_BITS),
    ("BITLSHIFT", (4, 2), 16),
    ("BITLSHIFT", (13, -2), 3),
    ("BITLSHIFT", (1, 2.9), 4),
    ("BITLSHIFT", (1, 47), 2**47),
    ("BITLSHIFT", (1, 48), NUM_OF_BITS),
    ("BITLSHIFT", (0, 53), 0),
    ("BITRSHIFT", (3, -47), NUM_OF_BITS),
    ("BITLSHIFT", (1, 54), NUM_OF_BITS),
    ("BITLSHIFT", (1, -54), NUM_OF_BITS),
    ("BITLSHIFT", (1.1, 2), NUM_OF_BITS),
    ("BITLSHIFT", (-16, 2), NUM_OF_BITS),
    ("BITLSHIFT", (4, "x"), VALUE_OF_BITS),
    ("BITRSHIFT", (13, 2), 3),
    ("BITRSHIFT", (13, -2), 52),
    ("BITRSHIFT", (1, 1), 0),
    ("BITRSHIFT", (1, -2.9), 4),
    ("BITRSHIFT", (2**48, 1), NUM_OF_BITS),
    ("BITRSHIFT", (1, 1e300), NUM_OF_BITS),
]

whole = st.integers(0, 2**48 - 1)


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE_OF_BITS)
def test_table_bits(check, name, arguments, expected):
    check(name, arguments, expected)


@given(whole, whole, st.integers(0, 53))
@settings(max_examples=200, deadline=None)
def test_bits_are_those_of_whole_numbers(evaluate, x, y, places):
    assert evaluate("BITAND", x, y) == x & y
    assert evaluate("BITOR", x, y) == x | y
    assert evaluate("BITXOR", x, y) == x ^ y
    assert evaluate("BITRSHIFT", x, places) == x >> places
    assert evaluate("BITLSHIFT", x, places) == (float(x << places) if x << places < 2**48 else NUM_OF_BITS)
