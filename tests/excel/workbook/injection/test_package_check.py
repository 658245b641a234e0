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
    "no XML": (SHEET, b"</worksheet>", b""),
}


@pytest.fixture
def book(build):
    def fill(made):
        first, _ = made.add_worksheet("One"), made.add_worksheet("Two")
        first.write("A1", 1.5, made.add_format({"num_format": "0.00"}))
        first.repeat_rows(0)

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
