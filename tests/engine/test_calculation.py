"""`xlmc.engine.calculate`: every formula of a workbook, as Excel would show it, or with the reason why not."""

from __future__ import annotations

import openpyxl
import pytest
from openpyxl.worksheet.formula import ArrayFormula

from xlmc import engine, excel
from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell

CELLS = {
    "A1": 2.0,
    "A2": "=A1*3",
    "A3": '="about "&A2',
    "A4": "=A1/0",
    "A5": "=IFERROR(A4,A2>5)",
    "A6": "=LET(x,A2+1,x*x)",
    "A7": "=SUM(A1:A2,Other!A1)",
    "A8": "=OFFSET(A1,A1-1,0)",
    "A9": "=B9",
    "A10": "=NOW()",
    "A11": "=A10+1",
    "A12": "=NOSUCHFUNCTION(A1)",
    "A13": "=IFERROR(A12,0)",
    "A14": "=A15",
    "A15": "=A14+A1",
    "A16": "=A2+1",
}
VALUES = {
    "A2": 6.0,
    "A3": "about 6",
    "A4": ErrorCode.DIV0,
    "A5": True,
    "A6": 49.0,
    "A7": 13.0,
    "A8": 6.0,
    "A9": 0.0,
    "A16": 7.0,
    "C1": 20.0,
    "C2": 60.0,
}
UNKNOWN = {"A10": "NOW", "A11": "depends on", "A12": "NOSUCHFUNCTION", "A13": "depends on", "A14": "", "A15": ""}


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """A book as openpyxl writes it: with formulas, and without a value for any of them."""
    made = openpyxl.Workbook()
    sheet, other = made.active, made.create_sheet("Other")
    sheet.title = "S"
    for place, formula in CELLS.items():
        sheet[place] = formula
    sheet["C1"] = ArrayFormula("C1:C2", "=A1:A2*10")
    other["A1"] = 5
    result = tmp_path_factory.mktemp("calculation") / "book.xlsx"
    made.save(result)
    return result


@pytest.fixture(scope="module")
def calculated(path):
    return engine.calculate(excel.load(path))


@pytest.mark.parametrize(("cell", "value"), VALUES.items())
def test_formulas_that_no_program_calculated_have_their_values(path, calculated, cell, value):
    assert openpyxl.load_workbook(path, data_only=True)["S"][cell].value is None
    assert calculated[f"S!{cell}"] == value
    assert type(calculated[f"S!{cell}"]) is type(value)


@pytest.mark.parametrize(("cell", "text"), UNKNOWN.items())
def test_what_cannot_be_computed_has_no_value_and_a_reason(calculated, cell, text):
    assert calculated[f"S!{cell}"] is None
    (notice,) = (each for each in calculated.notices if str(each.where) == f"S!{cell}")
    assert text in notice.message
    assert "it has no value" in notice.message


def test_the_workbook_itself_stays_as_it_was(path, calculated):
    book = excel.load(path)
    again = engine.calculate(book)
    assert book["S!A2"] is None
    assert again["S!A2"] == 6.0
    assert calculated.sheets["S"].cells[2, 1].formula == book.sheets["S"].cells[2, 1].formula
    assert calculated["S!A1"] == 2.0


def test_saved_values_stay_where_nothing_can_be_computed(workbook):
    """And what depends on them is computed from them; what was saved for other formulas is not looked at."""
    book = workbook({"A1": ("=NOSUCH(1)", 4.0), "A2": ("=A1+1", 99.0), "A3": ("=RAND()", 0.25), "A4": ("=A3*2", 9.0)})
    result = engine.calculate(book)
    assert [result[f"S!A{row}"] for row in (1, 2, 3, 4)] == [4.0, 5.0, 0.25, 0.5]
    named = {str(each.where): each.message for each in result.notices}
    assert named.keys() == {"S!A1", "S!A3"}
    assert all(message.endswith("; the saved value stays") for message in named.values())


def test_a_name_and_a_table_are_read_as_in_excel(workbook, table):
    cells = {"A1": "Low", "A2": 1.0, "A3": 2.0, "B2": "=SUM(T[Low])*Rate", "B3": "=T[@Low]", "D1": 10.0}
    book = workbook(cells, {"Rate": "S!$D$1"}, [table("T", "S!A1:A3", "Low")])
    result = engine.calculate(book)
    assert (result["S!B2"], result["S!B3"], result["Rate"]) == (30.0, 2.0, 10.0)
    assert result.content(Cell("S", 2, 2)).formula is not None
