"""Binary workbooks and OpenDocument spreadsheets: what is read of them, joined with what LibreOffice converts."""

from __future__ import annotations

import hashlib
import io
import json
import subprocess
import zipfile
from pathlib import Path

import openpyxl
import pytest
from binary_book import binary_book, cell, formula, record, ref, row
from click.testing import CliRunner
from needed_programs import missing

from xlmc.cli import xlmc as command
from xlmc.errors import WorkbookError
from xlmc.excel.workbook.formats import ODS, XLS, XLSB, other_format
from xlmc.excel.workbook.hidden_scripts import HiddenScript, hidden_scripts
from xlmc.excel.workbook.other_formats import joined_package, libreoffice
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.structure import read_structure
from xlmc.excel.workbook.target import copy_ending

ADD, ABOVE = b"\x03", b"\x0d"
EXACT = 0.1 + 0.2
THIRD = 1 / 3

ROWS = (
    row(1, cell(1, "Load"), cell(2, EXACT), cell(3, "kN"))
    + row(2, cell(1, "Own weight"), cell(2, THIRD))
    + row(3, cell(1, "Sum"), formula(2, ref(1, 2) + ref(2, 2) + ADD, EXACT + THIRD))
    + row(4, cell(1, "Above"), formula(2, ref(3, 2) + ref(1, 2) + ABOVE, True))
)
SHORT = {"A1": "Load", "B1": 0.3, "A2": "Own weight", "B2": 0.333333333333333, "B3": "=B1+B2", "B4": "=B3>B1"}
"""What LibreOffice makes of the cells: numbers of 15 digits."""

_SPACES = " ".join(
    f'xmlns:{name}="urn:oasis:names:tc:opendocument:xmlns:{name}:1.0"' for name in ("office", "table", "text")
)


def number(value, **more):
    extra = "".join(f' table:{name.replace("_", "-")}="{given}"' for name, given in more.items())
    return f'<table:table-cell office:value-type="float" office:value="{value!r}"{extra}/>'


def open_document(rows, *, settings="", more=None, title="S"):
    """A spreadsheet with these rows."""
    content = (
        f"<office:document-content {_SPACES}><office:body><office:spreadsheet>{settings}"
        f'<table:table table:name="{title}">{rows}</table:table></office:spreadsheet></office:body>'
        "</office:document-content>"
    )
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as package:
        package.writestr("mimetype", ODS_TYPE)
        package.writestr("content.xml", content)
        for name, data in (more or {}).items():
            package.writestr(name, data)
    return file.getvalue()


ODS_TYPE = "application/vnd.oasis.opendocument.spreadsheet"
ODS_ROWS = (
    f"<table:table-header-rows><table:table-row><table:table-cell/>{number(EXACT)}</table:table-row>"
    "</table:table-header-rows>"
    f"<table:table-row><table:table-cell/>{number(THIRD)}</table:table-row>"
    f"<table:table-row><table:table-cell/>{number(EXACT + THIRD, formula='of:=[.B1]+[.B2]')}</table:table-row>"
    f"<table:table-row><table:table-cell/>{number(1.0, formula='of:=[.B3]&gt;[.B1]')}</table:table-row>"
)

BOOKS = {".xlsb": (XLSB, binary_book({"S": ROWS})), ".ods": (ODS, open_document(ODS_ROWS))}


def converted(cells, title="S"):
    book, file = openpyxl.Workbook(), io.BytesIO()
    book.active.title = title
    for address, value in cells.items():
        book.active[address] = value
    book.save(file)
    return file.getvalue()


@pytest.fixture
def libreoffice_gives(monkeypatch):
    """`libreoffice_gives(cells)`: what LibreOffice is said to make of any workbook."""
    return lambda cells, title="S": monkeypatch.setattr(
        joined_package, "converted_to_xlsx", lambda *_: converted(cells, title)
    )


@pytest.mark.parametrize(("form", "data"), BOOKS.values(), ids=BOOKS)
def test_digits_that_libreoffice_drops_come_back(form, data, libreoffice_gives):
    libreoffice_gives(SHORT)
    assert other_format(data) is form
    book = read_workbook(data, f"case{form.ending}")
    cells = book.sheets["S"].cells
    assert [cells[at, 2].value for at in (1, 2, 3)] == [EXACT, THIRD, EXACT + THIRD]
    assert cells[3, 2].formula.text == "B1+B2"
    (notice,) = (each.message for each in book.notices if "were converted" in each.message)
    assert form.noun in notice
    assert form.saved in notice


