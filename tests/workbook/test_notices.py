import pytest

from xlmc.address import Area, Cell
from xlmc.workbook.model import DataTable

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
        ('calcMode="manual"', "book.xlsx: calculation is set to manual"),
        ('iterate="1"', "book.xlsx: iterative calculation is on"),
    ],
)
def test_calculation(book, settings, message):
    (found,) = messages(book(in_workbook=f"<calcPr {settings}/>"))
    assert found.startswith(message)


def test_an_ordinary_workbook_gives_none(book):
    assert messages(book(in_workbook='<calcPr calcId="1" calcMode="auto" fullPrecision="1" iterate="0"/>')) == []


READS = "which xlmc does not open: where a formula reads them, it gets the value that Excel stored"


def test_external_links_name_their_files_and_how_old_their_values_are(book, rels):
    pointer = rels(("r1", "externalLinkPath", "file:///C:\\Cases\\Other.xlsx", "External"))
    more = {
        "xl/externalLinks/externalLink1.xml": "<externalLink/>",
        "xl/externalLinks/_rels/externalLink1.xml.rels": pointer,
        "docProps/core.xml": "<c><dcterms:modified xsi:type='x'>2019-03-04T10:00:00Z</dcterms:modified></c>",
    }
    assert messages(book(in_workbook=REFERENCE, rels=[LINK], more=more)) == [
        f"book.xlsx: the workbook links to other files (Other.xlsx), {READS}, of 2019-03-04 or older"
    ]


def test_external_links_without_a_file_or_a_date(book):
    more = {"xl/externalLinks/externalLink1.xml": "<externalLink/>"}
    assert messages(book(rels=[LINK], more=more)) == [
        f"book.xlsx: the workbook links to other files, {READS}, at a time that the file does not tell"
    ]


def test_signatures(book, rels):
    pointers = rels(("w", "officeDocument", "xl/workbook.xml"), ("s", SIGNED, "_xmlsignatures/origin.sigs"))
    (found,) = messages(book(more={"_rels/.rels": pointers, "_xmlsignatures/origin.sigs": b""}))
    assert found.startswith("book.xlsx: the workbook is digitally signed")


def test_names_of_no_sheet(book):
    (found,) = messages(book(in_workbook="<definedNames><definedName name='x' localSheetId='7'/></definedNames>"))
    assert found.startswith("book.xlsx: the defined name 'x' belongs to a sheet that does not exist")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_data_tables(book, book_parts, encoding):
    sheet = book_parts({"One": TABLE})["xl/worksheets/sheet1.xml"].decode()
    found = book({"One": ""}, more={"xl/worksheets/sheet1.xml": sheet.encode(encoding)})
    assert found.data_tables == (DataTable(Area("One", 4, 3, 5, 3), (Cell("One", 1, 2),)),)


def test_every_reason_is_told(book):
    settings = '<calcPr fullPrecision="0" calcMode="manual" iterate="true"/>'
    assert len(book({"One": TABLE}, in_workbook=settings).notices) == 3
