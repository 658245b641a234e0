"""Old workbooks (`.xls`) of Crystal Ball that are broken: the file, its records, its drawings, its blocks.

LibreOffice is not started: what it would make of the cells is the same for all.
"""

from __future__ import annotations

import io
import random
import re
import struct
import sys
import zipfile
import zlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Final

sys.path.append(str(Path(__file__).resolve().parents[2] / "tests" / "session"))

from old_format_book import compound, drawing, number, plain_book, record, shape, shapes_of, stream_of

from fuzzing import zips
from fuzzing.hidden_blocks import BLOCK_CHANGES, book_parts, refuse_silence
from fuzzing.inputs import Input, Reached, steps_of
from xlmc.excel.workbook.other_formats import joined_package
from xlmc.excel.workbook.reader import read_workbook

__all__ = ["make", "run"]

_TITLES: Final = ("CB_DATA_", "Model data", "Other's")
_STEPS: Final = {"summary": 0.1, "check": 0.1, "simulate": 0.01}
_DRAWINGS: Final = ({}, {"size": 500}, {"note": True}, {"note": True, "size": 300}, {"group": True})

_Numbers = dict[str, dict[tuple[int, int], float]]


@cache
def _converted() -> bytes:
    """The book as LibreOffice is said to convert it: without what lies in its drawings."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as package:
        for name, data in book_parts():
            package.writestr(name, _without_pictures(data) if name.endswith(".vml") else data)
    return stream.getvalue()


def _without_pictures(data: bytes) -> bytes:
    return re.sub(rb"<v:shape [^>]*><x:ClientData ObjectType=.Pict.*?</v:shape>", b"", data, flags=re.DOTALL)


@cache
def _held() -> tuple[dict[str, list[tuple[str, str]]], _Numbers]:
    """The texts and the numbers of each sheet."""
    book = read_workbook(_converted(), "book.xlsx")
    numbers: _Numbers = {
        name: {
            at: content.value
            for at, content in sheet.cells.items()
            if content.formula is None and isinstance(content.value, float | int)
        }
        for name, sheet in book.sheets.items()
    }
    return shapes_of(dict(book_parts()), _TITLES), numbers


def make(rng: random.Random) -> Input:
    """The book with its blocks, its drawings, its records or its bytes changed."""
    texts, numbers = _held()
    texts = {title: list(held) for title, held in texts.items()}
    message = []
    level = rng.choice(["blocks", "drawing", "drawing", "records", "records", "file"])
    if level == "blocks":
        title = rng.choice(_TITLES[1:])
        at = rng.randrange(len(texts[title]))
        messages, change = rng.choice(BLOCK_CHANGES)
        name, text = texts[title][at]
        try:
            texts[title][at] = (name, change(rng, text))
        except (ValueError, zlib.error, IndexError):
            messages = "nothing"
        message.append(f"{title}: {messages}")
    how = rng.choice(_DRAWINGS)
    sheets = {}
    for title in _TITLES:
        drawn = drawing([shape(*each, place) for place, each in enumerate(texts[title], 1)], **how)
        sheets[title] = b"".join(number(*at, value) for at, value in numbers[title].items()) + drawn
    if level == "drawing":
        title = rng.choice(_TITLES)
        sheets[title] = _in_drawing(rng, sheets[title])
        message.append(f"{title}: the bytes of its drawing")
    data = plain_book(sheets)
    if level == "records":
        messages, change_records = rng.choice(_RECORDS)
        data = compound({"Workbook": change_records(rng, stream_of(data))})
        message.append(messages)
    elif level == "file":
        data = _in_file(rng, data)
        message.append("bytes of the file")
    return Input("fuzz.xls", data, f"{how}: {'; '.join(message)}", steps_of(rng, _STEPS))


def run(given: Input, folder: Path) -> Reached:
    """Read and run it: see `zips.run`; and see that no assumption became a constant without a word.

    Raises:
        XlmcError: as xlmc does.
        Disagreement: a cell that was drawn is a constant now.
    """
    before = joined_package.converted_to_xlsx
    joined_package.converted_to_xlsx = lambda *_: _converted()
    try:
        refuse_silence(given)
        return zips.run(given, folder)
    finally:
        joined_package.converted_to_xlsx = before


def _in_drawing(rng: random.Random, records: bytes) -> bytes:
    """Change bytes behind the first record of the drawing, most often in what says lengths."""
    data = bytearray(records)
    start = data.find(struct.pack("<H", 0xEC))
    heads = [each.start() for each in re.finditer(rb"[\x00-\xff]{2}[\x03\x04\x0b\x22]\xf0", bytes(data[start:]))]
    for _ in range(rng.choice([1, 1, 2, 5])):
        at = start + (rng.choice(heads) + rng.randrange(8) if heads and rng.random() < 0.7 else rng.randrange(200))
        data[at % len(data)] = rng.choice([0, 1, 0x7F, 0x80, 0xFF, data[at % len(data)] ^ 1 << rng.randrange(8)])
    return bytes(data)


def _records_of(stream: bytes) -> list[tuple[int, bytes]]:
    result, at = [], 0
    while at + 4 <= len(stream):
        kind, length = struct.unpack_from("<HH", stream, at)
        if kind == 0 and length == 0:
            break
        result.append((kind, stream[at + 4 : at + 4 + length]))
        at += 4 + length
    return result


def _joined(records: list[tuple[int, bytes]]) -> bytes:
    return b"".join(record(kind, data) for kind, data in records)


def _flipped(rng: random.Random, stream: bytes) -> bytes:
    data = bytearray(stream)
    for _ in range(rng.choice([1, 2, 8])):
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return bytes(data)


def _lost(rng: random.Random, stream: bytes) -> bytes:
    records = _records_of(stream)
    del records[rng.randrange(len(records))]
    return _joined(records)


def _twice(rng: random.Random, stream: bytes) -> bytes:
    records = _records_of(stream)
    at = rng.randrange(len(records))
    return _joined([*records[:at], records[at], *records[at:]])


def _other_kind(rng: random.Random, stream: bytes) -> bytes:
    records = _records_of(stream)
    at = rng.randrange(len(records))
    kind = rng.choice([0x06, 0x0A, 0x2F, 0x3C, 0x5D, 0x85, 0xBD, 0xEC, 0x1B6, 0x203, 0x221, 0x27E, 0x809])
    records[at] = (kind, records[at][1])
    return _joined(records)


def _shorter(rng: random.Random, stream: bytes) -> bytes:
    records = _records_of(stream)
    at = rng.randrange(len(records))
    kind, data = records[at]
    records[at] = (kind, data[: rng.randrange(len(data) + 1)])
    return _joined(records)


def _exchanged(rng: random.Random, stream: bytes) -> bytes:
    records = _records_of(stream)
    one, other = rng.randrange(len(records)), rng.randrange(len(records))
    records[one], records[other] = records[other], records[one]
    return _joined(records)


_RECORDS: Final[tuple[tuple[str, Callable[[random.Random, bytes], bytes]], ...]] = (
    ("bits of the records", _flipped),
    ("a record lost", _lost),
    ("a record twice", _twice),
    ("a record of another kind", _other_kind),
    ("a record cut short", _shorter),
    ("two records exchanged", _exchanged),
    ("the stream cut short", lambda rng, stream: stream[: rng.randrange(len(stream))]),
)


def _in_file(rng: random.Random, data: bytes) -> bytes:
    changed = bytearray(data)
    if rng.random() < 0.2:
        return bytes(changed[: rng.randrange(8, len(changed))])
    for _ in range(rng.choice([1, 2, 8])):
        places = (range(8, 512), range(len(changed) - 2048, len(changed)), range(8, len(changed)))
        changed[rng.choice(rng.choice(places))] = rng.choice([0, 1, 0x7F, 0xFE, 0xFF])
    return bytes(changed)
