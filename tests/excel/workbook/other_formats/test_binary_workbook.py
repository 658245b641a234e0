"""The records of a binary workbook, written byte by byte as [MS-XLSB] lays them out."""

from __future__ import annotations

import struct

import pytest
from binary_book import record, row, text

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.other_formats.binary_workbook import read_binary_workbook
from xlmc.excel.workbook.other_formats.old_workbook import OldBook, OldSheet

OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
RELATIONS = (
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    f'<Relationship Id="rId1" Type="{OFFICE}/worksheet" Target="worksheets/sheet1.bin"/>'
    f'<Relationship Id="rId2" Type="{OFFICE}/chartsheet" Target="chartsheets/sheet2.bin"/>'
    "</Relationships>"
).encode()


def listed(relation, name):
    return record(156, struct.pack("<II", 0, 1) + text(relation) + text(name))


def calculation(automatic=1, flags=0x0008):
    return record(157, struct.pack("<iiidiH", 0, automatic, 100, 0.001, 1, flags))


def parts(cells=b"", book=None, **more):
    return {
        "xl/workbook.bin": listed("rId1", "Käse") if book is None else book,
        "xl/_rels/workbook.bin.rels": RELATIONS,
        "xl/worksheets/sheet1.bin": cells,
        **more,
    }


def at(column):
    return struct.pack("<II", column - 1, 0)


@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        (row(3, record(5, at(2) + struct.pack("<d", 0.1))), OldSheet("Käse", {(3, 2): 0.1})),
        (row(3, record(2, at(4) + struct.pack("<I", 1234 << 2 | 3))), OldSheet("Käse", {(3, 4): 12.34})),
        (row(3, record(9, at(2) + struct.pack("<d", 2.5))), OldSheet("Käse", results={(3, 2): 2.5})),
        (row(3, record(10, at(2) + b"\1")), OldSheet("Käse", results={(3, 2): True})),
        (row(3, record(10, at(2) + b"\0")), OldSheet("Käse", results={(3, 2): False})),
        (row(1, record(5, at(1) + struct.pack("<d", 1)), record(5, at(9) + struct.pack("<d", 9)))
         + row(2, record(5, at(1) + struct.pack("<d", 2))), OldSheet("Käse", {(1, 1): 1, (1, 9): 9, (2, 1): 2})),
        (record(426, struct.pack("<IIII", 1, 4, 2, 5)), OldSheet("Käse", areas=[(2, 3, 5, 6)])),
        (record(428, struct.pack("<IIII", 0, 1, 3, 3)), OldSheet("Käse", areas=[(1, 4, 2, 4)])),
        (record(6, at(1) + text("text")) + record(9999, bytes(20_000)), OldSheet("Käse")),
        (record(9999, bytes(300)) + row(1, record(5, at(1) + struct.pack("<d", 1))), OldSheet("Käse", {(1, 1): 1})),
    ],
)  # fmt: skip
def test_cells(cells, expected):
    book = read_binary_workbook(parts(cells))
    assert book == OldBook((expected,), False, False, False)
    assert [type(each) for each in book.sheets[0].results.values()] == [type(e) for e in expected.results.values()]


@pytest.mark.parametrize(
    ("automatic", "flags", "manual", "as_displayed"),
    [(1, 0x0008, False, False), (0, 0x0008, True, False), (2, 0x0008, False, False), (1, 0xFFF7, False, True),
     (1, 0x0000, False, True), (1, 0xFFFF, False, False)],
)  # fmt: skip
def test_how_excel_calculates(automatic, flags, manual, as_displayed):
    book = read_binary_workbook(parts(book=listed("rId1", "S") + calculation(automatic, flags)))
    assert (book.manual, book.as_displayed, book.macros, book.tells_logicals) == (manual, as_displayed, False, True)


def test_sheets_of_charts_and_lost_ones_are_left_out():
    book = listed("rId2", "Chart") + listed("rId1", "S") + listed("rId9", "Lost") + record(156, bytes(8) + b"\xff" * 4
                                                                                         + text("None"))  # fmt: skip
    result = read_binary_workbook(parts(book=book, **{"xl/vbaProject.bin": b""}))
    assert [sheet.name for sheet in result.sheets] == ["S"]
    assert result.macros


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "it lacks its part xl/workbook.bin"),
        ({key: part for key, part in parts().items() if "sheet1" not in key}, "the sheet 'Käse' is missing"),
        (parts(record(5, b"\0")), "it is damaged"),
        (parts(b"\x05\x10\0"), "it ends too early"),
        (parts(b"\x05\x80"), "it is damaged"),
        (parts(book=record(156, bytes(8) + struct.pack("<I", 99) + b"ab")), "a name is longer than its record"),
    ],
)
def test_damage(given, message):
    with pytest.raises(WorkbookError, match=message):
        read_binary_workbook(given)


def test_types_of_records_in_two_bytes_and_lengths_in_four():
    """A type ends with its second byte, whatever that says; a length of 2^21 takes four."""
    cell = row(1, record(5, at(1) + struct.pack("<d", 1)))
    assert read_binary_workbook(parts(b"\xff\xff\x00" + cell)).sheets[0].numbers == {(1, 1): 1.0}
    assert read_binary_workbook(parts(record(9999, bytes(2**21)) + cell)).sheets[0].numbers == {(1, 1): 1.0}
    name = "x" * 200
    assert read_binary_workbook(parts(book=listed("rId1", name))).sheets[0].name == name
