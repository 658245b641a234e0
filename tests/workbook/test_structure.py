import pytest

from xlmc.errors import WorkbookError
from xlmc.workbook.model import DefinedName
from xlmc.workbook.structure import read_structure

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"


@pytest.fixture
def structure(book_parts):
    return lambda sheets=None, **pieces: read_structure(book_parts(sheets, **pieces))


@pytest.fixture
def with_chart(book_parts, rels):
    """Tabs Inputs, Chart (a chart sheet) and a hidden Results."""

    def make(in_workbook=""):
        tabs = (
            '<sheet name="Inputs" sheetId="4" r:id="a"/><sheet name="Chart" sheetId="2" r:id="b"/>'
            '<sheet name="Results &amp; more" sheetId="3" state="veryHidden" r:id="c"/>'
        )
        workbook = f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}"><sheets>{tabs}</sheets>{in_workbook}</workbook>'
        pointers = rels(
            ("a", "worksheet", "worksheets/one.xml"),
            ("b", "chartsheet", "chartsheets/two.xml"),
            ("c", "worksheet", "worksheets/three.xml"),
        )
        sheets = dict.fromkeys(["xl/worksheets/one.xml", "xl/chartsheets/two.xml", "xl/worksheets/three.xml"], "<x/>")
        return book_parts({}, more={"xl/workbook.xml": workbook, "xl/_rels/workbook.xml.rels": pointers, **sheets})

    return make


def test_tabs(with_chart):
    sheets = read_structure(with_chart()).sheets
    assert [(sheet.name, sheet.kind, sheet.visible) for sheet in sheets] == [
        ("Inputs", "worksheet", True),
        ("Chart", "chartsheet", True),
        ("Results & more", "worksheet", False),
    ]
    assert [sheet.part for sheet in read_structure(with_chart()).worksheets] == [
        "xl/worksheets/one.xml",
        "xl/worksheets/three.xml",
    ]


def test_names_count_every_tab_also_those_without_cells(with_chart):
    names = (
        "<definedNames><definedName name='Mass'>Inputs!$A$1</definedName>"
        "<definedName name='Mass' localSheetId='2'>'Results &amp; more'!$A$1</definedName>"
        "<definedName name='_xlnm.Print_Area' localSheetId='0' hidden='1'>Inputs!$A$1:$B$2</definedName>"
        "<definedName name='Lost' localSheetId='3'>#REF!</definedName>"
        f"<definedName name='Gone' localSheetId='{'9' * 5000}'/></definedNames>"
    )
    found = read_structure(with_chart(names))
    assert found.names == (
        DefinedName("Mass", "Inputs!$A$1"),
        DefinedName("Mass", "'Results & more'!$A$1", "Results & more"),
        DefinedName("_xlnm.Print_Area", "Inputs!$A$1:$B$2", "Inputs"),
    )
    assert [notice.message for notice in found.strays] == [
        f"the defined name {name!r} belongs to a sheet that does not exist and is left out" for name in ("Lost", "Gone")
    ]


@pytest.mark.parametrize(
    ("properties", "date1904"),
    [
        ("", False),
        ("<workbookPr/>", False),
        ('<workbookPr date1904="1"/>', True),
        ('<workbookPr date1904="false"/>', False),
    ],
)
def test_date1904(structure, properties, date1904):
    assert structure(in_workbook=properties).date1904 is date1904


def test_calculation_settings(structure):
    assert structure(in_workbook='<calcPr calcId="191029" iterate="1"/>').calculation["iterate"] == "1"
    assert structure().calculation == {}


def test_targets(structure):
    found = structure(strings=["<t>a</t>"])
    assert found.target("sharedStrings") == "xl/sharedStrings.xml"
    assert found.target("sheetMetadata") is None


def test_the_workbook_may_have_any_name(book_parts, rels):
    parts = book_parts({"S": ""})
    moved = parts | {
        "_rels/.rels": rels(("x", "officeDocument", "/xl/Book%202.xml")).encode(),
        "xl/Book 2.xml": parts["xl/workbook.xml"],
        "xl/_rels/book 2.xml.rels": parts["xl/_rels/workbook.xml.rels"],  # names match whatever their case
    }
    del moved["xl/workbook.xml"], moved["xl/_rels/workbook.xml.rels"]
    assert [sheet.name for sheet in read_structure(moved).sheets] == ["S"]


def test_strict_files(book_parts):
    strict = {
        name: content.replace(
            b"http://schemas.openxmlformats.org/spreadsheetml/2006", b"http://purl.oclc.org/ooxml/spreadsheetml"
        ).replace(
            b"http://schemas.openxmlformats.org/officeDocument/2006", b"http://purl.oclc.org/ooxml/officeDocument"
        )
        for name, content in book_parts({"S": ""}).items()
    }
    assert b"purl" in strict["_rels/.rels"]
    assert [sheet.part for sheet in read_structure(strict).worksheets] == ["xl/worksheets/sheet1.xml"]


WORKBOOK = f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}"><sheets>{{}}</sheets></workbook>'.format
SHEET = '<sheet name="{}" sheetId="1" r:id="{}"/>'.format


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"_rels/.rels": "<Relationships/>"}, "the file is a zip, but no Excel workbook"),
        ({"xl/workbook.xml": f"<w:document xmlns:w='{MAIN}'/>"}, "an Office document, but no workbook"),
        ({"xl/workbook.xml": "PK"}, "xl/workbook.xml is not well-formed XML"),
        ({"xl/workbook.xml": WORKBOOK(SHEET("A", "none"))}, "the sheet 'A' is missing from the file"),
        ({"xl/workbook.xml": WORKBOOK(SHEET("A", "s1") + SHEET("a", "s2"))}, "the sheet 'A' is in the file twice"),
        ({"xl/workbook.xml": WORKBOOK(SHEET("A", "s1") + SHEET("B", "s1"))}, "the sheet 'A' is in the file twice"),
    ],
)
def test_complaints(structure, more, message):
    with pytest.raises(WorkbookError, match=message) as caught:
        structure({"One": "", "Two": ""}, more=more)
    assert caught.value.hint


def test_a_missing_workbook_part_is_told(book_parts):
    parts = book_parts()
    del parts["xl/workbook.xml"]
    with pytest.raises(WorkbookError, match=r"lacks its workbook part \(xl/workbook.xml\)"):
        read_structure(parts)


def test_a_binary_workbook_is_told(book_parts, rels):
    more = {"_rels/.rels": rels(("w", "officeDocument", "xl/workbook.bin")), "xl/workbook.bin": b"\x83\1\0"}
    with pytest.raises(WorkbookError, match=r"a binary workbook \(.xlsb\)"):
        read_structure(book_parts(more=more))
