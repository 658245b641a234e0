"""`xlmc calculate`: a copy with the values of all formulas, and nothing else changed."""

from __future__ import annotations

import csv
import io
import json
import re
import zipfile
from pathlib import Path

import openpyxl
import pytest
from openpyxl.styles import Font
from openpyxl.workbook.defined_name import DefinedName
from openpyxl.worksheet.formula import ArrayFormula

from xlmc import excel
from xlmc.cli.calculate import _exact
from xlmc.errors import ErrorCode

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared" / "conformance" / "workbooks"

CELLS = {
    "A1": 2.0,
    "A2": "=A1*3",
    "A3": '="about "&A2&CHAR(13)&"_x00"&"41_"',
    "A4": "=A1/0",
    "A5": "=A2>5",
    "A6": "=NOSUCHFUNCTION(A1)",
    "A7": "=A6+1",
    "A8": "=NOW()",
    "A9": '=B9&""',
    "A10": "=A2+1",
}


@pytest.fixture
def book(tmp_path):
    """As openpyxl writes it: no formula has a value."""
    made = openpyxl.Workbook()
    made.active.title = "S"
    for place, content in CELLS.items():
        made.active[place] = content
    made.active["A2"].font = Font(bold=True)
    made.active["C1"] = ArrayFormula("C1:C3", "=A1*{1;2;3}/{1;1;0}")
    made.create_sheet("Other")["B1"] = "untouched"
    made.save(tmp_path / "book.xlsx")
    return tmp_path / "book.xlsx"


def parts(path):
    with zipfile.ZipFile(path) as package:
        return {name: package.read(name) for name in package.namelist()}


def without_values(path, new):
    """The workbook as if no program had calculated it."""
    result = parts(path)
    with zipfile.ZipFile(new, "w") as package:
        for name, xml in result.items():
            if name.startswith("xl/worksheets/sheet"):
                xml = re.sub(
                    rb"(<c\b[^>]*?)( t=\"\w+\")?([^>]*>)(<f\b[^>]*?(?:/>|>[^<]*</f>))<v>[^<]*</v>", rb"\1\3\4", xml
                )
            package.writestr(name, xml)
    return new


def test_the_copy_has_values_where_openpyxl_showed_none(xlmc, book):
    outcome = xlmc("calculate", book, "-o", "copy.xlsx")
    result = openpyxl.load_workbook("copy.xlsx", data_only=True)["S"]
    assert [result[f"A{row}"].value for row in (1, 2, 4, 5, 9, 10)] == [2, 6, "#DIV/0!", True, None, 7]
    assert excel.load("copy.xlsx")["S!A3"] == "about 6\r_x0041_"
    assert [result[f"C{row}"].value for row in (1, 2, 3)] == [2, 4, "#DIV/0!"]
    assert openpyxl.load_workbook("copy.xlsx")["S"]["A2"].value == "=A1*3"
    assert openpyxl.load_workbook("copy.xlsx")["S"]["A2"].font.bold
    assert outcome.code == 1
    assert "S!A6: The function NOSUCHFUNCTION is not known to xlmc; it has no value" in outcome.err
    assert "S!A7: The formula depends on a cell that could not be computed" in outcome.err
    assert "S!A8: NOW" in outcome.err
    assert excel.load("copy.xlsx").may_be_stale  # Excel is asked for what xlmc cannot compute


def test_every_part_but_the_sheet_stays_byte_for_byte(xlmc, book):
    xlmc("calculate", book, "-o", "copy.xlsx")
    before, after = parts(book), parts("copy.xlsx")
    assert {name for name in before if before[name] != after[name]} == {"xl/worksheets/sheet1.xml"}
    assert before.keys() == after.keys()


def test_a_book_whose_saved_values_are_right_is_the_same_file(xlmc, case_study):
    outcome = xlmc("calculate", case_study, "-o", "copy.xlsx")
    assert outcome.code == 0
    assert "every saved value stays as it is" in outcome.out
    assert Path("copy.xlsx").read_bytes() == case_study.read_bytes()


