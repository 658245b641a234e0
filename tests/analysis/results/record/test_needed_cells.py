from __future__ import annotations

import io
import random

import openpyxl
import pytest
from fewer_sheets import leave_out
from hypothesis import given
from hypothesis import strategies as st
from packed_sheets import packed_sheets
from simulated import simulated

from xlmc.analysis.results.record.needed_cells import (
    MOST_ROWS,
    cell_section,
    content_text,
    needed_contents,
    recorded_cells,
    structure_section,
)
from xlmc.analysis.results.record.record_parts import Entry, Record, Section, read_record
from xlmc.analysis.results.record.settings_table import recorded_settings, settings_section
from xlmc.errors import ErrorCode, WorkbookError
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula.shape import shape_of, text_at
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.workbook import CellContent, Formula
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.sheets import book

TEXTS = {
    "A1+B2": "B3+C4",
    "$A1+A$1+$A$1": "$A3+B$1+$A$1",
    "SUM(A1:B2,C:D,3:4)": "SUM(B3:C4,D:E,5:6)",
    "SUM($C:D,$3:4)": "SUM($C:E,$3:6)",
    "'A1 B1'!A1&\"A1\"&Sheet1!A1": "'A1 B1'!B3&\"A1\"&Sheet1!B3",
    "Table1[A1]+LOG10(A1)+ABC1234567": "Table1[A1]+LOG10(B3)+ABC1234567",
    "XFD1048576": "A2",  # round the edge of the sheet, as Excel
}


@pytest.mark.parametrize(("text", "expected"), TEXTS.items())
def test_a_formula_filled_down_and_to_the_right(text, expected):
    assert text_at(text, 2, 1) == expected
    assert text_at(text, 0, 0) == text


@given(
    st.lists(st.sampled_from(["A10", "$B$20", "C$30", "$D40", "SUM(E5:F60)", "12", '"G7"', "Rate", "H:J"]), min_size=1),
    st.integers(0, 50),
    st.integers(0, 50),
)
def test_what_was_filled_has_the_shape_it_had(parts, down, right):
    text = "+".join(parts)
    assert shape_of(text_at(text, down, right), 50 + down, 3 + right) == shape_of(text, 50, 3)
    assert text_at(text_at(text, down, right), -down, -right) == text


def held(workbook, value=None, formula=None):
    return workbook({"B2": CellContent(value, formula)}), Cell("S", 2, 2)


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (None, ""),
        (6661.0, "6661"),
        (0.1 + 0.2, "0.30000000000000004"),
        (True, "TRUE"),
        (False, "FALSE"),
        ('say "a"', '"say ""a"""'),
        ("=A1", '"=A1"'),
        ("6661", '"6661"'),
        (ErrorCode.DIV0, "#DIV/0!"),
    ],
)
def test_a_value_as_a_formula_writes_it(workbook, value, expected):
    assert content_text(*held(workbook, value)) == expected


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        (Formula("A1*2", 2, 2), "=A1*2"),
        (Formula("A1*2", 1, 2), "=A2*2"),
        (Formula("A1:A3*2", 2, 2, Area("S", 2, 2, 4, 2)), "{=A1:A3*2} in B2:B4"),
        (Formula("A1:A3*2", 2, 2, Area("S", 2, 2, 4, 2), dynamic=True), "=A1:A3*2"),
    ],
)
def test_a_formula_as_it_reads_in_its_cell(workbook, formula, expected):
    assert content_text(*held(workbook, 5.0, formula)) == expected


def test_a_value_that_excel_saved_and_xlmc_takes(workbook):
    result = held(workbook, 45000.5, Formula("NOW()", 2, 2))
    assert content_text(*result, {result[1]}) == "=NOW()  (Excel saved 45000.5)"


def test_the_cells_that_a_run_needs(book):
    model = book(
        {"A1": 1.0, "A2": 2.0, "A4": 5.0, "B1": "=A1*SUM(A2:A5)", "C1": 3.0, "C2": "=C1", "D1": 9.0, "T!A1": 4.0},
        {"a": {"cell": "A1", "low": 0, "high": 1}, "idle": {"cell": "D1", "low": 0, "high": "T!A1"}},
        {"x": "B1"},
        sheets=("T",),
    )
    assert {str(cell): text for cell, text in needed_contents(model).items()} == {
        "S!A1": "1",
        "S!B1": "=A1*SUM(A2:A5)",
        "S!A2": "2",
        "S!A4": "5",
        "S!D1": "9",
    }


def test_calls_in_cells_are_recorded_as_they_stand(tmp_path):
    written = openpyxl.Workbook()
    written.active["A1"] = "=10+RiskNormal(5,1)*B1"
    written.active["B1"] = 2
    written.active["C1"] = '=RiskOutput("x")+A1'
    written.save(tmp_path / "risk.xlsx")
    assert needed_contents(load(tmp_path / "risk.xlsx")) == {
        Cell("Sheet", 1, 1): "=10+RiskNormal(5,1)*B1",
        Cell("Sheet", 1, 2): "2",
        Cell("Sheet", 1, 3): '=RiskOutput("x")+A1',
    }


def test_what_excel_saved_is_recorded_where_a_run_takes_it(book):
    cells = {"A1": 1.0, "C1": ("=TODAY()", 45000.0), "B1": "=A1*C1"}
    model = book(cells, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"x": "B1"})
    assert needed_contents(model)[Cell("S", 1, 3)] == "=TODAY()  (Excel saved 45000)"


def many(n):
    draw = random.Random(3)
    return {Cell("My sheet", row, 2): f"=B{row - 1}*{draw.random()}" for row in range(2, n + 2)}


