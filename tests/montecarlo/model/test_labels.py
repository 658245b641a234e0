from __future__ import annotations

import openpyxl
import pytest
from openpyxl.worksheet.table import Table

from xlmc.excel.address import Cell
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.model.labels import calculate_labels, calculated_texts

ROWS = (
    ("Name", "Value", "Low", "High", "Source", "Cell"),
    ('=Names!A1&" weight"', 3, "=1+1", 4, '=IF(B2=3,"scale","")', None),
    ("plain", 5, 4, 6, "=NOSUCH(1)", None),
    ("=A2", 7, 6, 8, "=RAND()", "=Names!A1"),
)


@pytest.fixture
def book(tmp_path):
    """`book(other="xlmc_assumptions")`: read from a file whose formulas were never calculated."""

    def make(table="xlmc_assumptions"):
        made = openpyxl.Workbook()
        sheet = made.active
        sheet.title = "S"
        for row in ROWS:
            sheet.append(row)
        sheet.add_table(Table(displayName=table, ref="A1:F4"))
        made.create_sheet("Names")["A1"] = "Ford"
        made.create_sheet("Damaged")
        made.save(tmp_path / "book.xlsx")
        return read_workbook(tmp_path / "book.xlsx")

    return make


def test_texts_of_the_tables_are_calculated_and_nothing_else(book):
    before = book()
    after = calculate_labels(before)
    result = {(row, column): content.value for (row, column), content in after.sheets["S"].cells.items() if row > 1}
    assert {spot: value for spot, value in result.items() if isinstance(value, str)} == {
        (2, 1): "Ford weight",
        (2, 5): "scale",
        (3, 1): "plain",
        (4, 1): "Ford weight",
    }
    assert result[2, 3] is None  # a number is not a label: each run computes it
    assert result[3, 5] is result[4, 5] is result[4, 6] is None
    assert list(after.sheets) == list(before.sheets)
    assert after.content(Cell("S", 2, 1)).formula == before.content(Cell("S", 2, 1)).formula
    assert (after.data, after.sha256) == (before.data, before.sha256)


@pytest.mark.parametrize(("table", "message"), [("xlmc_forecasts", None), ("xlmc_settings", "high")])
def test_a_forecast_in_the_table_itself_is_not_calculated_to_read_it(tmp_path, table, message):
    """It may need every formula of the workbook; in settings the column says what is meant."""
    made = openpyxl.Workbook()
    made.active.append(("Name", "Value"))
    made.active.append(("speed", '=IF(1>0,"high","low")'))
    made.active.add_table(Table(displayName=table, ref="A1:B2"))
    made.save(tmp_path / "book.xlsx")
    result = calculate_labels(read_workbook(tmp_path / "book.xlsx"))
    assert result.content(Cell("Sheet", 2, 2)).value == message


def test_a_book_without_anything_to_calculate_stays_itself(book):
    other = book("prices")
    assert calculate_labels(other) is other
    assert calculated_texts(other, [Cell("S", 2, 1), Cell("S", 3, 5)]) == {Cell("S", 2, 1): "Ford weight"}


STALE = {
    "A2": ('="Speed "&B1', "Speed 0"),
    "B1": 8.0,
    "B2": ("=B1*9", 0.0),  # the forecast itself
    "C2": ("=B1/2", 0.0),
    "D2": ("=B1*2", 16.0 * (1 + 1e-15)),  # the last bits are Excel's
    "E2": ("=B1>5", False),
    "F2": ("=NOSUCH(1)", 3.0),
    "G2": ("=B1/0", 7.0),
    "H2": ("=B1", 3.0),  # says which cell is meant
}
COLUMNS = ("Name", "Value", "Threshold", "Range %", "Frozen", "Certainty from", "Certainty to", "Cell")


@pytest.mark.parametrize("stale", [True, False])
def test_values_that_may_be_older_than_their_formulas_are_calculated_again(workbook, table, stale):
    tables = [table("xlmc_forecasts", "A1:H2", *COLUMNS), table("xlmc_settings", "A4:B5", "Setting", "Value")]
    before = workbook(STALE | {"A5": "Trials", "B5": ("=B1*1000", 0.0)}, tables=tables, may_be_stale=stale)
    after = calculate_labels(before)
    if not stale:
        assert after is before
        return
    saved = {at: content.value for at, content in before.sheets["S"].cells.items()}
    result = {at: content.value for at, content in after.sheets["S"].cells.items()}
    changed = {(2, 1): "Speed 8", (2, 3): 4.0, (2, 5): True, (5, 2): 8000.0}
    assert result == saved | changed
    text = {
        str(notice.where): notice.message.partition(", which is used: let Excel calculate")[0]
        for notice in after.notices
    }
    assert text == {
        "S!A2": "The file says 'Speed 0', but the formula gives 'Speed 8'",
        "S!C2": "The file says 0, but the formula gives 4",
        "S!E2": "The file says FALSE, but the formula gives TRUE",
        "S!B5": "The file says 0, but the formula gives 8000",
    }
