"""Old Excel workbooks (`.xls`) with hidden shapes, written for tests: the records, and the file that holds them.

LibreOffice writes the cells and names of a workbook as `.xls`, without hidden shapes; `with_shapes` puts them in:

    path.write_bytes(with_shapes(path.read_bytes(), {"Sheet1": [("CB_Block_7.0.0.0:1", text)]}))

`plain_book` needs no LibreOffice: a workbook of numbers and shapes alone.
"""

from __future__ import annotations

import io
import re
import struct
from xml.sax.saxutils import unescape

import olefile

SECTOR = 512
FREE, END, FAT, NONE = 0xFFFFFFFF, 0xFFFFFFFE, 0xFFFFFFFD, 0xFFFFFFFF


def record(kind, data=b""):
    """A record of the workbook's stream."""
    return struct.pack("<HH", kind, len(data)) + data


def art(kind, data, *, container=False, instance=0):
    """A record of a drawing."""
    return struct.pack("<HHI", instance << 4 | (0xF if container else 0), kind, len(data)) + data


def properties(kind, values):
    """A table of properties: identifier -> a number, or bytes of any length."""
    table = b"".join(
        struct.pack("<HI", key | 0xC000, len(value)) if isinstance(value, bytes) else struct.pack("<HI", key, value)
        for key, value in values.items()
    )
    more = b"".join(value for value in values.values() if isinstance(value, bytes))
    return art(kind, table + more, instance=len(values))


def shape(name, text, number=1, extended="Decisioneering:7.0.0.0"):
    """The container of a hidden picture with a script text, as the specification of Crystal Ball's data has it."""
    texts = {0x38E: utf16(text), 0x397: utf16(extended), 0x398: 4}
    return art(
        0xF004,
        art(0xF00A, struct.pack("<II", 1024 + number, 0xA00), instance=75)
        + properties(0xF00B, {0x104: 1, 0x380: utf16(name)})
        + properties(0xF122, texts)
        + art(0xF010, bytes(18))
        + art(0xF011, b""),
        container=True,
    )


def utf16(text):
    return text.encode("utf-16-le", "surrogatepass") + b"\0\0"


def drawing(shapes, *, size=8224, note=False, group=False):
    """The records of a sheet's drawing: each shape, and its object; what is too long goes on in records of its own.

    Args:
        shapes: containers.
        size: bytes of a record at most.
        note: with the text of a comment between the first shape and the second.
        group: all shapes in one group.
    """
    first = art(0xF004, art(0xF009, bytes(16)) + art(0xF00A, bytes(8)), container=True)
    inner = first + b"".join(shapes)
    if group:
        inner = first + art(0xF003, inner, container=True)
    whole = art(0xF002, art(0xF008, bytes(8)) + art(0xF003, inner, container=True), container=True)
    ends = [whole.index(each) + len(each) for each in shapes]
    out, at, continued = b"", 0, False
    for number, end in enumerate(ends):
        for start in range(at, end, size):
            out += record(0x3C if continued else 0xEC, whole[start : min(start + size, end)])
            continued = True
        out += record(0x5D, struct.pack("<HHHHH12xI", 0x15, 18, 8, number + 1, 0x6011, 0))
        if note and number == 0:
            text = "a comment".encode("utf-16-le")
            out += record(0x1B6, struct.pack("<HH6xHHHI", 0x212, 0, 9, 16, 0, 0))
            out += record(0x3C, b"\1" + text) + record(0x3C, bytes(16))
        at = end
        continued = len(whole) > size  # Excel writes drawings of more than one record so
    return out


def with_shapes(data, shapes, **more):
    """An old workbook with hidden pictures: sheet -> (name, text) of each; `more` as for `drawing`."""
    with olefile.OleFileIO(io.BytesIO(data)) as file:
        streams = {"/".join(path): file.openstream(path).read() for path in file.listdir()}
    streams = {name: content for name, content in streams.items() if "/" not in name}
    streams["Workbook"] = with_drawings(
        streams["Workbook"],
        {title: drawing([shape(*each, n) for n, each in enumerate(held, 1)], **more) for title, held in shapes.items()},
    )
    return compound(streams)


def stream_of(data):
    """The workbook's stream of a file."""
    with olefile.OleFileIO(io.BytesIO(data)) as file:
        return file.openstream("Workbook").read()