@pytest.mark.parametrize("name", ["skid", "momentum", "planar-impact", "time-distance"])
def test_values_that_are_taken_out_come_back(xlmc, tmp_path, name):
    source = ROOT / "templates" / f"{name}.xlsx"
    bare = without_values(source, tmp_path / "bare.xlsx")
    assert xlmc("calculate", bare, "-o", "copy.xlsx").code == 0
    before, after = excel.load(source), excel.load("copy.xlsx")
    count = 0
    for sheet in before.sheets.values():
        for at, content in sheet.cells.items():
            if content.formula is not None:
                value = after.sheets[sheet.name].cells[at].value
                same = pytest.approx(content.value, rel=1e-9) if isinstance(content.value, float) else content.value
                assert value == same, (sheet.name, at)
                count += 1
    assert count > 10


@pytest.mark.skipif(not SHARED.exists(), reason="the Excel-saved workbooks are not beside the project")
@pytest.mark.parametrize(
    "name",
    [
        "apache__FormulaSheetRange.xlsx",
        "ClosedXML__DataTableFormula-Excel-Input.xlsx",
        "ClosedXML__vba-user-function.xlsm",
    ],
)
def test_what_excel_saved_stays(xlmc, name):
    source = next(SHARED.glob(name), None)
    if source is None:
        pytest.skip("not in the folder")
    xlmc("calculate", source, "-o", f"copy{source.suffix}")
    assert Path(f"copy{source.suffix}").read_bytes() == source.read_bytes()


def test_a_change_reaches_what_depends_on_it_and_nothing_else(xlmc, book):
    xlmc("calculate", book, "-o", "first.xlsx", "--volatile")
    outcome = xlmc("calculate", "first.xlsx", "--set", "S!A1=5", "-o", "copy.xlsx")
    result = excel.load("copy.xlsx")
    assert [result[f"S!A{row}"] for row in (1, 2, 4, 10)] == [5.0, 15.0, ErrorCode.DIV0, 16.0]
    assert result["S!A8"] == excel.load("first.xlsx")["S!A8"]  # NOW does not depend on it
    assert [result[f"S!C{row}"] for row in (1, 2, 3)] == [5.0, 10.0, ErrorCode.DIV0]
    assert outcome.code == 1  # NOSUCHFUNCTION(A1)
    assert result["S!A6"] is None


def test_what_cannot_be_computed_keeps_its_value_unless_a_change_reaches_it(xlmc, tmp_path, workbook_file):
    cells = {"A1": 1.0, "B1": 7.0, "A2": ("=NOSUCH(A1)", 4.0), "A3": ("=A2+B1", 11.0), "A4": ("=B1*2", 14.0)}
    path = workbook_file(cells)
    assert xlmc("calculate", path, "-o", "same.xlsx").code == 0
    assert Path("same.xlsx").read_bytes() == path.read_bytes()
    assert xlmc("calculate", path, "--set", "S!B1=8", "-o", "b.xlsx").code == 0
    assert [excel.load("b.xlsx")[f"S!A{row}"] for row in (2, 3, 4)] == [4.0, 12.0, 16.0]
    outcome = xlmc("calculate", path, "--set", "S!A1=8", "-o", "a.xlsx")
    assert outcome.code == 1
    assert [excel.load("a.xlsx")[f"S!A{row}"] for row in (2, 3, 4)] == [None, None, 14.0]
    assert "S!A2: The function NOSUCH is not known to xlmc; it has no value" in outcome.err
    assert "S!A3: The formula depends on" in outcome.err


