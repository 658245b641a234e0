"""The workbook of `xlmc new blank`: what a person sees on its three sheets."""

from __future__ import annotations

import io
from pathlib import Path

import openpyxl
import pytest

from xlmc.excel.workbook.reader import read_workbook
from xlmc.outputs.prepared.blank import blank_book

SOURCE = "Example: write what your numbers rest on"


@pytest.fixture(scope="module")
def data():
    return blank_book()


@pytest.fixture(scope="module")
def made(data):
    return openpyxl.load_workbook(io.BytesIO(data))


@pytest.fixture(scope="module")
def saved(data):
    return openpyxl.load_workbook(io.BytesIO(data), data_only=True)


def filled(sheet, rows):
    return [[cell.value for cell in row if cell.value is not None] for row in sheet[rows]]


def test_the_model_is_a_rectangle_with_values_that_its_formulas_give(made, saved):
    assert filled(made["Model"], "A1:H12") == [
        [],
        ["A worked example: replace it by your own model"],
        [],
        ["Length", 12, "m"],
        ["Width", 8, "m"],
        ["Price", 25, "$/m²"],
        [],
        ["Area", "=C4*C5", "m²"],
        ["Cost", "=C8*C6", "$"],
        [],
        [],
        [],
    ]
    assert [cell.value for (cell,) in saved["Model"]["C8:C9"]] == [12 * 8, 12 * 8 * 25]
    model = made["Model"]
    assert model["B2"].font.b
    assert {model[place].fill.fgColor.rgb for place in ("C4", "C5", "C6")} == {"FFE6F4E6"}  # inputs are green
    assert {model[place].border.left.style for place in ("C4", "C5", "C6")} == {"thin"}
    assert model["C8"].fill.fgColor.rgb != "FFE6F4E6"
    assert [round(model.column_dimensions[column].width) for column in "AB"] == [4, 25]


def test_every_input_and_answer_has_a_row(made, saved):
    sheet, values = made["xlmc"], saved["xlmc"]
    assert sheet["A1"].value == "What is uncertain, and what is asked"
    assert filled(sheet, "A7:L10") == [
        ["Length", "=Model!C4", "Normal", 12, 0.5, "m", SOURCE],
        ["Width", "=Model!C5", "Uniform", 7, 9, "m", SOURCE],
        ["Price", "=Model!C6", "BetaPERT", 20, 25, 40, "$/m²", SOURCE],
        [],
    ]
    assert [values.cell(row, 2).value for row in (7, 8, 9)] == [12, 8, 25]
    assert filled(sheet, "O7:R9") == [["Area", "=Model!C8", "m²"], ["Cost", "=Model!C9", "$", 3000], []]
    assert [values.cell(row, 16).value for row in (7, 8)] == [96, 2400]
    assert filled(sheet, "T7:X7") == [["Area", "=Model!C8", 85, 110, SOURCE]]
    assert values["U7"].value == 96
    assert filled(sheet, "Z7:AB7") == [["Length", "Width", 0.3]]
    assert filled(sheet, "AT7:AU7") == [["Trials", 100_000]]


def test_the_guide_has_titles_and_lines(made):
    guide = made["Guide"]
    titles = [cell.value for cell in guide["A"] if cell.font.b]
    assert titles == ["Your own model", "What the distributions are for"]
    assert guide["A9"].value == "5. Save the workbook, close it, and type:"
    assert guide["A13"].value == ""
    assert round(guide.column_dimensions["A"].width) == 121
    assert not guide.sheet_view.showGridLines


def test_the_blank_workbook_runs_as_it_is(xlmc):
    outcome = xlmc("new", "blank", "mine.xlsx")
    assert outcome.code == 0
    assert [*read_workbook(Path("mine.xlsx")).sheets] == ["Model", "Guide", "xlmc"]
    outcome = xlmc("check", "mine.xlsx")
    assert outcome.code == 0
    assert "No problem found" in outcome.out
    assert xlmc("verify", "mine.xlsx", "--all").code == 0
    assert xlmc("new", "blank", "mine.xlsx").code == 2  # it is not replaced