def test_a_logical_of_a_binary_workbook_is_one(libreoffice_gives):
    libreoffice_gives(SHORT)
    assert read_workbook(BOOKS[".xlsb"][1], "case.xlsb").sheets["S"].cells[4, 2].value is True


def test_what_is_repeated_in_a_spreadsheet_is_read_once_for_each_cell(libreoffice_gives):
    rows = (
        '<table:table-row table:number-rows-repeated="3"><table:table-cell table:number-columns-repeated="2"/>'
        f"{number(EXACT, number_columns_repeated=2)}<table:covered-table-cell/>{number(THIRD)}</table:table-row>"
    )
    places = {f"{letter}{n}": 0.3 for letter in "CD" for n in (1, 2, 3)} | {
        f"F{n}": 0.333333333333333 for n in (1, 2, 3)
    }
    libreoffice_gives(places)
    cells = read_workbook(open_document(rows), "case.ods").sheets["S"].cells
    assert {(r, c): cells[r, c].value for r in (1, 2, 3) for c in (3, 4, 6)} == {
        (r, c): EXACT if c < 6 else THIRD for r in (1, 2, 3) for c in (3, 4, 6)
    }


SETTINGS = {
    "xlsb": binary_book({"S": row(1, cell(1, 1.0))}, as_displayed=True, manual=True),
    "ods": open_document(
        f"<table:table-row>{number(1.0)}</table:table-row>",
        settings='<table:calculation-settings table:precision-as-shown="true"/>',
        more={"settings.xml": '<config-item config:name="AutoCalculate" config:type="boolean">false</config-item>'},
    ),
}


@pytest.mark.parametrize("data", SETTINGS.values(), ids=SETTINGS)
def test_how_it_is_calculated_is_told(data, libreoffice_gives):
    libreoffice_gives({"A1": 1})
    notices = [each.message for each in read_workbook(data, "case").notices]
    assert any("precision as displayed" in each for each in notices)
    assert any("Calculation is set to manual" in each for each in notices)


MACROS = {
    "xlsb": binary_book({"S": row(1, cell(1, 1.0))}, more={"xl/vbaProject.bin": b"x"}),
    "ods": open_document(
        f"<table:table-row>{number(1.0)}</table:table-row>", more={"Basic/Standard/Module1.xml": "<x/>"}
    ),
}


@pytest.mark.parametrize("data", MACROS.values(), ids=MACROS)
def test_macros_are_left_out_and_that_is_told(data, libreoffice_gives):
    libreoffice_gives({"A1": 1})
    assert [n.message for n in read_workbook(data, "case").notices if "macros of the" in n.message]


def test_hidden_texts_of_a_binary_workbook_come_back(libreoffice_gives):
    """Crystal Ball keeps its definitions there."""
    libreoffice_gives({"A1": 1})
    drawing = (
        '<xml xmlns:v="urn:schemas-microsoft-com:vml" xmlns:x="urn:schemas-microsoft-com:office:excel">'
        '<v:shape id="CB_Block_0"><x:ClientData ObjectType="Pict"><x:ScriptText>abc</x:ScriptText></x:ClientData>'
        "</v:shape></xml>"
    )
    kind = "http://schemas.openxmlformats.org/officeDocument/2006/relationships/vmlDrawing"
    data = binary_book(
        {"S": row(1, cell(1, 1.0))},
        more={"xl/drawings/vmlDrawing1.vml": drawing.encode()},
        relations=f'<Relationship Id="rId1" Type="{kind}" Target="../drawings/vmlDrawing1.vml"/>',
    )
    book = read_workbook(data, "case.xlsb")
    assert list(hidden_scripts(book.parts, read_structure(book.parts))) == [HiddenScript("S", "CB_Block_0", "abc")]


