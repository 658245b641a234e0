from __future__ import annotations

import hashlib
import os

import openpyxl
import pytest
import xlsxwriter

from xlmc.errors import ErrorCode, WorkbookError
from xlmc.excel.address import Area, Cell
from xlmc.excel.iteration import Iteration
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.workbook import DataTable, DefinedName, Formula, Table, Workbook


@pytest.fixture
def written(tmp_path):
    """A workbook as XlsxWriter writes it, with a bit of everything."""
    path = tmp_path / "My case.xlsx"
    with xlsxwriter.Workbook(path) as book:
        inputs, chart, hidden = book.add_worksheet("Inputs"), book.add_chartsheet("Plot"), book.add_worksheet("Sums")
        inputs.add_table("A1:B3", {"name": "xlmc_assumptions", "columns": [{"header": "Name"}, {"header": "Low\n(m)"}]})
        inputs.write_column("A2", ["Mass", "Speed"])
        inputs.write_column("B2", [1500, 12.5])
        inputs.merge_range("D1:E2", "merged")
        inputs.write_dynamic_array_formula("G1", "=SORT(B2:B3)", None, 12.5)
        inputs.write_array_formula("H1:H2", "{=B2:B3*2}", None, 3000)
        inputs.write_rich_string("A9", "Δ", book.add_format({"bold": True}), "V ")
        hidden.write_formula("A1", '=Inputs!B2&""', None, "1500")
        hidden.write_formula("A2", "=1/0", None, "#DIV/0!")
        hidden.write_formula("A3", "=2>1", None, True)
        hidden.write_blank("A4", None, book.add_format({"bold": True}))
        hidden.hide()
        book.define_name("Mass", "=Inputs!$B$2")
        book.define_name("Sums!Local", "=Sums!$A$1")
        picture = book.add_chart({"type": "line"})
        picture.add_series({"values": "=Inputs!$B$2:$B$3"})
        chart.set_chart(picture)
    return path


def test_the_whole_of_a_workbook(written):
    book = read_workbook(written)
    assert isinstance(book, Workbook)
    assert (book.name, list(book.sheets), book.date1904, book.notices) == (
        "My case.xlsx",
        ["Inputs", "Sums"],
        False,
        (),
    )
    assert book.tables == (Table("xlmc_assumptions", Area("Inputs", 1, 1, 3, 2), ("Name", "Low\n(m)")),)
    assert set(book.names) == {DefinedName("Mass", "Inputs!$B$2"), DefinedName("Local", "Sums!$A$1", "Sums")}
    assert [sheet.visible for sheet in book.sheets.values()] == [True, False]
    assert book.sheets["Inputs"].merged == (Area("Inputs", 1, 4, 2, 5),)


@pytest.mark.parametrize(
    ("sheet", "place", "value", "formula"),
    [
        ("Inputs", (2, 2), 1500.0, None),
        ("Inputs", (1, 4), "merged", None),
        ("Inputs", (9, 1), "ΔV ", None),
        ("Inputs", (1, 7), 12.5, Formula("_xlfn._xlws.SORT(B2:B3)", 1, 7, Area("Inputs", 1, 7, 1, 7), dynamic=True)),
        ("Inputs", (1, 8), 3000.0, Formula("B2:B3*2", 1, 8, Area("Inputs", 1, 8, 2, 8))),
        ("Sums", (1, 1), "1500", Formula('Inputs!B2&""', 1, 1)),
        ("Sums", (2, 1), ErrorCode.DIV0, Formula("1/0", 2, 1)),
        ("Sums", (3, 1), True, Formula("2>1", 3, 1)),
        ("Sums", (4, 1), None, None),
    ],
)
def test_its_cells(written, sheet, place, value, formula):
    result = read_workbook(written).content(Cell(sheet, *place))
    assert (result.value, result.formula) == (value, formula)
    assert type(result.value) is type(value)


def test_parts_and_fingerprints(written):
    data = written.read_bytes()
    book = read_workbook(data, name="other.xlsx")
    assert book.name == "other.xlsx"
    assert book.sha256 == hashlib.sha256(data).hexdigest()
    assert book.parts["xl/workbook.xml"].startswith(b"<?xml")
    assert read_workbook(data).name == "workbook"


