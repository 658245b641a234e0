"""Cells by what people call them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from xlmc.errors import WorkbookError
from xlmc.excel.address import Area, Cell
from xlmc.excel.workbook.places import area_named, cell_named, changeable_cell
from xlmc.excel.workbook.workbook import CellContent, Formula

CELLS = {"A1": 1.0, "B4": 2.0, "C2": "=A1*2", "T!D7": 5.0}
NAMES = {"Rate": "S!$B$4", "Both": "S!$A$1:$B$4", "T!Local": "T!$D$7"}


@pytest.fixture
def book(workbook):
    return workbook(CELLS, names=NAMES, sheets=["T", "My sheet", "Empty"])


@pytest.mark.parametrize(
    ("place", "area"),
    [
        ("S!B4", (4, 2, 4, 2)),
        ("s!$b$4", (4, 2, 4, 2)),
        (" rate ", (4, 2, 4, 2)),
        ("Both", (1, 1, 4, 2)),
        ("S!A1:B4", (1, 1, 4, 2)),
        ("S!A:B", (1, 1, 4, 2)),
        ("S!$B:$XFD", (1, 2, 4, 3)),
        ("S!2:3", (2, 1, 3, 3)),
        ("S!$2:$1048576", (2, 1, 4, 3)),
        ("S!A2:C33334", (2, 1, 33334, 3)),  # 99,999 cells
        ("S!A1:J10000", (1, 1, 10000, 10)),  # 100,000 cells
        ("S!A1:K10000", (1, 1, 4, 3)),
    ],
)
def test_a_place_is_an_area(book, place, area):
    assert area_named(book, place) == Area("S", *area)


@pytest.mark.parametrize(
    ("place", "message"),
    [
        ("Nowhere!A1", "there is no sheet 'Nowhere' in book.xlsx; there are S, T, My sheet, Empty"),
        ("A1", "'A1' is no cell of book.xlsx"),  # of which sheet?
        ("S!A0", "is no cell"),
        ("S!Speed", "is no cell"),
        ("Empty!A:B", "holds nothing"),
        ("S!D:E", "holds nothing"),
        ("S!5:6", "holds nothing"),
    ],
)
def test_what_is_no_place_is_refused(book, place, message):
    with pytest.raises(KeyError) as caught:
        area_named(book, place)
    assert message in caught.value.args[0]


def test_the_only_sheet_needs_no_name(workbook):
    assert cell_named(workbook(CELLS | {"T!D7": None}), "T!D7") == Cell("T", 7, 4)
    assert cell_named(workbook({"A1": 1.0}), "A1") == Cell("S", 1, 1)


def test_one_cell_is_one_cell(book):
    assert cell_named(book, "S!B4:B4") == Cell("S", 4, 2)
    with pytest.raises(KeyError, match="'Both' is not one cell, but S!A1:B4"):
        cell_named(book, "Both")


def test_a_cell_of_a_value_may_be_changed(book):
    assert changeable_cell(book, "Rate") == Cell("S", 4, 2)
    assert changeable_cell(book, "Empty!A1") == Cell("Empty", 1, 1)
    with pytest.raises(WorkbookError, match="holds a formula"):
        changeable_cell(book, "S!C2")


def test_what_fills_or_hides_a_cell_is_told(book):
    sheet, area = book.sheets["S"], Area("S", 10, 1, 12, 2)
    filling = CellContent(1.0, Formula("ROW(1:3)", 10, 1, array=area))
    arrays = replace(book, sheets={"S": replace(sheet, cells={**sheet.cells, (10, 1): filling})})
    merged = replace(book, sheets={"S": replace(sheet, merged=(area,))})
    with pytest.raises(WorkbookError, match="The array formula in S!A10 fills the cell"):
        changeable_cell(arrays, "B11")
    assert changeable_cell(arrays, "C11") == Cell("S", 11, 3)
    assert area_named(arrays, "A:C").bottom == 12
    with pytest.raises(WorkbookError, match="hidden by a merged one") as caught:
        changeable_cell(merged, "A11")
    assert caught.value.hint == "Change S!A10"
    assert changeable_cell(merged, "A10") == Cell("S", 10, 1)
    assert changeable_cell(merged, "A13") == Cell("S", 13, 1)
