"""What Excel reads is read, what can be read can be written, and what cannot be written is told before a run."""

from __future__ import annotations

import io
import zipfile

import pytest
import xlsxwriter

from xlmc.analysis.studies.verify import Status, verify
from xlmc.errors import WorkbookError
from xlmc.excel.address import Area, Cell
from xlmc.excel.workbook.inject import inject
from xlmc.excel.workbook.injection.host import refuse_unwritable
from xlmc.excel.workbook.package import read_parts
from xlmc.excel.workbook.package_check import checked_bytes
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.writer import package_bytes


def built(fill):
    packed = io.BytesIO()
    book = xlsxwriter.Workbook(packed, {"in_memory": True})
    fill(book)
    book.close()
    return read_parts(packed.getvalue())


def two_sheets(book):
    book.add_worksheet("One").write("A1", 1.5)
    book.add_worksheet("Two").write("A1", 2.5)
    book.define_name("Two!local", "=Two!$A$1")


RESULTS = built(lambda book: book.add_worksheet("Results").write("A1", 3.5))


def test_a_module_sheet_keeps_its_place():
    """`localSheetId` counts it; its code lies in the macro project."""
    parts = built(two_sheets)
    module = b'<sheets><sheet name="Module1" sheetId="9" state="veryHidden" r:id=""/>'
    workbook = parts["xl/workbook.xml"].replace(b"<sheets>", module).replace(b'localSheetId="1"', b'localSheetId="2"')
    host = {**parts, "xl/workbook.xml": workbook}
    result = read_workbook(package_bytes(host))
    assert list(result.sheets) == ["One", "Two"]
    assert [(name.name, name.sheet) for name in result.names] == [("local", "Two")]
    again = read_workbook(checked_bytes(inject(host, RESULTS), host))
    assert list(again.sheets) == ["One", "Two", "Results"]
    assert [name.sheet for name in again.names if name.name == "local"] == ["Two"]


@pytest.mark.parametrize(
    ("old", "new", "cell", "value"),
    [
        ('<c r="A1"><v>1.5</v></c>', '<c r="A1" t="s"><v/></c>', "A1", None),
        ('<c r="A1"><v>1.5</v></c>', '<c r="A1" t="s"><v></v></c>', "A1", None),
        ("<v>1.5</v>", "<v> 1.5E+1\n</v>", "A1", 15.0),
        ("<v>1.5</v>", "<v>.5</v>", "A1", 0.5),
    ],
)
def test_values_as_excel_reads_them(old, new, cell, value):
    parts = built(two_sheets)
    sheet = "xl/worksheets/sheet1.xml"
    assert old in parts[sheet].decode()
    result = read_workbook(package_bytes({**parts, sheet: parts[sheet].decode().replace(old, new).encode()}))
    assert result.content(Cell("One", 1, 1)).value == value


@pytest.mark.parametrize("number", ["1_5", "١٥", "1\u00a0", "\u00a01", "0x10", "nan", "1e999", "１５", "1 5", "--1"])
def test_what_is_no_number_is_refused(number):
    parts = built(two_sheets)
    sheet = "xl/worksheets/sheet1.xml"
    damaged = parts[sheet].decode().replace("<v>1.5</v>", f"<v>{number}</v>").encode()
    with pytest.raises(WorkbookError, match="where a number should be"):
        read_workbook(package_bytes({**parts, sheet: damaged})).sheets["One"]


@pytest.mark.parametrize(
    ("merged", "area"),
    [
        ("A:A", Area("One", 1, 1, 1_048_576, 1)),
        ("B:C", Area("One", 1, 2, 1_048_576, 3)),
        ("2:3", Area("One", 2, 1, 3, 16_384)),
    ],
)
def test_whole_columns_and_rows_can_be_merged(merged, area):
    parts = built(two_sheets)
    sheet = "xl/worksheets/sheet1.xml"
    merging = f'</sheetData><mergeCells count="1"><mergeCell ref="{merged}"/></mergeCells>'.encode()
    result = read_workbook(package_bytes({**parts, sheet: parts[sheet].replace(b"</sheetData>", merging)}))
    assert result.sheets["One"].merged == (area,)


def test_part_names_with_backslashes_are_read_as_excel_reads_them():
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as package:
        for name, content in built(two_sheets).items():
            entry = zipfile.ZipInfo(name)
            entry.filename = name.replace("/", "\\")
            package.writestr(entry, content)
    assert b"xl\\worksheets\\sheet1.xml" in packed.getvalue()
    assert read_workbook(packed.getvalue()).content(Cell("Two", 1, 1)).value == 2.5
    with pytest.raises(WorkbookError, match="unsafe name"):
        read_parts(packed.getvalue().replace(b"xl\\worksheets\\sheet1.xml", b"..\\worksheets\\sheet1.xml"))


@pytest.mark.parametrize("values", [(0, 0), (0, ""), ("", "")], ids=["zeros", "a text", "texts"])
def test_what_stands_beside_formulas_that_nobody_calculated_is_no_saved_value(values):
    """XlsxWriter writes 0 beside every formula, and asks Excel to calculate."""

    def fill(book):
        sheet = book.add_worksheet("S")
        sheet.write_formula("A1", '=GETPIVOTDATA("x",B9)', None, values[0])
        sheet.write_formula("A2", '=A1&"x"', None, values[1])

    parts = built(fill)
    assert b"fullCalcOnLoad" in parts["xl/workbook.xml"]
    book = read_workbook(package_bytes(parts))
    assert {book.content(Cell("S", row, 1)).value for row in (1, 2)} == {None}
    assert {check.status for check in verify(book).cells} <= {Status.NOT_CACHED, Status.UNSUPPORTED}


def test_one_value_that_was_calculated_tells_that_all_were():
    def fill(book):
        sheet = book.add_worksheet("S")
        sheet.write_formula("A1", "=1-1", None, 0)
        sheet.write_formula("A2", "=1+1", None, 2)

    book = read_workbook(package_bytes(built(fill)))
    assert [book.content(Cell("S", row, 1)).value for row in (1, 2)] == [0.0, 2.0]


@pytest.mark.parametrize(
    ("part", "content"),
    [
        ("xl/styles.xml", b"<styleSheet"),
        ("xl/styles.xml", b"<other/>"),
        ("[Content_Types].xml", b"<Types"),
    ],
)
def test_what_cannot_be_written_is_told_before(part, content):
    parts = built(two_sheets)
    refuse_unwritable(parts)
    with pytest.raises(WorkbookError, match=part.rpartition("/")[2].replace("[", r"\[").replace("]", r"\]")):
        refuse_unwritable({**parts, part: content})


def test_damaged_properties_stay_as_they_are():
    host = {**built(two_sheets), "docProps/app.xml": b"<Properties"}
    refuse_unwritable(host)
    done = inject(inject(host, RESULTS), RESULTS)
    assert done["docProps/app.xml"] == b"<Properties"
    assert checked_bytes(done, host)


def test_sheets_that_were_added_to_a_workbook_that_nobody_calculated_have_their_values():
    def fill(book):
        book.add_worksheet("Host").write_formula("A1", "=1+1")
        book.add_worksheet("Added").write_formula("A1", "=Host!A1+1", None, 3)

    book = read_workbook(package_bytes(built(fill)))
    assert [book.content(Cell(sheet, 1, 1)).value for sheet in ("Host", "Added")] == [None, 3.0]
