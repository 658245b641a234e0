"""The records of an old workbook, written byte by byte as [MS-XLS] lays them out."""

from __future__ import annotations

import struct

import pytest
from old_format_book import drawing, number, plain_book, record, shape

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.other_formats import old_workbook
from xlmc.excel.workbook.other_formats.old_workbook import OldSheet, read_old_workbook, short_number


def double_bits(value, *, hundred=False):
    return struct.unpack("<Q", struct.pack("<d", value))[0] >> 32 & 0xFFFFFFFC | hundred


@pytest.mark.parametrize(
    ("short", "value"),
    [
        (5 << 2 | 2, 5.0), (0 << 2 | 2, 0.0), (1234 << 2 | 3, 12.34), ((2**30 - 1) << 2 | 2, -1.0),
        ((2**30 - 250) << 2 | 3, -2.5), ((2**29 - 1) << 2 | 2, 536870911.0), (2**29 << 2 | 2, -536870912.0),
        (double_bits(0.5), 0.5), (double_bits(-3.0), -3.0), (double_bits(150.0, hundred=True), 1.5), (0, 0.0),
    ],
)  # fmt: skip
def test_numbers_in_30_bits(short, value):
    assert short_number(short) == value


def begin(kind=0x10, version=0x600):
    return record(0x809, struct.pack("<HH12x", version, kind))


def listed(start, name, kind=0, wide=False):
    text = name.encode("utf-16-le" if wide else "latin-1")
    return record(0x85, struct.pack("<IBBBB", start, 0, kind, len(name), wide) + text)


def workbook(sheets, head=b"", ends=True):
    """The stream of a workbook: `sheets` is (name, kind, wide, records) of each, in tab order."""
    length = len(begin(5)) + sum(len(listed(0, name, kind, wide)) for name, kind, wide, _ in sheets) + len(head) + 4
    starts, parts = [], []
    for *_, records in sheets:
        starts.append(length)
        parts.append(begin() + records + (record(0x0A) if ends else b""))
        length += len(parts[-1])
    names = b"".join(listed(start, *rest) for start, (*rest, _) in zip(starts, sheets, strict=True))
    return begin(5) + names + head + record(0x0A) + b"".join(parts)


def read(stream):
    reading = old_workbook._Reading(stream)
    return list(reading.sheets()), reading


ONE = number(1, 1, 1.0)


def test_sheets_in_tab_order_without_charts():
    sheets, reading = read(workbook([("Käse", 0, False, ONE), ("Chart", 2, False, b""), ("模型", 0, True, b"")]))
    assert [sheet.name for sheet in sheets] == ["Käse", "模型"]
    assert sheets[0].numbers == {(1, 1): 1.0}
    assert not reading.as_displayed
    assert not reading.manual


@pytest.mark.parametrize(
    ("head", "as_displayed", "manual"),
    [
        (record(0x0E, b"\0\0"), True, False), (record(0x0E, b"\1\0"), False, False),
        (record(0x0D, b"\0\0"), False, True), (record(0x0D, b"\1\0"), False, False),
    ],
)  # fmt: skip
def test_how_excel_calculates(head, as_displayed, manual):
    for stream in (workbook([("S", 0, False, b"")], head), workbook([("S", 0, False, head)])):
        _, reading = read(stream)
        assert (reading.as_displayed, reading.manual) == (as_displayed, manual)


def formula(row, column, value):
    return record(0x06, struct.pack("<HHH8sHIH", row - 1, column - 1, 0, value, 0, 0, 0))


@pytest.mark.parametrize(
    ("records", "expected"),
    [
        (number(7, 9, -0.1), OldSheet("S", {(7, 9): -0.1})),
        (record(0x27E, struct.pack("<HHHI", 4, 2, 0, 5 << 2 | 2)), OldSheet("S", {(5, 3): 5.0})),
        (
            record(0xBD, struct.pack("<HH", 4, 2) + struct.pack("<HIHIHI", *(0, 5 << 2 | 2) * 3) + b"\4\0"),
            OldSheet("S", {(5, 3): 5.0, (5, 4): 5.0, (5, 5): 5.0}),
        ),
        (
            record(0xBD, struct.pack("<HH", 0, 0) + struct.pack("<HI", 0, 7 << 2 | 2) + b"\0\0"),
            OldSheet("S", {(1, 1): 7.0}),
        ),
        (formula(3, 2, struct.pack("<d", 2.5)), OldSheet("S", results={(3, 2): 2.5})),
        (formula(3, 2, b"\1\0\1\0\0\0\xff\xff"), OldSheet("S", results={(3, 2): True})),
        (formula(3, 2, b"\1\0\0\0\0\0\xff\xff"), OldSheet("S", results={(3, 2): False})),
        (formula(3, 2, b"\0\0\1\0\0\0\xff\xff"), OldSheet("S")),
        (formula(3, 2, b"\2\0\7\0\0\0\xff\xff"), OldSheet("S")),
        (record(0x221, struct.pack("<HHBB", 4, 6, 1, 2)), OldSheet("S", areas=[(5, 2, 7, 3)])),
        (record(0x236, struct.pack("<HHBB", 0, 1, 3, 4)), OldSheet("S", areas=[(1, 4, 2, 5)])),
        (record(0x9999, b"whatever"), OldSheet("S")),
    ],
)
def test_cells(records, expected):
    (sheet,), _ = read(workbook([("S", 0, False, records)]))
    assert sheet == expected
    assert type(next(iter(sheet.results.values()), None)) is type(next(iter(expected.results.values()), None))


