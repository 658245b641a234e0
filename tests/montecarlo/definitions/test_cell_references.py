from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.excel.address import MAX_COLUMN, MAX_ROW, Cell, column_letters, parse_address
from xlmc.excel.workbook.workbook import Formula
from xlmc.montecarlo.definitions.cell_references import formula_at, is_address, split_sheet


@pytest.mark.parametrize(
    ("text", "cell", "meant"),
    [
        ("Model!B1", Cell("Answers", 2, 2), "Model!B1"),
        ("Model!B1", Cell("Answers", 4, 3), "Model!C3"),
        ("Model!$B1", Cell("Answers", 4, 3), "Model!$B3"),
        ("Model!B$1", Cell("Answers", 4, 3), "Model!C$1"),
        ("'A1'!$B$1", Cell("Answers", 4, 3), "'A1'!$B$1"),
        ("B1:C2", Cell("Answers", 3, 2), "B2:C3"),
        ("Speed_now", Cell("Answers", 4, 3), "Speed_now"),
        ("B1", Cell("Answers", 1, 2), "#REF!"),
        ("+B1", Cell("Answers", 4, 3), "C3"),
        ("+Model!B1", Cell("Answers", 2, 2), "Model!B1"),
        ("SUM(B1)", Cell("Answers", 4, 3), "SUM(B1)"),
    ],
)
def test_filled_down_formulas(text, cell, meant):
    """Children of a shared formula carry the text and the place of their master, here B2."""
    assert formula_at(Formula(text, row=2, column=2), cell) == meant


@given(
    row=st.integers(1, MAX_ROW - 100),
    column=st.integers(1, MAX_COLUMN - 100),
    down=st.integers(0, 100),
    across=st.integers(0, 100),
)
def test_a_relative_reference_keeps_its_distance(row, column, down, across):
    formula = Formula(f"S!{column_letters(column)}{row}", row=7, column=9)
    moved = parse_address(formula_at(formula, Cell("T", 7 + down, 9 + across)))
    assert moved == Cell("S", row + down, column + across)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("B7", True),
        ("$B$7:c9", True),
        ("XFD1048576", True),
        ("XFE1", False),
        ("Name", False),
        ("S!B7", False),
        ("", False),
    ],
)
def test_is_address(text, expected):
    assert is_address(text) is expected


@pytest.mark.parametrize(
    ("text", "parts"),
    [("B7", (None, "B7")), (" S!B7 ", ("S", "B7")), ("'a!b'!B7", ("'a!b'", "B7")), ("!B7", ("", "B7"))],
)
def test_split_sheet(text, parts):
    assert split_sheet(text) == parts
