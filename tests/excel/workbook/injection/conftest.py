"""Two workbooks: results as the report builds them, and a scene that holds all that openpyxl would lose."""

from __future__ import annotations

import io
import posixpath
import struct
import zlib

import pytest
import xlsxwriter

from xlmc.excel.workbook.package import read_parts

CONTENT_TYPES, WORKBOOK, RELS = "[Content_Types].xml", "xl/workbook.xml", "xl/_rels/workbook.xml.rels"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"


def _png():
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", 8, 8, 8, 2, 0, 0, 0)
    pixels = zlib.compress(b"".join(b"\0" + b"\x30\x60\xc0" * 8 for _ in range(8)))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels) + chunk(b"IEND", b"")


def _built(fill):
    packed = io.BytesIO()
    book = xlsxwriter.Workbook(packed, {"in_memory": True})
    fill(book)
    book.close()
    return read_parts(packed.getvalue())


def _fill_results(book, mean=31.5):
    head = book.add_format({"bold": True, "bg_color": "#DDEBF7", "border": 1, "text_wrap": True})
    number = book.add_format({"num_format": "0.000", "align": "right"})
    speed = book.add_format({"num_format": '0.0 "km/h"'})
    results, chevy, trials = (book.add_worksheet(name) for name in ("Results", "Chevy's chart", "Trials"))
    results.write_row("A1", ["Forecast", "Mean", "Median"], head)
    results.write("A2", "Chevy ΔV < 40 & rising")
    results.write_rich_string("A3", "Ford ", head, "ΔV", " (km/h) ")
    results.write("A4", "  indented")
    results.write_row("B2", [mean, 30.25], number)
    results.write("B3", 12.5, speed)
    results.write("B4", 12.5)
    results.write_boolean("C4", True)
    results.write_formula("C3", "=AVERAGE(Trials!B2:B4)", number, 31)
    results.write_url("A6", "internal:'Chevy''s chart'!A1", string="the chart")
    results.write_url("A7", "https://example.org/?a=1&b=2")
    results.merge_range("E1:F1", "merged", head)
    results.set_column("A:A", 30)
    results.set_column("C:D", 12, number)
    results.set_row(8, 20, head)
    results.freeze_panes(1, 1)
    results.repeat_rows(0)
    results.print_area("A1:F9")
    red = book.add_format({"font_color": "#9C0006", "num_format": "0.0000"})
    results.conditional_format("B2:B4", {"type": "cell", "criteria": ">", "value": 20, "format": red})
    results.conditional_format("B2:B4", {"type": "data_bar", "data_bar_2010": True})
    picture = {"image_data": io.BytesIO(_png()), "url": "internal:Results!B2"}
    results.insert_image("H2", "mark.png", picture)
    rows = [[1, 30.5], [2, 31.0], [3, 31.5]]
    columns = [{"header": "Trial"}, {"header": "Chevy ΔV", "format": number}]
    trials.add_table("A1:B4", {"name": "Trials", "columns": columns, "data": rows})
    trials.autofilter("D1:D9")
    trials.write_formula("F1", "=SUM(Trials[Trial])", None, 6)
    for place in ("A1", "A20"):
        chart = book.add_chart({"type": "column"})
        chart.add_series({"name": "=Results!$A$2", "categories": "=Trials!$A$2:$A$4", "values": "=Trials!$B$2:$B$4"})
        chevy.insert_chart(place, chart)
    chevy.insert_textbox("J1", "mean", {"textlink": "=Results!$B$2"})
    trials.activate()