def test_a_path_as_text(written):
    assert read_workbook(str(written)).name == "My case.xlsx"


@pytest.mark.parametrize("date1904", [False, True])
def test_date_systems(tmp_path, date1904):
    book = openpyxl.Workbook()
    book.epoch = openpyxl.utils.datetime.MAC_EPOCH if date1904 else openpyxl.utils.datetime.WINDOWS_EPOCH
    book.save(tmp_path / "dates.xlsx")
    assert read_workbook(tmp_path / "dates.xlsx").date1904 is date1904


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(WorkbookError, match="There is no such file") as caught:
        read_workbook(tmp_path / "none.xlsx")
    assert caught.value.where == str(tmp_path / "none.xlsx")


def test_a_folder(tmp_path):
    with pytest.raises(WorkbookError, match="This is a folder"):
        read_workbook(tmp_path)


def test_a_file_of_another_person(tmp_path, monkeypatch):
    def refuse(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("pathlib.Path.open", refuse)  # whoever runs the tests may be allowed to read everything
    with pytest.raises(WorkbookError, match="The file may not be read"):
        read_workbook(tmp_path / "locked.xlsx")


@pytest.mark.parametrize("name", ["a\0b.xlsx", "x" * 5000])
def test_a_name_no_file_can_have(name):
    with pytest.raises(WorkbookError, match="The file cannot be read"):
        read_workbook(name)


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="needs an endless file")
def test_an_endless_file(monkeypatch):
    monkeypatch.setattr("xlmc.excel.workbook.reader.LIMITS", type("Small", (), {"total": 1 << 20}))
    with pytest.raises(WorkbookError, match="The file is larger than 1 MB"):
        read_workbook("/dev/zero")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs a named pipe")
def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe.xlsx")
    with pytest.raises(WorkbookError, match="This is a pipe, not a file"):
        read_workbook(tmp_path / "pipe.xlsx")


PLAIN = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml"
WITH_MACROS = "application/vnd.ms-excel.sheet.macroEnabled.main+xml"
TEMPLATE = "application/vnd.openxmlformats-officedocument.spreadsheetml.template.main+xml"
TEMPLATE_WITH_MACROS = "application/vnd.ms-excel.template.macroEnabled.main+xml"


@pytest.mark.parametrize(
    ("name", "kind", "meant"),
    [
        ("book.xlsx", PLAIN, None),
        ("book.XLSM", WITH_MACROS, None),
        ("book.xltx", TEMPLATE, None),
        ("book.xltm", TEMPLATE_WITH_MACROS, None),
        ("book.zip", PLAIN, None),
        ("book.xlsx", "application/xml", None),
        ("book.xlsx", WITH_MACROS, ".xlsm"),
        ("book.XLSM", PLAIN, ".xlsx"),
        ("book.xltm", TEMPLATE, ".xltx"),
        ("book.xlsm", TEMPLATE_WITH_MACROS, ".xltm"),
    ],
)
def test_an_ending_with_which_excel_does_not_open_the_file(name, kind, meant, book_parts, zipped):
    types = (
        '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
        f'<Override PartName="/xl/Workbook.xml" ContentType="{kind}"/></Types>'
    )
    read = read_workbook(zipped(book_parts(more={"[Content_Types].xml": types})), name=name)
    assert [notice.message.partition("; ")[2] for notice in read.notices if "by its content" in notice.message] == (
        [] if meant is None else [f"rename it to end in {meant}"]
    )


def test_complaints_name_the_file(tmp_path):
    path = tmp_path / "notes.xlsx"
    path.write_text("not a workbook", encoding="utf-8")
    with pytest.raises(WorkbookError) as caught:
        read_workbook(path)
    assert str(caught.value) == (
        f"{path}: The file is plain text (such as .csv), not an Excel workbook. "
        "Open it in Excel and save it as an Excel Workbook (.xlsx)."
    )


LINK = ("link", "externalLink", "externalLinks/externalLink1.xml")
REFERENCE = '<externalReferences><externalReference r:id="link"/></externalReferences>'
TABLE = '<sheetData><row r="4"><c r="C4"><f t="dataTable" ref="C4:C5" r1="B1"/><v>1</v></c></row></sheetData>'
SIGNED = "http://schemas.openxmlformats.org/package/2006/relationships/digital-signature/origin"


