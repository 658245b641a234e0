from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode

DIV0, NA, NUM, REF, VALUE = ErrorCode.DIV0, ErrorCode.NA, ErrorCode.NUM, ErrorCode.REF, ErrorCode.VALUE

TABLE = [
    ("ROWS", ([[1, 2, 3], [4, 5, DIV0]],), 2),
    ("COLUMNS", ([[1, 2, 3], [4, 5, DIV0]],), 3),
    ("ROWS", (5,), 1),
    ("COLUMNS", (REF,), REF),
    ("HYPERLINK", ("http://a.b",), "http://a.b"),
    ("HYPERLINK", (5,), "5"),
    ("HYPERLINK", ("http://a.b", "here"), "here"),
    ("HYPERLINK", ("http://a.b", 12), 12),
    ("HYPERLINK", ("http://a.b", NA), NA),
    ("HYPERLINK", (NUM, "here"), NUM),
    ("ADDRESS", (2, 3), "$C$2"),
    ("ADDRESS", (2, 3, 2), "C$2"),
    ("ADDRESS", (2, 3, 3), "$C2"),
    ("ADDRESS", (2, 3, 4), "C2"),
    ("ADDRESS", (2, 3, 2, False), "R2C[3]"),
    ("ADDRESS", (2, 3, 3, False), "R[2]C3"),
    ("ADDRESS", (2, 3, 4, 0), "R[2]C[3]"),
    ("ADDRESS", (2, 3, 1, False, "[Book1]Sheet1"), "[Book1]Sheet1!R2C3"),
    ("ADDRESS", (2, 3, 1, False, "EXCEL SHEET"), "'EXCEL SHEET'!R2C3"),
    ("ADDRESS", (2, 3, 3, True, "[Book 1]Sheet1"), "'[Book 1]Sheet1'!$C2"),
    ("ADDRESS", (2, 3, 1, 1, "Bob's"), "'Bob''s'!$C$2"),
    ("ADDRESS", (2, 3, None, None, "S"), "S!$C$2"),
    ("ADDRESS", (2, 3, 1, 1, None), "!$C$2"),
    ("ADDRESS", (1048576.5, 16384, 4), "XFD1048576"),
    ("ADDRESS", (1048577, 1), VALUE),
    ("ADDRESS", (1, 16385), VALUE),
    ("ADDRESS", (0, 1), VALUE),
    ("ADDRESS", (1, 0), VALUE),
    ("ADDRESS", (1, 1, 5), VALUE),
    ("ADDRESS", (1, 1, 0), VALUE),
    ("ADDRESS", ("x", NA), VALUE),
    ("ADDRESS", (1, NA, DIV0), NA),
    ("ADDRESS", (1, 1, 1, "x"), VALUE),
    ("ADDRESS", (1, 1, 1, 1, DIV0), DIV0),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected)


def test_rows_and_columns_in_arrays(evaluate):
    assert evaluate("ADDRESS", [[1], [2]], [[1, 2]], 4) == [["A1", "B1"], ["A2", "B2"]]