@pytest.fixture
def workbook_file(tmp_path):
    """Write cells, formulas with the values that a program saved."""

    def write(cells, **names):
        rows = {}
        for place, content in cells.items():
            formula, value = content if isinstance(content, tuple) else ("", content)
            inside = f"<f>{formula[1:]}</f>" if formula else ""
            rows.setdefault(int(place[1:]), []).append((place, f'<c r="{place}">{inside}<v>{value}</v></c>'))
        data = "".join(
            f'<row r="{row}">{"".join(xml for _, xml in sorted(results))}</row>'
            for row, results in sorted(rows.items())
        )
        made = openpyxl.Workbook()
        made.active.title = "S"
        made.defined_names.update({name: DefinedName(name, attr_text=text) for name, text in names.items()})
        made.save(tmp_path / "empty.xlsx")
        result = parts(tmp_path / "empty.xlsx")
        xml = result["xl/worksheets/sheet1.xml"].decode()
        result["xl/worksheets/sheet1.xml"] = re.sub(
            r"<sheetData ?/>|<sheetData></sheetData>", f"<sheetData>{data}</sheetData>", xml
        ).encode()
        with zipfile.ZipFile(tmp_path / "saved.xlsx", "w") as package:
            for name, content in result.items():
                package.writestr(name, content)
        return tmp_path / "saved.xlsx"

    return write


def test_cells_are_printed_as_json_and_as_csv(xlmc, book):
    outcome = xlmc("calculate", book, "--cells", "S!A2:A5", "--json")
    assert json.loads(outcome.out) == {"S!A2": 6.0, "S!A3": "about 6\r_x0041_", "S!A4": "#DIV/0!", "S!A5": True}
    outcome = xlmc("calculate", book, "--cells", "S!A2", "--cells", "S!A5", "--csv")
    assert outcome.out == "Cell,Value\nS!A2,6\nS!A5,TRUE\n"
    assert "S!A10" in xlmc("calculate", book, "--cells", "S!A10").out


def test_each_row_of_values_is_calculated_on_its_own(xlmc, book, tmp_path):
    (tmp_path / "v.csv").write_text("S!A1;#case\n1;first\n2.5;second\n10 %;third\n", encoding="utf-8")
    outcome = xlmc("calculate", book, "--values", "v.csv", "--cells", "S!A2", "--cells", "S!A5", "--csv")
    assert outcome.code == 0
    rows = list(csv.reader(io.StringIO(outcome.out)))
    assert rows[0] == ["S!A1", "#case", "S!A2", "S!A5"]
    assert rows[1:3] == [["1", "first", "3", "FALSE"], ["2.5", "second", "7.5", "TRUE"]]
    assert float(rows[3][2]) == pytest.approx(0.3)
    outcome = xlmc("calculate", book, "--values", "v.csv", "--cells", "S!A2", "-o", "out.json")
    assert [row["S!A2"] for row in json.loads(Path("out.json").read_text(encoding="utf-8"))] == pytest.approx(
        [3, 7.5, 0.3]
    )


def test_a_list_of_cells_and_values_is_one_row(xlmc, book, tmp_path):
    (tmp_path / "v.csv").write_text("Cell,Value\nS!A1,4\nOther!B1,text\n", encoding="utf-8")
    xlmc("calculate", book, "--values", "v.csv", "-o", "copy.xlsx")
    result = excel.load("copy.xlsx")
    assert (result["S!A1"], result["S!A2"], result["Other!B1"]) == (4.0, 12.0, "text")


def test_volatile_functions_are_computed_when_asked(xlmc, workbook_file):
    path = workbook_file(
        {"A1": ("=RAND()", 9.0), "A2": ("=A1*2", 18.0), "A3": ("=RANDBETWEEN(3,3)", 1.0), "A4": ("=NOW()-TODAY()", 5)}
    )
    assert xlmc("calculate", path, "-o", "same.xlsx").code == 0
    assert Path("same.xlsx").read_bytes() == path.read_bytes()
    assert xlmc("calculate", path, "--volatile", "-o", "new.xlsx").code == 0
    result = excel.load("new.xlsx")
    assert 0 <= result["S!A1"] < 1
    assert result["S!A2"] == 2 * result["S!A1"]
    assert result["S!A3"] == 3.0
    assert 0 <= result["S!A4"] < 1