def _fill_scene(book):
    number = book.add_format({"num_format": "0.00", "bg_color": "#C6EFCE"})
    scene, own, notes = (book.add_worksheet(name) for name in ("Scene", "Results", "Notes"))
    scene.write_row("A1", ["speed", "mass"])
    scene.write_row("A2", [12.5, 1500], number)
    scene.write_formula("C2", "=A2*B2", number, 18750)
    scene.add_table("E1:F3", {"name": "Trials", "columns": [{"header": "Name"}, {"header": "Value"}]})
    scene.insert_textbox("A5", "impact here", {"fill": {"color": "#FFCC00"}})
    scene.insert_image("H1", "scene.png", {"image_data": io.BytesIO(_png())})
    chart = book.add_chart({"type": "scatter"})
    chart.add_series({"categories": "=Scene!$A$2:$A$3", "values": "=Scene!$B$2:$B$3"})
    scene.insert_chart("H10", chart)
    scene.write_comment("A2", "measured on the road")
    scene.data_validation("A2", {"validate": "decimal", "criteria": ">", "value": 0})
    scene.conditional_format("A2:B2", {"type": "cell", "criteria": ">", "value": 9, "format": number})
    own.write("A1", "the person's own results")
    own.repeat_rows(0)
    notes.write("A1", "=Results!A1")
    notes.activate()
    notes.set_first_sheet()
    book.define_name("Scene!friction", "=Scene!$A$2")
    book.define_name("Notes!friction", "=Scene!$B$2")
    book.define_name("zero", "=0")
    book.add_vba_project(io.BytesIO(b"not a real project, but the bytes must stay"), is_stream=True)
    book.set_vba_name("ThisWorkbook")


_SHAPES = (
    "<xdr:twoCellAnchor><xdr:from><xdr:col>1</xdr:col><xdr:colOff>0</xdr:colOff><xdr:row>12</xdr:row>"
    "<xdr:rowOff>0</xdr:rowOff></xdr:from><xdr:to><xdr:col>4</xdr:col><xdr:colOff>0</xdr:colOff><xdr:row>20</xdr:row>"
    '<xdr:rowOff>0</xdr:rowOff></xdr:to><xdr:grpSp><xdr:nvGrpSpPr><xdr:cNvPr id="90" name="Cars"/><xdr:cNvGrpSpPr/>'
    '</xdr:nvGrpSpPr><xdr:grpSpPr/><xdr:sp macro="" textlink=""><xdr:nvSpPr><xdr:cNvPr id="91" name="Car 1"/>'
    '<xdr:cNvSpPr/></xdr:nvSpPr><xdr:spPr><a:xfrm><a:off x="609600" y="2400000"/><a:ext cx="900000" cy="400000"/>'
    '</a:xfrm><a:prstGeom prst="roundRect"><a:avLst/></a:prstGeom><a:solidFill><a:srgbClr val="C00000"/></a:solidFill>'
    '</xdr:spPr></xdr:sp><xdr:cxnSp macro=""><xdr:nvCxnSpPr><xdr:cNvPr id="92" name="Path"/><xdr:cNvCxnSpPr/>'
    '</xdr:nvCxnSpPr><xdr:spPr><a:xfrm><a:off x="1509600" y="2600000"/><a:ext cx="900000" cy="300000"/></a:xfrm>'
    '<a:prstGeom prst="straightConnector1"><a:avLst/></a:prstGeom><a:ln w="25400"><a:solidFill>'
    '<a:srgbClr val="0000C0"/></a:solidFill></a:ln></xdr:spPr></xdr:cxnSp></xdr:grpSp><xdr:clientData/>'
    "</xdr:twoCellAnchor>"
)
_THREAD = (
    '<ThreadedComments xmlns="http://schemas.microsoft.com/office/spreadsheetml/2018/threadedcomments">'
    '<threadedComment ref="B2" dT="2024-01-01T00:00:00.00" personId="{00000000-0000-0000-0000-000000000001}" '
    'id="{00000000-0000-0000-0000-000000000002}"><text>weighed with driver</text></threadedComment></ThreadedComments>'
)
_PERSONS = (
    '<personList xmlns="http://schemas.microsoft.com/office/spreadsheetml/2018/threadedcomments"><person '
    'displayName="A. Person" id="{00000000-0000-0000-0000-000000000001}" userId="A" providerId="None"/></personList>'
)
_CHAIN = '<calcChain xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><c r="C2" i="1"/></calcChain>'
_SHEET_RELS, _OFFICE_TYPE = "xl/worksheets/_rels/sheet1.xml.rels", "application/vnd.openxmlformats-officedocument."
_MICROSOFT, _MICROSOFT_TYPE = "http://schemas.microsoft.com/office/2017/10/relationships", "application/vnd.ms-excel."
_FURTHER = (  # pointed to from, by what kind of relationship, to what, of what content type
    (
        _SHEET_RELS,
        f"{OFFICE}/printerSettings",
        "../printerSettings/printerSettings1.bin",
        f"{_OFFICE_TYPE}spreadsheetml.printerSettings",
    ),
    (
        _SHEET_RELS,
        f"{_MICROSOFT}/threadedComment",
        "../threadedComments/threadedComment1.xml",
        f"{_MICROSOFT_TYPE}threadedcomments+xml",
    ),
    (RELS, f"{_MICROSOFT}/person", "persons/person.xml", f"{_MICROSOFT_TYPE}person+xml"),
    (RELS, f"{OFFICE}/calcChain", "calcChain.xml", f"{_OFFICE_TYPE}spreadsheetml.calcChain+xml"),
)


