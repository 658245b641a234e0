from __future__ import annotations

import pytest

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.inject import inject
from xlmc.excel.workbook.package_check import checked_bytes, faults

TYPES, WORKBOOK, RELS = "[Content_Types].xml", "xl/workbook.xml", "xl/_rels/workbook.xml.rels"
SHEET = "xl/worksheets/sheet1.xml"

DAMAGE = {
    "a content type twice": (TYPES, b"</Types>", b'<Override PartName="/xl/workbook.xml" ContentType="x"/></Types>'),
    "an ending twice": (TYPES, b"</Types>", b'<Default Extension="XML" ContentType="application/xml"/></Types>'),
    "a part of no kind": (TYPES, b'Extension="rels"', b'Extension="other"'),
    "a pointer that leads nowhere": (RELS, b'Target="worksheets/sheet1.xml"', b'Target="worksheets/sheet9.xml"'),
    "an id twice": (RELS, b'Id="rId2"', b'Id="rId1"'),
    "a sheet twice": (WORKBOOK, b'name="Two"', b'name="ONE"'),
    "a sheet number twice": (WORKBOOK, b'sheetId="2"', b'sheetId="1"'),
    "a name of no sheet": (WORKBOOK, b'localSheetId="0"', b'localSheetId="7"'),
    "a style beyond the last": (SHEET, b' s="1"', b' s="99"'),
    "a style in other quotes": (SHEET, b' s="1"', b" s='99'"),
    "a table number twice": ("xl/tables/table2.xml", b'id="2"', b'id="1"'),
    "a table name twice": ("xl/tables/table2.xml", b'displayName="Second"', b'displayName="FIRST"'),
    "no XML": (SHEET, b"</worksheet>", b""),
}


@pytest.fixture
def book(build):
    def fill(made):
        first, second = made.add_worksheet("One"), made.add_worksheet("Two")
        first.write("A1", 1.5, made.add_format({"num_format": "0.00"}))
        first.repeat_rows(0)
        second.add_table("A1:A3", {"name": "First"})
        second.add_table("C1:C3", {"name": "Second"})

    return build(fill)


@pytest.mark.parametrize(("part", "old", "new"), DAMAGE.values(), ids=[*DAMAGE])
def test_damage_is_refused_and_named_unless_it_was_there_before(book, part, old, new):
    assert faults(book, book) == []
    assert old in book[part]
    damaged = {**book, part: book[part].replace(old, new)}
    with pytest.raises(WorkbookError, match="would be damaged: "):
        checked_bytes(damaged, book)
    assert checked_bytes(damaged, damaged)


def test_result_sheets_are_whole(rich, results):
    done = inject(rich, results)
    assert faults(done, done) == []
    assert checked_bytes(done, rich)


@pytest.mark.parametrize("text", [' s="5000" ', '&lt;c r="A1" s="5000"/>', '<![CDATA[ s="5000"]]>'])
def test_a_text_that_looks_like_a_style_is_none(book, text):
    cell = f'<c r="Z1" t="inlineStr"><is><t>{text}</t></is></c></row>'.encode()
    message = {**book, SHEET: book[SHEET].replace(b"</row>", cell, 1)}
    assert cell in message[SHEET]
    assert checked_bytes(message, book)