@pytest.mark.parametrize(
    ("text", "kept"),
    [("S!A1,Other!B1\n3,\n", None), ("Cell,Value\nS!A1,3\nOther!B1,\n", None), ("Cell,Value\nS!A1,3\n", "untouched")],
    ids=["a blank field", "a blank value", "a cell that is not named"],
)
def test_only_a_field_that_is_left_blank_empties_its_cell(xlmc, book, tmp_path, text, kept):
    (tmp_path / "v.csv").write_text(text, encoding="utf-8")
    assert xlmc("calculate", book, "--values", "v.csv", "-o", "copy.xlsx").code == 1  # NOSUCHFUNCTION has no value
    result = excel.load("copy.xlsx")
    assert (result["Other!B1"], result["S!A2"]) == (kept, 9.0)


@pytest.mark.parametrize("place", ["S!B:C", "S!B1:C1048576", "Whole"])
def test_whole_columns_end_with_the_last_filled_row(xlmc, workbook_file, place):
    path = workbook_file({"A1": 1.0, "B2": 2.0, "C3": ("=A1+B2", 3.0)}, Whole="S!$B:$C")
    outcome = xlmc("calculate", path, "--cells", place, "--json")
    assert json.loads(outcome.out) == {
        "S!B1": None,
        "S!C1": None,
        "S!B2": 2.0,
        "S!C2": None,
        "S!B3": None,
        "S!C3": 3.0,
    }
    rows = xlmc("calculate", path, "--cells", "S!2:3", "--json")
    assert list(json.loads(rows.out)) == ["S!A2", "S!B2", "S!C2", "S!A3", "S!B3", "S!C3"]


@pytest.mark.parametrize(
    ("typed", "value", "result"),
    [
        ("#DIV/0!", ErrorCode.DIV0, ErrorCode.DIV0),
        ("#n/a", ErrorCode.NA, ErrorCode.NA),
        ("'#N/A", "#N/A", ErrorCode.VALUE),
    ],
)
def test_an_error_value_is_typed_as_such(xlmc, book, tmp_path, typed, value, result):
    (tmp_path / "v.csv").write_text(f"S!A1,#note\n{typed},n\n", encoding="utf-8")
    for given in (["--set", f"S!A1={typed}"], ["--values", "v.csv"]):
        xlmc("calculate", book, *given, "-o", "copy.xlsx", "--overwrite")
        copy = excel.load("copy.xlsx")
        assert (copy["S!A1"], copy["S!A2"]) == (value, result)
    rows = json.loads(xlmc("calculate", book, "--values", "v.csv", "--cells", "S!A2", "--json").out)
    assert rows == [{"S!A1": value if isinstance(value, str) else value.text, "#note": "n", "S!A2": result.text}]


MISTAKES = {
    "a formula": (["--set", "S!A2=4"], ["S!A2", "holds a formula", "computed from"]),
    "an array formula": (["--set", "S!C2=4"], ["S!C1 fills the cell"]),
    "no sheet": (["--set", "T!A2=4"], ["there is no sheet 'T'", "S, Other"]),
    "no cell": (["--set", "speed=4"], ["'speed' is no cell", "Sheet!Cell"]),
    "no equals sign": (["--set", "S!A1"], ["--set Inputs!B3=4.2"]),
    "a comma for decimals": (["--set", "S!A1=0,65"], ["0.65"]),
    "twice": (["--set", "S!A1=1", "--set", "S!$A$1=2"], ["S!A1 is set twice"]),
    "an ending": (["-o", "copy.xlsm"], ["must end in .xlsx"]),
    "no cells": (["-o", "copy.csv"], ["--cells"]),
    "the book itself": (["-o", "book.xlsx"], ["book.xlsx"]),
    "cells of no sheet": (["--cells", "T!A1"], ["--cells T!A1", "there is no sheet"]),
    "json of nothing": (["--json"], ["--cells"]),
    "no file of values": (["--values", "none.csv", "--cells", "S!A2"], ["none.csv", "cannot be read"]),
    "rows into a copy": (
        ["--values", "two.csv", "-o", "copy.xlsx"],
        ["A copy holds the values of one row", "copy.csv"],
    ),
    "a heading": (["--values", "heading.csv", "--cells", "S!A2"], ["Line 1", "'Speed' is no cell", "#"]),
    "a value": (["--values", "comma.csv", "--cells", "S!A2"], ["Line 2", "0.5"]),
    "too many values": (["--values", "long.csv", "--cells", "S!A2"], ["Line 2 has 2 values"]),
    "too few values": (["--values", "short.csv", "-o", "copy.xlsx"], ["Line 2 has 1 value", "2 headings", "separator"]),
    "too few of several rows": (["--values", "rows.csv", "--cells", "S!A2"], ["Line 4 has 1 value", "2 headings"]),
    "a cell without its value": (["--values", "listed.csv", "-o", "copy.xlsx"], ["Line 3 has 1 value", "separator"]),
    "a list with thousands": (["--values", "commas.csv", "-o", "copy.xlsx"], ["Line 2 has 3 values", "commas"]),
    "an output twice": (["-o", "copy.xlsx", "-o", "./copy.xlsx"], ["copy.xlsx", "Two outputs"]),
    "a table twice": (["-o", "copy.csv", "-o", "copy.csv", "--cells", "S!A2"], ["copy.csv", "Two outputs"]),
    "an empty name": (["-o", ""], ["--output", "name of the file is empty"]),
    "a folder": (["-o", "."], ["This is a folder"]),
    "a blank column": (["--cells", "S!Z:Z"], ["S!Z:Z", "holds nothing"]),
}


