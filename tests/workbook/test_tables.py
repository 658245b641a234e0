import pytest

from xlmc.address import Area
from xlmc.errors import WorkbookError
from xlmc.workbook.model import Table
from xlmc.workbook.structure import read_table, tables_of

MAIN = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
PART = "xl/worksheets/sheet1.xml"


def table(attributes, *columns):
    listed = "".join(f'<tableColumn id="{n}" name="{name}"/>' for n, name in enumerate(columns, 1))
    return f"<table {MAIN} id='1' {attributes}><tableColumns>{listed}</tableColumns></table>".encode()


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
        ('ref="somewhere"', "the table 'T' of sheet 'S' has no valid range"),
        ("", "has no valid range"),
    ],
)
def test_complaints(attributes, message):
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
    with pytest.raises(WorkbookError, match="a table of sheet 'S' is missing"):
        list(tables_of(parts, PART, "S"))
