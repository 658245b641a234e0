from __future__ import annotations

import pytest

from xlmc.excel.address import Cell, parse_address
from xlmc.excel.formula.graph import Spills


@pytest.mark.parametrize(
    ("cell", "anchor"),
    [
        ("S!B1", None),  # the anchor holds the formula itself
        ("S!B2", "S!B1"),
        ("S!C3", "S!B1"),
        ("S!D1", None),
        ("S!B4", None),
        ("S!F1", None),  # an array formula of one cell
        ("Data!B2", None),
        ("Nowhere!B2", None),
    ],
)
def test_which_array_formula_fills_a_cell(workbook, array, cell, anchor):
    cells = {"B1": array("=A1:A3*{1,2}", "S!B1:C3"), "B2": 4.0, "F1": array("=SUM(A1:A3)", "S!F1"), "Data!B2": 1.0}
    result = Spills(workbook(cells)).anchor(parse_address(cell))
    assert result == (parse_address(anchor) if anchor else None)


def test_an_array_as_large_as_the_sheet(workbook, array):
    spills = Spills(workbook({"A1": array("=1", "S!A1:XFD1048576")}))
    assert spills.anchor(Cell("S", 1_000_000, 10_000)) == Cell("S", 1, 1)
