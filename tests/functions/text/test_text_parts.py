from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode

VALUE = ErrorCode.VALUE

TABLE = [
    ("LEN", ("Phoenix, AZ",), 11),
    ("LEN", ("",), 0),
    ("LEN", (None,), 0),
    ("LEN", (True,), 4),
    ("LEN", (1 / 3,), 17),
    ("LEN", ("a😀",), 3),
    ("LEN", (ErrorCode.NA,), ErrorCode.NA),
    ("LEFT", ("Sale Price", 4), "Sale"),
    ("LEFT", ("Sweden",), "S"),
    ("LEFT", ("abc", 0), ""),
    ("LEFT", ("abc", 1.9), "a"),
    ("LEFT", ("abc", 1e300), "abc"),
    ("LEFT", ("abc", -1), VALUE),
    ("LEFT", ("abc", "2"), "ab"),
    ("LEFT", (True, 2), "TR"),
    ("LEFT", (12.5, 2), "12"),
    ("LEFT", ("😀b", 2), "😀"),
    ("LEFT", ("😀b", 1), "\ufffd"),
    ("RIGHT", ("Sale Price", 5), "Price"),
    ("RIGHT", ("abc",), "c"),
    ("RIGHT", ("abc", 0), ""),
    ("RIGHT", ("abc", 10), "abc"),
    ("RIGHT", ("abc", -1), VALUE),
    ("MID", ("Fluid Flow", 1, 5), "Fluid"),
    ("MID", ("Fluid Flow", 7, 20), "Flow"),
    ("MID", ("Fluid Flow", 20, 5), ""),
    ("MID", ("abc", 0, 1), VALUE),
    ("MID", ("abc", 0.9, 1), VALUE),
    ("MID", ("abc", 1, -1), VALUE),
    ("MID", ("abc", 2.9, 1.9), "b"),
    ("REPLACE", ("abcdefghijk", 6, 5, "*"), "abcde*k"),
    ("REPLACE", (2009, 3, 2, "10"), "2010"),
    ("REPLACE", ("123456", 1, 3, "@"), "@456"),
    ("REPLACE", ("abc", 2, 0, "x"), "axbc"),
    ("REPLACE", ("abc", 9, 1, "x"), "abcx"),
    ("REPLACE", ("abc", 0, 1, "x"), VALUE),
    ("REPLACE", ("abc", 1, -1, "x"), VALUE),
    ("REPT", ("*-", 3), "*-*-*-"),
    ("REPT", ("-", 10.9), "-" * 10),
    ("REPT", ("ab", 0), ""),
    ("REPT", ("", 1e300), ""),
    ("REPT", ("ab", -1), VALUE),
    ("REPT", ("a", 32767), "a" * 32767),
    ("REPT", ("a", 32768), VALUE),
    ("REPT", ("a", 1e300), VALUE),
    ("LEFTB", ("abc", 2), "ab"),
    ("LEN", ([["a", "bcd"]],), [[1.0, 3.0]]),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected)
