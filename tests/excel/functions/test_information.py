from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode

NA = ErrorCode.NA

TABLE = [
    ("NA", (), NA),
    *(("ERROR.TYPE", (code,), int(code)) for code in ErrorCode),
    ("ERROR.TYPE", (1,), NA),
    ("ERROR.TYPE", (None,), NA),
    ("ERROR.TYPE", ([[ErrorCode.REF, "a"]],), [[4.0, NA]]),
    ("N", (7.5,), 7.5),
    ("N", (True,), 1),
    ("N", ("7",), 0),
    ("N", (None,), 0),
    ("N", (NA,), NA),
    ("N", ([[True, "a"], [2.0, NA]],), [[1.0, 0.0], [2.0, NA]]),
    ("T", ("Rainfall",), "Rainfall"),
    ("T", (19,), ""),
    ("T", (True,), ""),
    ("T", (None,), ""),
    ("T", (NA,), NA),
    ("T", ([["a", 1.0]],), [["a", ""]]),
    ("TYPE", (1,), 1),
    ("TYPE", (None,), 1),
    ("TYPE", ("Smith",), 2),
    ("TYPE", (True,), 4),
    ("TYPE", (NA,), 16),
    ("TYPE", ([["a"]],), 2),
    ("TYPE", ([[1.0, 2.0]],), 64),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected)
