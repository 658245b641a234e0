from __future__ import annotations

import pytest

from xlmc.errors import WorkbookError
from xlmc.excel.address import Area
from xlmc.excel.workbook.structure import area_of, read_structure, read_table, tables_of
from xlmc.excel.workbook.workbook import DefinedName, Table

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
    assert [notice.message for notice in found.left_out] == [
        f"The defined name {name!r} belongs to a sheet that does not exist and is left out" for name in ("Lost", "Gone")
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
        ({"_rels/.rels": "<Relationships/>"}, "The file is a zip, but not an Excel workbook"),
        ({"xl/workbook.xml": f"<w:document xmlns:w='{MAIN}'/>"}, "an Office document, but not a workbook"),
        ({"xl/workbook.xml": "PK"}, "xl/workbook.xml is not well-formed XML"),
        ({"xl/workbook.xml": WORKBOOK(SHEET("A", "none"))}, "The sheet 'A' is missing from the file"),
        ({"xl/workbook.xml": WORKBOOK(SHEET("A", "s1") + SHEET("a", "s2"))}, "The sheet 'A' is in the file twice"),
        ({"xl/workbook.xml": WORKBOOK(SHEET("A", "s1") + SHEET("B", "s1"))}, "The sheet 'A' is in the file twice"),
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


MAIN_OF_TABLES = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
PART = "xl/worksheets/sheet1.xml"


def table(attributes, *columns):
    listed = "".join(f'<tableColumn id="{n}" name="{name}"/>' for n, name in enumerate(columns, 1))
    return f"<table {MAIN_OF_TABLES} id='1' {attributes}><tableColumns>{listed}</tableColumns></table>".encode()


@pytest.mark.parametrize(
    ("attributes", "rows"),
    [("", (1, 0)), ('headerRowCount="0"', (0, 0)), ('totalsRowCount="1"', (1, 1)), ('totalsRowShown="0"', (1, 0))],
)
def test_a_table(attributes, rows):
    xml = table(f'name="Table1" displayName="xlmc_assumptions" ref="B2:C5" {attributes}', "Name", "Low_x000a_(m/s)")
    expected = Table("xlmc_assumptions", Area("Inputs", 2, 2, 5, 3), ("Name", "Low\n(m/s)"), *rows)
    assert read_table(xml, "xl/tables/table1.xml", "Inputs") == expected


@pytest.mark.parametrize(
    ("attributes", "message"),
    [
        ('ref="A1:C3"', "table 'T' of sheet 'S' does not fit its range A1:C3"),
        ('ref="A1:B2" headerRowCount="2" totalsRowCount="1"', "does not fit"),
        ('ref="A1:B2" headerRowCount="one"', "does not fit"),
        ('ref="A1:B2" totalsRowCount="-1"', "does not fit"),
        (f'ref="A1:B2" totalsRowCount="{"9" * 5000}"', "does not fit"),
        ('ref="somewhere"', "The table 'T' of sheet 'S' has no valid range"),
        ("", "has no valid range"),
    ],
)
def test_complaints_tables(attributes, message):
    with pytest.raises(WorkbookError, match=message):
        read_table(table(f'displayName="T" {attributes}', "a", "b"), "p", "S")


def test_tables_are_found_through_the_sheet(rels):
    parts = {
        "xl/worksheets/_rels/sheet1.xml.rels": rels(
            ("r1", "drawing", "../drawings/drawing1.xml"),
            ("r2", "table", "../tables/table7.xml"),
            ("r3", "table", "/xl/tables/table8.xml"),
        ).encode(),
        "xl/tables/table7.xml": table('displayName="First" ref="A1:A2"', "x"),
        "xl/tables/table8.xml": table('displayName="Second" ref="C1:C2"', "x"),
    }
    assert [found.name for found in tables_of(parts, PART, "S")] == ["First", "Second"]
    assert list(tables_of(parts, "xl/worksheets/sheet2.xml", "T")) == []


def test_a_missing_table_is_told(rels):
    parts = {"xl/worksheets/_rels/sheet1.xml.rels": rels(("r1", "table", "../tables/table1.xml")).encode()}
    with pytest.raises(WorkbookError, match="A table of sheet 'S' is missing"):
        list(tables_of(parts, PART, "S"))


@pytest.mark.parametrize(
    ("reference", "corners"), [("A1:B2", (1, 1, 2, 2)), ("B2:A1", (1, 1, 2, 2)), ("C3", (3, 3, 3, 3))]
)
def test_area_of(reference, corners):
    assert area_of(reference, "S", "a thing") == Area("S", *corners)


@pytest.mark.parametrize("reference", [None, "", "A:B", "A0", "#REF!"])
def test_complaint(reference):
    with pytest.raises(WorkbookError, match="A thing of sheet 'S' has no valid range"):
        area_of(reference, "S", "a thing")
