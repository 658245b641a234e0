from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode

NUM, VALUE, NA, DIV0 = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA, ErrorCode.DIV0

MIXED = [[10, "12", True], [None, False, 4]]
"""10, 0, 1, 0 and 4."""
BLANK = [[None, None]]
BREAKING = [[1345, 1301, 1368, 1322, 1310, 1370, 1318, 1350, 1303, 1299]]  # the example in Excel's own help

HELP = [
    ("AVERAGEA", ([[10, 7, 9, 2, "Not available"]],), "5.6"),
    ("AVERAGEA", ([[10, 7, 9, 2, None]],), "7"),
    ("MAXA", ([[0, 0.2, 0.5, 0.4, True]],), "1"),
    ("MINA", ([[False, 0.2, 0.5, 0.4, 0.8]],), "0"),
    ("STDEVA", (BREAKING,), "27.46391572"),
    ("STDEVPA", (BREAKING,), "26.05455814"),
    ("VARA", (BREAKING,), "754.2666667"),
    ("VARPA", (BREAKING,), "678.84"),
]


@pytest.mark.parametrize(("name", "arguments", "printed"), HELP)
def test_examples_of_excels_help(shows, name, arguments, printed):
    shows(name, arguments, printed)


TABLE = [
    ("AVERAGEA", (MIXED,), 3),
    ("AVERAGEA", ("1", 1, [[False]], None), 0.5),
    ("AVERAGEA", ("TRUE", 1), VALUE),
    ("AVERAGEA", (BLANK,), DIV0),
    ("AVERAGEA", ([[1, NA]], DIV0), NA),
    ("MAXA", (MIXED, 3), 10),
    ("MAXA", ([["x", -1]],), 0),
    ("MAXA", ([[None, -1]],), -1),
    ("MAXA", (None, -1), 0),
    ("MAXA", (BLANK,), 0),
    ("MINA", (MIXED, 3), 0),
    ("MINA", ("-23", [["x"]], BLANK), -23),
    ("MINA", ("x", 1), VALUE),
    ("MINA", (BLANK,), 0),
    ("VARA", (MIXED,), 18),
    ("VARA", ([[True]],), DIV0),
    ("VARA", (BLANK,), DIV0),
    ("VARA", ([[0.1, 0.1, 0.1]],), 0),
    ("VARPA", (MIXED,), 14.4),
    ("VARPA", ([[True]],), 0),
    ("VARPA", (BLANK,), DIV0),
    ("STDEVA", (MIXED,), 18**0.5),
    ("STDEVA", ([["x"]],), DIV0),
    ("STDEVPA", (MIXED,), 14.4**0.5),
    ("STDEVPA", (BLANK,), DIV0),
    ("STDEVPA", ([[NA]],), NA),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-15)
