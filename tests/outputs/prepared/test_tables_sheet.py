"""The sheet of tables to be filled in, as Excel shows it."""

from __future__ import annotations

import io

import openpyxl
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell
from xlmc.excel.workbook.writer import package_bytes
from xlmc.montecarlo.definitions.tables.settings import setting_names
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.outputs.prepared.tables_sheet import HEADINGS, NewRow, frozen_formula, tables_sheet

ROWS = {
    "xlmc_assumptions": [
        NewRow({"Name": "a", "Low": 1.0, "High": 2.0, "Units": "m"}, Cell("S", 1, 2), 1.5),
        NewRow({"Name": "b"}, Cell("S", 2, 2), ErrorCode.DIV0),
        NewRow({"Name": "c", "Upper cutoff": 0.0}, Cell("S", 3, 2), None),
        NewRow({"Name": "d", "Distribution": "Normal"}, Cell("S", 4, 2), "text"),
        NewRow({"Name": "e", "Source": True}, None),
    ],
    "xlmc_forecasts": [NewRow({"Name": "y", "Threshold": 4.0}, Cell("S", 9, 3), True)],
}


def read(kinds, *, data_only=False, rows=ROWS):
    parts = tables_sheet(rows, kinds, "xlmc", "The title")
    return openpyxl.load_workbook(io.BytesIO(package_bytes(parts)), data_only=data_only)["xlmc"]


@pytest.fixture(scope="module")
def every():
    return read([*HEADINGS])


def test_tables_stand_side_by_side_a_column_apart(every):
    assert dict(every.tables.items()) == {
        "xlmc_assumptions": "A6:M11",
        "xlmc_forecasts": "O6:R7",
        "xlmc_filters": "T6:X7",
        "xlmc_correlations": "Z6:AB7",
        "xlmc_decisions": "AD6:AJ7",
        "xlmc_solve": "AL6:AR7",
        "xlmc_settings": "AT6:AU7",
    }
    for name, ref in every.tables.items():
        assert tuple(cell.value for cell in every[ref][0]) == HEADINGS[name]
    assert every["A1"].value == "The title"
    assert every["A2"].value.startswith("xlmc reads these tables")
    titles = {cell.column_letter: cell.value for cell in every[4] if cell.value}
    assert list(titles) == ["A", "O", "T", "Z", "AD", "AL", "AT"]
    assert titles["T"] == "Filters: which trials are possible"
    assert every["Z5"].value == "Names of two assumptions, and their rank correlation from -1 to 1."
    assert every["A4"].font.b
    assert every["A5"].font.i


def test_a_table_that_is_not_asked_for_is_left_out():
    sheet = read(["xlmc_forecasts", "xlmc_settings"])
    assert dict(sheet.tables.items()) == {
        "xlmc_forecasts": "A6:D7",
        "xlmc_settings": "F6:G7",
    }
    assert sheet["J6"].value == "Distribution: words"


@pytest.mark.parametrize(
    ("row", "cell", "frozen", "value"),
    [
        (7, "=S!B1", False, 1.5),
        (8, "=S!B2", True, "#DIV/0!"),
        (9, "=S!B3", False, None),  # a cutoff of 0 is typed, too
        (10, "=S!B4", False, "text"),
        (11, None, None, None),
    ],
)
def test_a_row_is_frozen_until_its_numbers_are_typed(every, row, cell, frozen, value):
    saved = read([*HEADINGS], data_only=True)
    assert every.cell(row, 2).value == cell
    assert saved.cell(row, 2).value == value
    assert every.cell(row, 13).value == (None if frozen is None else f"=COUNTA(C{row}:J{row})=0")
    assert saved.cell(row, 13).value == frozen


def test_entries_are_written_by_their_kind(every):
    saved = read([*HEADINGS], data_only=True)
    assert [cell.value for cell in every[7]][:12] == ["a", "=S!B1", None, 1, None, 2, None, None, None, None, "m", None]
    assert every["L11"].value is True
    assert [every["O7"].value, every["R7"].value, saved["P7"].value] == ["y", 4, True]
    green = {cell.column_letter for cell in every[7] if cell.fill.fgColor.rgb == "FFE6F4E6"}
    assert green == {*"CDEFGHIJ"} | {"AF", "AG", "AP", "AQ"}


@pytest.mark.parametrize(("row", "column", "expected"), [(0, 2, "=COUNTA(C1:J1)=0"), (8, 5, "=COUNTA(F9:M9)=0")])
def test_what_freezes_a_row(row, column, expected):
    assert frozen_formula(row, column) == expected


CHECKS = [
    ("C7:C1001", "list", "information", f"$AX$7:$AX${6 + len(FAMILIES)}"),
    ("F7:F1001", "custom", "warning", 'OR(D7="",D7<=F7)'),
    ("H7:H1001", "custom", "warning", "H7>=0"),
    ("W7:W1001", "custom", "warning", 'OR(V7="",V7<=W7)'),
    ("AB7:AB1001", "decimal", None, "-1"),
    ("AG7:AG1001", "custom", "warning", 'OR(AF7="",AF7<=AG7)'),
    ("AQ7:AQ1001", "custom", "warning", 'OR(AP7="",AP7<=AQ7)'),
    ("AR7:AR1001", "list", "information", "$AY$7:$AY$9"),
    ("AT7:AT1001", "list", "information", f"$AZ$7:$AZ${6 + len(setting_names())}"),
]


def test_excel_offers_lists_and_warns_of_ends_that_are_turned_over(every):
    result = every.data_validations.dataValidation
    assert [(str(each.sqref), each.type, each.errorStyle, each.formula1) for each in result] == CHECKS
    assert result[4].formula2 == "1"
    assert {each.errorTitle for each in result} == {
        "Distribution", "High", "Std dev", "At most", "Correlation", "Root", "Setting"
    }  # fmt: skip


def test_words_of_the_lists_stand_in_hidden_columns(every):
    lists = {"AX": [*FAMILIES], "AY": ["only", "first", "last"], "AZ": setting_names()}
    for column, words in lists.items():
        assert [cell.value for cell in every[column] if cell.row > 6 and cell.value is not None] == [*words]
    assert [every[f"{column}6"].value for column in lists] == [
        "Distribution: words",
        "Root: words",
        "Setting: words",
    ]
    hidden = [each for each in every.column_dimensions.values() if each.hidden]
    assert [(each.min, each.max) for each in hidden] == [(50, 52)]


def test_the_sheet_is_easy_to_read_and_print(every):
    assert every.freeze_panes == "B7"
    assert not every.sheet_view.showGridLines
    assert every.page_setup.orientation == "landscape"
    assert every.page_setup.fitToHeight == 0
    widths = {key: round(each.width) for key, each in every.column_dimensions.items()}
    assert [widths[column] for column in ("A", "B", "C", "L", "X", "Z", "AT")] == [35, 13, 17, 35, 35, 25, 19]
