"""What is typed for a cell: on the command line, and in CSV files."""

from __future__ import annotations

import re

import pytest

from xlmc.errors import ErrorCode, WorkbookError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.typed_values import lines_of, read_value_rows, typed_change, typed_value


@pytest.fixture
def book(workbook):
    return workbook({"A1": 1.0, "B2": 2.0, "C3": "=A1*2"}, names={"Rate": "S!$A$1"})


@pytest.fixture
def csv_file(tmp_path):
    def write(text):
        path = tmp_path / "values.csv"
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return path

    return write


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("4.2", 4.2),
        (" 4. ", 4.0),
        (".5", 0.5),
        ("-1e3", -1000.0),
        ("1,234", 1234.0),
        ("12,345,678", 12345678.0),
        ("7 %", 0.07),
        ("$12", 12.0),
        ("1/2/2020", 43832.0),
        ("6:00", 0.25),
        ("true", True),
        ("FALSE", False),
        ("#n/a", ErrorCode.NA),
        ("#DIV/0!", ErrorCode.DIV0),
        ("#SPILL!", "#SPILL!"),  # not an error that can be typed
        ("", None),
        ("  ", None),
        ("'=A1", "=A1"),
        ("'007", "007"),
        ("=", "="),
        ("nan", "nan"),
        ("inf", "inf"),
        ("1e400", "1e400"),
        ("\u0661\u0662", "\u0661\u0662"),
        ("1_000", "1_000"),
        ("wet road ", "wet road "),
    ],
)
def test_a_typed_value_is_what_excel_makes_of_it(book, text, value):
    result = typed_value(text, book)
    assert result == value
    assert type(result) is type(value)


def test_a_typed_date_counts_from_the_first_day_of_its_workbook(workbook):
    assert typed_value("1/2/2020", workbook({}, date1904=True)) == 43832.0 - 1462.0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("=A1", "'=A1' is a formula: type its value"),
        ("0,5", "'0,5' is no number: decimals stand behind a point, as in 0.5"),
        ("-1,25", "as in -1.25"),
        ("1234,567", "as in 1234.567"),
    ],
)
def test_what_is_no_value_is_refused(book, text, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        typed_value(text, book)


@pytest.mark.parametrize(
    ("text", "change"),
    [
        ("S!B2=4.2", (Cell("S", 2, 2), 4.2)),
        ("Rate=7 %", (Cell("S", 1, 1), 0.07)),
        ("A1=a=b", (Cell("S", 1, 1), "a=b")),
        ("A1=", (Cell("S", 1, 1), None)),
    ],
)
def test_a_change_is_a_cell_and_a_value(book, text, change):
    assert typed_change(book, text) == change


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("S!B2", "'S!B2' is no change of a cell"),
        (" =4", "' =4' is no change of a cell"),
        ("X!B2=4", "--set X!B2=4: there is no sheet 'X'"),
        ("A1=0,5", "--set A1=0,5: '0,5' is no number"),
        ("C3=1", "holds a formula"),
    ],
)
def test_what_is_no_change_is_refused(book, text, message):
    with pytest.raises(WorkbookError) as caught:
        typed_change(book, text)
    assert message in str(caught.value)


@pytest.mark.parametrize("mark", [",", ";", "\t"])
def test_rows_are_typed_into_the_cells_of_their_headings(book, csv_file, mark):
    lines = [["# case", "S!A1", "B2"], ["dry", "4.2", ""], ["", "", ""], ["wet", "TRUE", "x"]]
    result = read_value_rows(csv_file("\ufeff" + "\r\n".join(mark.join(line) for line in lines)), book)
    a, b = Cell("S", 1, 1), Cell("S", 2, 2)
    assert result.headings == ("# case", "S!A1", "B2")
    assert result.rows == ({a: 4.2, b: None}, {a: True, b: "x"})
    assert result.given == (
        {"# case": "dry", "S!A1": 4.2, "B2": None},
        {"# case": "wet", "S!A1": True, "B2": "x"},
    )


def test_cells_listed_one_below_the_other_are_one_row(book, csv_file):
    result = read_value_rows(csv_file("Cell,Value,Note\nRate,0.5,\nS!B2,x,why\n"), book)
    assert result.headings == ()
    assert result.given == ({},)
    assert result.rows == ({Cell("S", 1, 1): 0.5, Cell("S", 2, 2): "x"},)


def test_a_text_over_two_lines_counts_as_two(book, csv_file):
    mark, lines = lines_of(csv_file('A1,B2\n"a\nb",2\n\n3,4\n'))
    assert mark == ","
    assert lines == [(1, ["A1", "B2"]), (3, ["a\nb", "2"]), (5, ["3", "4"])]


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        ("", "The file holds no rows", "Write cells as headings"),
        ("A1,B2\n", "The file holds headings, and no row of values", "Add a row"),
        ("A1,$A$1\n1,2\n", "Two headings are the same cell", "Leave one out"),
        ("A1,Speed\n1,2\n", "Line 1: 'Speed' is no cell", "a heading that begins with # is a note"),
        ("A1,C3\n1,2\n", "holds a formula", "Change the cells"),
        ("A1,B2\n1,2\n1,0.5,3\n", "Line 3 has 3 values, and there are 2 headings", "in quotation marks"),
        ("A1,B2\n1\n", "Line 2 has 1 value, and there are 2 headings", "leave its field blank"),
        ("A1;B2\n1;0,5\n", "Line 2: '0,5' is no number", None),
        ("Cell,Value\nA1,1\nB2,2\nS!A1,3\n", "Line 4: S!A1 stands here a second time", "Leave one out"),
        ("Cell,Value\nA1\n", "Line 2 has 1 value, and there are 2 headings", "leave its field blank"),
        ("Cell,Value\nSpeed,1\n", "Line 2: 'Speed' is no cell", None),
        (b"A1\n\xff\n", "The file is not text in UTF-8", "CSV UTF-8"),
    ],
)
def test_a_file_that_cannot_be_typed_is_refused(book, csv_file, text, message, hint):
    with pytest.raises(WorkbookError) as caught:
        read_value_rows(csv_file(text), book)
    assert message in str(caught.value)
    assert hint in caught.value.hint if hint else caught.value.hint is None


def test_a_file_that_is_not_there_is_refused(tmp_path, book):
    with pytest.raises(WorkbookError, match="cannot be read"):
        read_value_rows(tmp_path / "none.csv", book)


def test_a_file_has_so_many_lines_at_most(csv_file, monkeypatch):
    monkeypatch.setattr("xlmc.excel.workbook.typed_values._MOST_ROWS", 3)
    assert len(lines_of(csv_file("A1\n1\n2\n"))[1]) == 3
    with pytest.raises(WorkbookError, match="more than 3 lines"):
        lines_of(csv_file("A1\n1\n2\n3\n"))