def _pointer(key, kind, target):
    return f'<Relationship Id="{key}" Type="{kind}" Target="{target}"/>'


def _inserted(text, mark, fragment):
    assert text.count(mark) == 1
    return text.replace(mark, fragment + mark)


def _rich_parts():
    """The scene as Excel might have saved it: XlsxWriter's package with what XlsxWriter cannot write."""
    text = _built(_fill_scene)

    def insert(name, mark, fragment):
        text[name] = _inserted(text[name].decode(), mark, fragment).encode()

    insert("xl/drawings/drawing1.xml", "</xdr:wsDr>", _SHAPES)
    insert("_rels/.rels", "</Relationships>", _pointer("rId90", f"{OFFICE}/customXml", "customXml/item1.xml"))
    for rels, kind, target, content_type in _FURTHER:
        name = rels.replace("_rels/", "").removesuffix(".rels")
        insert(rels, "</Relationships>", _pointer(f"further_{kind.rpartition('/')[2]}", kind, target))
        part = posixpath.normpath(posixpath.join("/", posixpath.dirname(name), target))
        insert(CONTENT_TYPES, "</Types>", f'<Override PartName="{part}" ContentType="{content_type}"/>')
    ignorable = (
        ' xmlns:mc="http://schemas.openxmlformats.org/markup-compatibility/2006" mc:Ignorable="x15" '
        'xmlns:x15="http://schemas.microsoft.com/office/spreadsheetml/2010/11/main"'
    )
    text[WORKBOOK] = text[WORKBOOK].replace(b"<workbook ", b"<workbook" + ignorable.encode() + b" ", 1)
    insert(
        WORKBOOK,
        "<bookViews>",
        '<mc:AlternateContent><mc:Choice Requires="x15"><x15ac:absPath url="C:\\scene\\" '
        'xmlns:x15ac="http://schemas.microsoft.com/office/spreadsheetml/2010/11/ac"/></mc:Choice></mc:AlternateContent>'
        '<workbookProtection lockStructure="1"/>',
    )
    insert(WORKBOOK, "</workbook>", '<extLst><ext uri="{1}"><x15:workbookPr chartTrackingRefBase="1"/></ext></extLst>')
    return text | {
        "xl/printerSettings/printerSettings1.bin": bytes(range(256)),
        "xl/threadedComments/threadedComment1.xml": _THREAD.encode(),
        "xl/persons/person.xml": _PERSONS.encode(),
        "xl/calcChain.xml": _CHAIN.encode(),
        "customXml/item1.xml": '<case xmlns="urn:case">Brach 2022</case>'.encode("utf-16"),
    }


@pytest.fixture(scope="session")
def build():
    """`build(fill)`: the bytes of an XlsxWriter workbook after `fill(workbook)`."""
    return _built


@pytest.fixture(scope="session")
def results():
    """Three result sheets with all that a report may put on them."""
    return _built(_fill_results)


@pytest.fixture(scope="session")
def other_results():
    """The same sheets after another run: one number differs."""
    return _built(lambda book: _fill_results(book, mean=32.5))


@pytest.fixture(scope="session")
def rich():
    """The parts of a macro workbook with everything in it; it has a sheet `Results` and a table `Trials` of its own."""
    return _rich_parts()