@pytest.mark.parametrize(("arguments", "message"), MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_one_message_and_nothing_is_written(xlmc, book, tmp_path, arguments, message):
    (tmp_path / "two.csv").write_text("S!A1\n1\n2\n", encoding="utf-8")
    (tmp_path / "heading.csv").write_text("Speed\n1\n", encoding="utf-8")
    (tmp_path / "comma.csv").write_text('S!A1\n"0,5"\n', encoding="utf-8")
    (tmp_path / "long.csv").write_text("S!A1\n1,2\n", encoding="utf-8")
    (tmp_path / "short.csv").write_text("S!A1,Other!B1\n1\n", encoding="utf-8")
    (tmp_path / "rows.csv").write_text("S!A1;Other!B1\n1;a\n2;\n3\n", encoding="utf-8")
    (tmp_path / "listed.csv").write_text("Cell,Value\nS!A1,\nOther!B1\n", encoding="utf-8")
    (tmp_path / "commas.csv").write_text("Cell,Value\nS!A1,1,234\n", encoding="utf-8")
    before = book.read_bytes()
    outcome = xlmc("calculate", book, *arguments)
    assert outcome.code == 2
    assert all(each in outcome.err for each in message), outcome.err
    assert outcome.err.count("\n") == 1
    assert book.read_bytes() == before
    assert not [*tmp_path.glob("copy*"), *tmp_path.glob("book-*")]


@pytest.mark.parametrize(
    ("value", "written"),
    [
        (6.0, 6),
        (-6.0, -6),
        (2.5, 2.5),
        (999_999_999_999_999.0, 999_999_999_999_999),
        (1e15, 1e15),
        (-1e15, -1e15),
        (True, "TRUE"),
        (False, "FALSE"),
        ("six", "six"),
    ],
)
def test_a_value_in_csv_has_all_its_digits(value, written):
    result = _exact(value)
    assert (result, type(result)) == (written, type(written))


def test_functions_that_draw_are_not_called_unknown(xlmc, tmp_path):
    book = openpyxl.Workbook()
    for at, formula in enumerate(
        ["=RiskNormal(1,2)", "=CB.GetForeStatFN(A1,2)", "=_xll.RiskMean(A1)", "=NOSUCH(1)"], 1
    ):
        book.active[f"A{at}"] = formula
    book.save("draws.xlsx")
    outcome = xlmc("calculate", "draws.xlsx", "-o", "copy.xlsx")
    drawn = (
        "Sheet!A1, Sheet!A2, Sheet!A3: The formula draws at random or shows results of a simulation; they have no value"
    )
    assert drawn in " ".join(outcome.err.split())
    assert "Sheet!A4: The function NOSUCH is not known to xlmc; it has no value" in outcome.err