def with_drawings(stream, drawings):
    """The workbook's stream with these records at the ends of sheets, whose places are put right."""
    pieces, depth, at, moved, listed = [], 0, 0, {}, []
    title, first, length = None, True, 0
    titles = {}
    while at + 4 <= len(stream):
        kind, size = struct.unpack_from("<HH", stream, at)
        data = stream[at + 4 : at + 4 + size]
        new = record(kind, data)
        if kind == 0x85:
            wide = data[7] & 1
            name = data[8:].decode("utf-16-le" if wide else "latin-1")
            titles[struct.unpack_from("<I", data)[0]] = name
            listed.append(len(pieces))
        if kind == 0x809:
            if depth == 0:
                moved[at] = length
                title = None if first else titles.get(at)
                first = False
            depth += 1
        if kind == 0x0A:
            depth -= 1
            if depth == 0 and title in drawings:
                new = drawings[title] + new
        pieces.append(new)
        length += len(new)
        at += 4 + size
        if kind == 0 and size == 0:
            break
    for place in listed:
        (start,) = struct.unpack_from("<I", pieces[place], 4)
        pieces[place] = pieces[place][:4] + struct.pack("<I", moved[start]) + pieces[place][8:]
    return b"".join(pieces)


def plain_book(sheets, *, before=b"", macros=False):
    """A workbook without LibreOffice: name -> the records of each sheet."""
    begin = struct.pack("<HH12x", 0x600, 5)
    head = (
        len(record(0x809, begin))
        + len(before)
        + sum(len(record(0x85, bytes(8) + name.encode("utf-16-le"))) for name in sheets)
    )
    place, listed, bodies = head + 4, b"", b""
    for name, records in sheets.items():
        body = record(0x809, struct.pack("<HH12x", 0x600, 0x10)) + records + record(0x0A)
        listed += record(0x85, struct.pack("<IBBBB", place, 0, 0, len(name), 1) + name.encode("utf-16-le"))
        bodies += body
        place += len(body)
    streams = {"Workbook": record(0x809, begin) + before + listed + record(0x0A) + bodies}
    return compound({**streams, "_VBA_PROJECT_CUR": b"x"} if macros else streams)


def number(row, column, value):
    """The record of a number, by row and column from 1."""
    return record(0x203, struct.pack("<HHHd", row - 1, column - 1, 0, value))


def compound(streams):
    """A compound file of these streams ([MS-CFB]): name -> content; each is filled up to 4,096 bytes."""
    chains, data = [], b""
    for content in streams.values():
        filled = content + bytes(max(0, 4096 - len(content)))
        filled += bytes(-len(filled) % SECTOR)
        chains.append((len(data) // SECTOR, len(filled)))
        data += filled
    names = [("Root Entry", 5, END, 0), *((n, 2, *chain) for n, chain in zip(streams, chains, strict=True))]
    entries = b""
    for number_, (name, kind, start, size) in enumerate(names):
        text = name.encode("utf-16-le")
        right = number_ + 1 if 0 < number_ < len(names) - 1 else NONE
        child = 1 if number_ == 0 and len(names) > 1 else NONE
        entries += text + bytes(64 - len(text)) + struct.pack("<HBBIII", len(text) + 2, kind, 1, NONE, right, child)
        entries += bytes(36) + struct.pack("<IQ", start, size)
    entries += (bytes(64) + struct.pack("<HBBIII", 0, 0, 0, NONE, NONE, NONE) + bytes(48)) * (-len(names) % 4)
    count = len(data) // SECTOR + len(entries) // SECTOR
    tables = 1
    while tables * 128 < count + tables:
        tables += 1
    assert tables <= 109
    fat = [FREE] * (tables * 128)
    for start, size in chains:
        for at in range(start, start + size // SECTOR):
            fat[at] = at + 1
        fat[start + size // SECTOR - 1] = END
    for at in range(len(data) // SECTOR, count):
        fat[at] = at + 1
    fat[count - 1] = END
    fat[count : count + tables] = [FAT] * tables
    places = [*range(count, count + tables)] + [FREE] * (109 - tables)
    header = bytes.fromhex("D0CF11E0A1B11AE1") + bytes(16)
    header += struct.pack(
        "<HHHHH6xIIIIIIIII", 0x3E, 3, 0xFFFE, 9, 6, 0, tables, len(data) // SECTOR, 0, 4096, END, 0, END, 0
    )
    header += struct.pack("<109I", *places)
    return header + data + entries + struct.pack(f"<{len(fat)}I", *fat)


def shapes_of(parts, titles):
    """The hidden pictures of an `.xlsx`, as `with_shapes` takes them; `titles` are its sheets in order."""
    result = {}
    for place, title in enumerate(titles, 1):
        relations = parts.get(f"xl/worksheets/_rels/sheet{place}.xml.rels", b"")
        target = re.search(rb'Target="[./]*(?:xl/)?(drawings/[^"]*\.vml)"', relations)
        if target:
            vml = parts[f"xl/{target[1].decode()}"].decode()
            held = re.findall(r'<v:shape [^>]*?id="([^"]*)".*?<x:ScriptText>(.*?)</x:ScriptText>', vml, re.DOTALL)
            result[title] = [(name.replace("_x003a_", ":"), unescape(text)) for name, text in held]
    return result