@pytest.mark.parametrize(("n", "listed"), [(0, True), (5, True), (MOST_ROWS, True), (MOST_ROWS + 1, False)])
def test_cells_are_listed_or_packed_and_read_back(n, listed):
    needed = many(n)
    section = cell_section(needed)
    assert (section.table is not None) == listed
    assert recorded_cells(Record((section,))) == needed


def test_a_content_too_long_for_a_cell_is_packed():
    needed = {Cell("S", 1, 1): '"' + "a" * 32_500 + '"'}
    section = cell_section(needed)
    assert section.table is None
    assert recorded_cells(Record((section,))) == needed


def test_packed_cells_come_through_a_worksheet(run, monkeypatch):
    leave_out(monkeypatch, *(sheet.name for sheet in book.SHEETS if sheet.name != "Record"))
    monkeypatch.setattr("xlmc.analysis.results.record.needed_cells._PIECE", 100)
    monkeypatch.setattr("xlmc.analysis.results.record.make.cell_section", lambda needed: cell_section(needed, rows=0))
    record = read_record(read_workbook(packed_sheets(run)))
    assert record["cells.packed_2"]
    assert recorded_cells(record) == needed_contents(run.model)


@pytest.mark.parametrize(
    "changes",
    [{"packed_1": "!"}, {"packed_1": "AAAA"}, {"sha256": "0"}, {"count": 3}],
    ids=["no base64", "nothing packed", "another digest", "another count"],
)
def test_packed_cells_that_were_edited_are_refused(changes):
    section = cell_section(many(20), rows=0)
    entries = tuple(Entry(e.key, e.label, changes.get(e.key, e.value)) for e in section.entries)
    with pytest.raises(WorkbookError, match="The cells in the record"):
        recorded_cells(Record((Section("cells", "", entries),)))


def structure(model):
    section = structure_section(model, needed_contents(model).values())
    return [(row["what"], row["name"], row["means"]) for row in Record((section,)).rows("structure")]


def test_names_are_those_that_the_cells_mention_and_those_mention_in_turn(book):
    cells = {"A1": 1.0, "A2": 2.0, "B1": "=A1*Rate"}
    names = {"Rate": "Base*2", "Base": "S!$A$2", "Unused": "S!$A$9", "_xlnm.Print_Area": "S!$A$1"}
    model = book(cells, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"x": "B1"}, names=names)
    assert structure(model) == [("defined name", "Base", "S!$A$2"), ("defined name", "Rate", "Base*2")]


def test_a_name_of_one_sheet_says_so(book):
    model = book(
        {"A1": 1.0, "A2": 2.0, "B1": "=A1*Rate"},
        {"a": {"cell": "A1", "low": 0, "high": 1}},
        {"x": "B1"},
        names={"S!Rate": "S!$A$2"},
    )
    assert structure(model) == [("defined name", "S!Rate", "S!$A$2")]


@pytest.mark.parametrize(
    ("function", "listed"),
    [
        ("SUBTOTAL(109,A2:A9)", [("hidden rows", "S", "3-5, 9")]),
        ("AGGREGATE(9,5,A2:A9)", [("hidden rows", "S", "3-5, 9")]),
        ("SUM(A2:A9)", []),
    ],
)
def test_hidden_rows_are_told_of_sheets_that_are_read_where_a_function_asks_for_them(tmp_path, function, listed):
    written = openpyxl.Workbook()
    sheets = [written.active, written.create_sheet("T"), written.create_sheet("U")]
    sheets[0].title = "S"
    sheets[0]["B1"] = f'=RiskOutput("x")+RiskUniform(0,1)+{function}+T!A1'
    for sheet, hidden in zip(sheets, ((3, 4, 5, 9), (), (2,)), strict=True):
        for row in range(1, 11):
            sheet.cell(row, 1).value = row
        for row in hidden:
            sheet.row_dimensions[row].hidden = True
    written.save(tmp_path / "book.xlsx")
    assert structure(load(tmp_path / "book.xlsx")) == listed


def test_tables_are_those_that_the_cells_mention(book, table):
    model = book(
        {"A1": 1.0, "C1": "Low", "C2": 2.0, "B1": "=A1*SUM(Data[Low])"},
        {"a": {"cell": "A1", "low": 0, "high": 1}},
        {"x": "B1"},
        tables=[table("Data", "S!C1:C2", "Low"), table("Other", "S!E1:E2", "x", totals_rows=1)],
    )
    assert structure(model) == [("table", "Data", "S!C1:C2: Low")]


def test_settings_are_read_back_exactly(model, monkeypatch):
    leave_out(monkeypatch, *(sheet.name for sheet in book.SHEETS if sheet.name != "Record"))
    for asked in (
        {"until_accepted": 20},
        {"precision": "20 %", "precision_of": "p50,mean", "confidence": 0.9, "forecasts": ["area", "copy"]},
        {"precision": 0.5, "forecasts": "area", "time_limit": 0.0123456789},
        {"adaptive": 1, "forecasts": "area", "trials": 500},
        {"sampling": "sobol", "seed": 10**30},
    ):
        run = simulated(model, **{"trials": 100} | asked)
        record = read_record(read_workbook(packed_sheets(run)))
        assert recorded_settings(record) == run.settings
        assert recorded_settings(Record((settings_section(run),))) == run.settings


def test_a_record_alone_in_a_workbook_is_found(run, monkeypatch):
    """As Excel saves it where its user has deleted the other sheets."""
    leave_out(monkeypatch, *(sheet.name for sheet in book.SHEETS if sheet.name not in ("Results", "Record")))
    saved = openpyxl.load_workbook(io.BytesIO(packed_sheets(run)))
    del saved["Results"]
    assert saved.sheetnames == ["Record"]
    kept = io.BytesIO()
    saved.save(kept)
    assert read_record(read_workbook(kept.getvalue()))["counts.accepted"] == run.accepted
