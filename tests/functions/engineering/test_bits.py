from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode

NUM, VALUE, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

TABLE = [
    ("BITAND", (1, 5), 1),
    ("BITAND", (13, 25), 9),
    ("BITAND", (2**48 - 1, 2**48 - 1), 2**48 - 1),
    ("BITAND", (2**48, 1), NUM),
    ("BITAND", (-1, 5), NUM),
    ("BITAND", (1.5, 1), NUM),
    ("BITAND", ("x", 1), VALUE),
    ("BITAND", (True, None), 0),
    ("BITAND", (NA, -1), NA),
    ("BITOR", (23, 10), 31),
    ("BITOR", (True, 4), 5),
    ("BITOR", (1, -1), NUM),
    ("BITXOR", (5, 3), 6),
    ("BITXOR", (2**47, 1), 2**47 + 1),
    ("BITXOR", (1, 1e300), NUM),
    ("BITLSHIFT", (4, 2), 16),
    ("BITLSHIFT", (13, -2), 3),
    ("BITLSHIFT", (1, 2.9), 4),
    ("BITLSHIFT", (1, 47), 2**47),
    ("BITLSHIFT", (1, 48), NUM),
    ("BITLSHIFT", (0, 53), 0),
    ("BITRSHIFT", (3, -47), NUM),
    ("BITLSHIFT", (1, 54), NUM),
    ("BITLSHIFT", (1, -54), NUM),
    ("BITLSHIFT", (1.1, 2), NUM),
    ("BITLSHIFT", (-16, 2), NUM),
    ("BITLSHIFT", (4, "x"), VALUE),
    ("BITRSHIFT", (13, 2), 3),
    ("BITRSHIFT", (13, -2), 52),
    ("BITRSHIFT", (1, 1), 0),
    ("BITRSHIFT", (1, -2.9), 4),
    ("BITRSHIFT", (2**48, 1), NUM),
    ("BITRSHIFT", (1, 1e300), NUM),
]

whole = st.integers(0, 2**48 - 1)


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected)


@given(whole, whole, st.integers(0, 53))
@settings(max_examples=200, deadline=None)
def test_bits_are_those_of_whole_numbers(evaluate, x, y, places):
    assert evaluate("BITAND", x, y) == x & y
    assert evaluate("BITOR", x, y) == x | y
    assert evaluate("BITXOR", x, y) == x ^ y
    assert evaluate("BITRSHIFT", x, places) == x >> places
    assert evaluate("BITLSHIFT", x, places) == (float(x << places) if x << places < 2**48 else NUM)