REFUSED = {
    "xlsb, a record cut short": (binary_book({"S": record(5, b"\0")}), "damaged"),
    "xlsb, it ends too early": (binary_book({"S": b"\x05\x7f"}), "it ends too early"),
    "ods, encrypted": (
        open_document("", more={"META-INF/manifest.xml": "<m:encryption-data/>"}),
        "The workbook is encrypted",
    ),
    "ods, endless": (
        open_document(
            '<table:table-row table:number-rows-repeated="1048576">'
            f"{number(1.0, number_columns_repeated=1024)}</table:table-row>"
        ),
        "too many",
    ),
}


@pytest.mark.parametrize(("data", "sentence"), REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_read_is_refused_before_libreoffice_is_started(data, sentence, monkeypatch):
    monkeypatch.setattr(subprocess, "Popen", None)
    with pytest.raises(WorkbookError) as reported:
        read_workbook(data, "case.book")
    assert sentence in str(reported.value)
    assert reported.value.hint


def test_what_both_read_must_agree(libreoffice_gives):
    libreoffice_gives(SHORT | {"B1": 0.4})
    with pytest.raises(
        WorkbookError, match=r"S!B1: LibreOffice has made the number 0.4 of the number 0.3\d*\. Open it"
    ):
        read_workbook(BOOKS[".ods"][1], "case.ods")


@pytest.mark.parametrize(("form", "data"), BOOKS.values(), ids=BOOKS)
def test_without_libreoffice_one_message_says_what_to_do(form, data, tmp_path, monkeypatch):
    monkeypatch.setattr(libreoffice, "_ELSEWHERE", ())
    monkeypatch.setenv("PATH", str(tmp_path))
    path = tmp_path / f"case{form.ending}"
    path.write_bytes(data)
    message = str(CliRunner().invoke(command, ["check", str(path)]).exception)
    assert f"{form.noun}, which xlmc reads with the help of LibreOffice" in message
    assert "Install LibreOffice" in message


def test_what_is_written_of_them_is_an_xlsx():
    for form in (XLS, XLSB, ODS):
        assert copy_ending(Path(f"case{form.ending.upper()}")) == ".xlsx"


needs_libreoffice = pytest.mark.skipif(bool(missing("soffice")), reason=missing("soffice"))


def run(*arguments):
    result = CliRunner().invoke(command, [str(each) for each in arguments])
    assert result.exit_code == 0, (result.output, result.exception)
    return result.output


@needs_libreoffice
def test_a_binary_workbook_is_prepared_and_calculated(tmp_path):
    path = tmp_path / "case.xlsb"
    path.write_bytes(BOOKS[".xlsb"][1])
    before = hashlib.sha256(path.read_bytes()).hexdigest()
    assert "matched" in run("verify", path, "--all")
    assert "Load" in run("prepare", path)
    assert (tmp_path / "case-prepared.xlsx").exists()
    run("calculate", path, "--set", "S!B1=2")
    values = openpyxl.load_workbook(tmp_path / "case-calculated.xlsx", data_only=True)["S"]
    assert [values[at].value for at in ("B1", "B3", "B4")] == [2, 2 + THIRD, True]
    assert hashlib.sha256(path.read_bytes()).hexdigest() == before


@needs_libreoffice
def test_a_spreadsheet_gives_the_trials_of_its_xlsx(tmp_path):
    """LibreOffice keeps tables as database ranges, and logicals as 1 and 0."""
    new = tmp_path / "warranty.xlsx"
    run("new", "warranty", new)
    libre = libreoffice._program()
    profile = f"-env:UserInstallation={(tmp_path / 'profile').as_uri()}"
    asked = [libre, profile, "--headless", "--convert-to", "ods", "--outdir", str(tmp_path), str(new)]
    subprocess.run(asked, check=True, capture_output=True)
    new.unlink()
    path = tmp_path / "warranty.ods"
    before = path.read_bytes()
    assert "differ" not in run("verify", path)
    run("simulate", path, "-n", "2000", "-o", tmp_path / "run.json")
    run("new", "warranty", new)
    run("simulate", new, "-n", "2000", "-o", tmp_path / "expected.json")
    first, second = (
        [(each["name"], each["kind"], each["statistics"]) for each in json.loads(file.read_text("utf-8"))["forecasts"]]
        for file in (tmp_path / "run.json", tmp_path / "expected.json")
    )
    assert first == second
    run("simulate", path, "-n", "2000")
    assert "identical" in run("replay", tmp_path / "warranty-results.xlsx")
    assert path.read_bytes() == before