def test_what_stands_within_a_chart_is_not_of_the_sheet():
    chart = begin(0x20) + number(9, 9, 9.0) + record(0x0A)
    (sheet,), _ = read(workbook([("S", 0, False, ONE + chart + number(2, 2, 2.0))]))
    assert sheet.numbers == {(1, 1): 1.0, (2, 2): 2.0}


def test_substreams_within_substreams():
    """Sixteen at most."""
    for depth, fails in ((15, False), (16, True)):
        stream = workbook([("S", 0, False, begin(0x20) * depth + record(0x0A) * depth + ONE)])
        if fails:
            with pytest.raises(WorkbookError, match="nested too deeply"):
                read(stream)
        else:
            assert read(stream)[0][0].numbers == {(1, 1): 1.0}


def test_the_rest_of_a_stream_that_is_filled_up():
    stream = workbook([("S", 0, False, ONE)])
    for filling in (b"", b"\0" * 4, b"\0" * 100, b"\0\0\0", b"\1"):
        assert read(stream + filling)[0][0].numbers == {(1, 1): 1.0}
    assert read(stream[:-4])[0][0].numbers == {(1, 1): 1.0}  # the last record of all is missing


def test_an_end_too_many_ends_nothing():
    stream = workbook([("S", 0, False, ONE)])
    at = stream.index(begin(), 4)
    start = struct.pack("<I", at)
    moved = stream.replace(start, struct.pack("<I", at + 4))
    assert read(moved[:at] + record(0x0A) + moved[at:])[0][0].numbers == {(1, 1): 1.0}


@pytest.mark.parametrize(
    ("stream", "message"),
    [
        (b"", "it holds no workbook"),
        (b"\0" * 8, "it holds no workbook"),
        (begin(version=0x500), "Excel 95 or older"),
        (workbook([("S", 0, False, ONE)])[:-9], "it ends too early"),
        (workbook([("S", 0, False, b"")])[: -len(begin()) - 4], "the sheet 'S' is missing"),
        (begin(5) + listed(999, "S") + listed(999, "T") + record(0x0A), "two sheets begin at one place"),
        (begin(5) + record(0x2F, b"\1\0") + record(0x0A), "The workbook is encrypted"),
    ],
)
def test_damage(stream, message):
    with pytest.raises(WorkbookError, match=message):
        read(stream)


def test_a_short_record_is_damage():
    with pytest.raises(WorkbookError, match="damaged"):
        read_old_workbook(plain_book({"S": record(0x203, b"\0\0")}))


def text_object(characters, formats):
    return record(0x1B6, struct.pack("<10xHH4x", characters, formats))


def drawing_bytes():
    """What the one record of a drawing with a shape holds."""
    data = drawing([shape("Name", "text")])
    return data[4 : 4 + struct.unpack_from("<H", data, 2)[0]]


def test_texts_of_comments_are_no_drawing():
    """A drawing goes on behind the characters of a comment, eight or sixteen bits each, and behind their formats."""
    (whole,) = read(workbook([("S", 0, False, drawing([shape("Name", "text")]))]))[0]
    body = drawing_bytes()
    half = len(body) // 2
    for narrow in (True, False):
        characters = b"\0abcdef" if narrow else b"\1" + "abcdef".encode("utf-16-le")
        between = text_object(6, 16) + record(0x3C, characters) + record(0x3C, bytes(16))
        records = record(0xEC, body[:half]) + between + record(0x3C, body[half:])
        assert read(workbook([("S", 0, False, records)]))[0][0].texts == whole.texts
        split = text_object(6, 0) + record(0x3C, characters[:3]) + record(0x3C, characters[:1] + characters[3:])
        records = record(0xEC, body[:half]) + split + record(0x3C, body[half:])
        assert read(workbook([("S", 0, False, records)]))[0][0].texts == whole.texts
    for before in (b"", record(0x5D, b"object"), text_object(0, 0)):
        records = record(0xEC, body[:half]) + before + record(0x3C, body[half:])
        assert read(workbook([("S", 0, False, records)]))[0][0].texts == whole.texts
    assert whole.texts


def test_what_continues_a_cell_is_no_drawing():
    whole = record(0xEC, drawing_bytes()) + ONE + record(0x3C, b"\xff" * 9)
    assert len(read(workbook([("S", 0, False, whole)]))[0][0].texts) == 1


@pytest.mark.parametrize("ends", [True, False])
def test_each_sheet_has_its_own_drawings(ends):
    shapes = [drawing([shape(name, "text")]) for name in ("One", "Two")]
    sheets, _ = read(workbook([("S", 0, False, shapes[0]), ("T", 0, False, b""), ("U", 0, False, shapes[1])]))
    assert [[text.shape for text in sheet.texts] for sheet in sheets] == [["One"], [], ["Two"]]
    if not ends:
        last, _ = read(workbook([("S", 0, False, shapes[0])], ends=False))
        assert [text.shape for text in last[0].texts] == ["One"]
