"""What a cell is called by the texts around it: layouts of real workbooks."""

from __future__ import annotations

import openpyxl
import pytest

from xlmc.excel.address import parse_address
from xlmc.excel.workbook.labels import label_of
from xlmc.excel.workbook.reader import read_workbook

SUMMARY = {"B9": "MONTHLY EXPENSES", "E8": "Income", "F8": "Expenses", "G8": "Balance", "E9": 3750, "F9": 2336, "G9": 9}
COLUMNS = {"H4": "Total", "H5": "Gain", "H6": "(Per Year)", "H7": "€", "H8": 815.84, "I7": "%", "I8": 4.9, "H9": 400}
BESIDE = {"A1": "Name", "D1": "Value", "A2": "Load", "D2": 12, "D3": 4, "A3": "Span", "E3": "m"}

YEARS = {"D2": 2013, "E2": 2014, "F2": 2015, "B3": "Power", "D3": 1.5, "E3": 2.5, "F3": 3.5, "A6": 2013, "A7": 2014}
PARTNERS = {"B3": "Partner", "C3": "Quantity", "D3": "Amount", "B4": "a", "C4": 2, "D4": 123}
CLASS = {"B1": "Percent", "C1": "Number", "B2": "of class", "C2": "of students", "A4": "Seeking", "B4": 0.9, "C4": 532}
NOTED = {"A1": "Name", "B1": "Value", "C1": "Note", "A2": "Load", "B2": 12, "C2": "as built"}


@pytest.mark.parametrize(
    ("cells", "cell", "name", "unit"),
    [
        (YEARS, "D3", "Power, 2013", ""),
        (YEARS, "F3", "Power, 2015", ""),
        (YEARS | {"B5": "Demand", "B6": 4}, "B6", "2013", ""),
        (PARTNERS, "C4", "a, Quantity", ""),
        (PARTNERS, "D4", "a, Amount", ""),
        (NOTED, "B2", "Load", ""),
        (CLASS, "B4", "Seeking, Percent of class", ""),
        (CLASS, "C4", "Seeking, Number of students", ""),
        (SUMMARY, "E9", "Income", ""),
        (SUMMARY, "F9", "Expenses", ""),
        (SUMMARY, "G9", "Balance", ""),
        (COLUMNS, "H8", "Gain (Per Year)", "€"),
        (COLUMNS, "H9", "Gain (Per Year)", "€"),
        (COLUMNS, "I8", "%", ""),
        (BESIDE, "D2", "Load", ""),
        (BESIDE, "D3", "Span", "m"),
        ({"A1": "Load (kN)", "B1": 12}, "B1", "Load", "kN"),
        ({"A1": "Total", "A2": 7}, "A2", "Total", ""),
        ({"A1": "a", "B1": "x", "A2": "Case", "B2": 1, "C1": "y", "C2": 2, "B3": 3, "C3": 4}, "C2", "Case, y", ""),
    ],
)
def test_a_cell_is_called_by_the_texts_around_it(cells, cell, name, unit, tmp_path):
    book = openpyxl.Workbook()
    for place, value in cells.items():
        book.active[place] = value
    book.active.title = "S"
    book.save(tmp_path / "book.xlsx")
    result = label_of(read_workbook(tmp_path / "book.xlsx"), parse_address(cell, "S"))
    assert (result.name, result.unit) == (name, unit)
