from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.workbook.sheet import CellContext, convert

CONTEXT = CellContext(strings=("zero", "one"))

VALUES = [
    ("n", "42", 42.0),
    ("n", "-1.5E-3", -0.0015),
    ("n", "0.1", 0.1),
    ("n", "", None),
    ("b", "1", True),
    ("b", "0", False),
    ("b", "true", True),
    ("s", "1", "one"),
    ("str", "", ""),
    ("str", "a_x000a_b", "a\nb"),
    ("inlineStr", "a_x000a_b", "a_x000a_b"),
    ("e", "#DIV/0!", ErrorCode.DIV0),
    ("e", "#N/A", ErrorCode.NA),
    ("e", "#SPILL!", ErrorCode.SPILL),
    ("e", "#CALC!", ErrorCode.CALC),
    *(
        ("e", text, ErrorCode.VALUE)
        for text in ("#FIELD!", "#BUSY!", "#CONNECT!", "#BLOCKED!", "#UNKNOWN!", "#PYTHON!")
    ),
]


@pytest.mark.parametrize(("kind", "raw", "value"), VALUES)
def test_value(kind, raw, value):
    result = convert(kind, raw, CONTEXT)
    assert result == value
    assert type(result) is type(value)


@pytest.mark.parametrize(
    ("raw", "serial", "serial1904"),
    [
        ("2001-03-11", 36961.0, 35499.0),
        ("2001-03-11T12:00:00", 36961.5, 35499.5),
        ("2001-03-11T18:00:00.000Z", 36961.75, 35499.75),
        ("1900-01-01", 1.0, None),
        ("1900-03-01", 61.0, None),  # Excel counts a 29 February 1900
        ("1904-01-01", 1462.0, 0.0),
        ("06:00:00", 0.25, 0.25),
    ],
)
def test_iso_dates_are_serial_numbers(raw, serial, serial1904):
    assert convert("d", raw, CONTEXT) == serial
    if serial1904 is not None:
        assert convert("d", raw, CellContext(date1904=True)) == serial1904


@pytest.mark.parametrize(
    ("kind", "raw", "message"),
    [
        ("n", "12 m", "holds '12 m' where a number should be"),
        ("n", "NaN", "holds 'NaN' where a number should be"),
        ("n", "1e999", "holds '1e999' where a number should be"),
        ("b", "2", r"where TRUE \(1\) or FALSE \(0\) should be"),
        ("b", "", r"where TRUE \(1\) or FALSE \(0\) should be"),
        ("s", "2", "number '2' of 2"),
        ("s", "-1", "number '-1' of 2"),
        ("s", "9" * 5000, "holds a text that the workbook does not"),
        ("s", "x", "number 'x' of 2"),
        ("d", "yesterday", "holds 'yesterday' where a date should be"),
        ("d", "2001-13-40", "where a date should be"),
        ("z", "1", "is of the unknown type 'z'"),
    ],
)
def test_refused(kind, raw, message):
    with pytest.raises(ValueError, match=message):
        convert(kind, raw, CONTEXT)
