from __future__ import annotations

import pytest

from xlmc.excel.functions.number_format.placeholders import general_in_cell

GENERAL = [
    (0, "0"),
    (12345, "12345"),
    (1.2345678912, "1.234567891"),
    (1.2345678919, "1.234567892"),
    (4403928373.5, "4403928374"),
    (12345678901.5, "12345678902"),
    (99999999999.6, "1E+11"),
    (112345900000, "1.12346E+11"),
    (0.1 + 0.2, "0.3"),
    (0.000123456789, "0.000123457"),
    (0.00001234567, "1.23457E-05"),
    (0.000012345, "0.000012345"),
    (0.0000012345, "1.2345E-06"),
    (1e-9, "0.000000001"),
    (1.1e-9, "1.1E-09"),
    (1e-10, "1E-10"),
    (1.5e300, "1.5E+300"),
]


@pytest.mark.parametrize(("value", "text"), GENERAL)
def test_general_in_eleven_characters(value, text):
    assert general_in_cell(value) == text


@pytest.mark.parametrize(
    ("code", "value", "text"),
    [
        ("General", -12.5, "-12.5"),
        ('General" m"', 12.5, "12.5 m"),
        ("[Blue]GENERAL", 3, "3"),
        (r"\G", -1, "-G"),
        ("[$-409]", 5, ""),
        ("[$EUR] ", 5, "EUR "),
        ("☃", 1, "☃"),
    ],
)
def test_bare_texts_and_general(written, code, value, text):
    assert written(code, value) == text