def messages(book):
    return [str(notice) for notice in book.notices]


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ('fullPrecision="0"', "book.xlsx: Excel calculates this workbook with precision as displayed"),
        ('calcMode="manual"', "book.xlsx: Calculation is set to manual"),
    ],
)
def test_calculation(book, settings, message):
    (result,) = messages(book(in_workbook=f"<calcPr {settings}/>"))
    assert result.startswith(message)


def test_an_ordinary_workbook_gives_none(book):
    assert messages(book(in_workbook='<calcPr calcId="1" calcMode="auto" fullPrecision="1" iterate="0"/>')) == []


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ("", None),
        ('iterate="0" iterateCount="5"', None),
        ('iterate="1"', Iteration(100, 0.001)),
        ('iterate="true" iterateCount="20" iterateDelta="1E-4"', Iteration(20, 0.0001)),
        ('iterate="1" iterateCount="0" iterateDelta="-1"', Iteration(100, 0.001)),
        ('iterate="1" iterateCount="99999" iterateDelta="none"', Iteration(100, 0.001)),
        ('iterate="1" iterateDelta="0"', Iteration(100, 0.0)),
    ],
)
def test_iterative_calculation(book, settings, expected):
    result = book(in_workbook=f"<calcPr {settings}/>")
    assert (result.iteration, messages(result)) == (expected, [])


READS = "which xlmc does not open: where a formula reads them, it gets the value that Excel stored"


def test_external_links_name_their_files_and_how_old_their_values_are(book, rels):
    pointer = rels(("r1", "externalLinkPath", "file:///C:\\Cases\\Other.xlsx", "External"))
    more = {
        "xl/externalLinks/externalLink1.xml": "<externalLink/>",
        "xl/externalLinks/_rels/externalLink1.xml.rels": pointer,
        "docProps/core.xml": "<c><dcterms:modified xsi:type='x'>2019-03-04T10:00:00Z</dcterms:modified></c>",
    }
    assert messages(book(in_workbook=REFERENCE, rels=[LINK], more=more)) == [
        f"book.xlsx: The workbook links to other files (Other.xlsx), {READS}, of 2019-03-04 or older"
    ]


def test_external_links_without_a_file_or_a_date(book):
    more = {"xl/externalLinks/externalLink1.xml": "<externalLink/>"}
    assert messages(book(rels=[LINK], more=more)) == [
        f"book.xlsx: The workbook links to other files, {READS}, at a time that the file does not tell"
    ]


def test_signatures(book, rels):
    pointers = rels(("w", "officeDocument", "xl/workbook.xml"), ("s", SIGNED, "_xmlsignatures/origin.sigs"))
    (result,) = messages(book(more={"_rels/.rels": pointers, "_xmlsignatures/origin.sigs": b""}))
    assert result.startswith("book.xlsx: The workbook is digitally signed")


def test_names_of_no_sheet(book):
    (result,) = messages(book(in_workbook="<definedNames><definedName name='x' localSheetId='7'/></definedNames>"))
    assert result.startswith("book.xlsx: The defined name 'x' belongs to a sheet that does not exist")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_data_tables(book, book_parts, encoding):
    sheet = book_parts({"One": TABLE})["xl/worksheets/sheet1.xml"].decode()
    result = book({"One": ""}, more={"xl/worksheets/sheet1.xml": sheet.encode(encoding)})
    assert result.data_tables == (DataTable(Area("One", 4, 3, 5, 3), (Cell("One", 1, 2),)),)


def test_every_reason_is_told(book):
    settings = '<calcPr fullPrecision="0" calcMode="manual"/>'
    assert len(book({"One": TABLE}, in_workbook=settings).notices) == 2


@pytest.mark.parametrize(
    ("settings", "stale"), [('calcMode="manual"', True), ('fullCalcOnLoad="1"', True), ('calcMode="auto"', False)]
)
def test_saved_values_may_be_stale_where_excel_did_not_calculate(book, settings, stale):
    assert book({"One": ""}, in_workbook=f"<calcPr {settings}/>").may_be_stale is stale
