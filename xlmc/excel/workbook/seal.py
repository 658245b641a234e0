"""What xlmc marks its files with, so that it knows them again: only an untouched file of its own is ever replaced.

A result workbook holds one part more than its sheets need, with the name of the book and a SHA-256 of every other part.
A worksheet of ours points to it by a relationship of our own type. ISO/IEC 29500-1 lets programs ignore parts and
relationships that they do not know: Excel and LibreOffice open such a file without a word, and drop the part when they
save. A part was chosen rather than a comment of the zip, which some programs that scan files take for damage, and
rather than custom properties, which Excel keeps and which may be the person's own.

Files of text, and saved runs, end in a line that holds the name of the book and a SHA-256 of all bytes before it.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import BinaryIO, Final
from urllib.parse import quote, unquote

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.injection.book_edit import add_pointers
from xlmc.excel.workbook.injection.content_types import add_types
from xlmc.excel.workbook.injection.part_numbers import claimed_names, free_part_names
from xlmc.excel.workbook.package import CONTENT_TYPES, WORKBOOKS, read_parts, relative_target, rels_part

__all__ = ["ENDINGS", "Seal", "blank_seal", "read_seal", "seal_file", "sealed_json", "sealed_parts", "sealed_text"]

_PART: Final = "xl/xlmc/seal1.json"
_POINTER: Final = "urn:xlmc:seal"
_TYPE: Final = "application/json"
_SEAL_PART: Final = re.compile(r"xl/xlmc/seal\d+\.json")
_NO_POINTERS: Final = b'<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"/>'
_MOST: Final = 8_192
"""Bytes of the longest end of a file with a seal: names of files have 255 characters at most."""
_CHUNK: Final = 1 << 20

ENDINGS: Final[Mapping[str, tuple[bytes, bytes]]] = {
    ".html": (b"\n<!-- ", b" -->\n"),
    ".htm": (b"\n<!-- ", b" -->\n"),
    ".json": (b',\n  "seal": "', b'"\n}\n'),
    ".xlmcrun": (b"", b""),
}
"""What stands before and behind the seal at the end of a file, by the file's ending; in a saved run it is the zip's
comment."""
_SEAL: Final = rb"xlmc-seal book=(?P<book>[!-~]*) sha256=(?P<digest>[0-9a-f]{64})"


@dataclass(frozen=True, slots=True)
class Seal:
    """What a file says of itself: the name of the workbook whose results it holds, and whether it is still whole."""

    book: str
    whole: bool


def read_seal(path: Path) -> Seal | None:
    """Return the seal of a file; None if it has none: xlmc did not write it, or another program has saved it since.

    Raises:
        OSError: the file cannot be read.
    """
    ending = path.suffix.casefold()
    if ending in WORKBOOKS:
        return _seal_of_package(path.read_bytes())
    return _seal_at_end(path, ending) if ending in ENDINGS else None


def sealed_parts(parts: Mapping[str, bytes], sheet: str, book: str) -> dict[str, bytes]:
    """Add its seal to the package.

    Args:
        parts: the package.
        sheet: the part of a worksheet of ours, which is to point to the seal.
        book: the name of the workbook.
    """
    part, pointers = free_part_names([_PART], claimed_names(parts))[_PART], rels_part(sheet)
    target = (_POINTER, relative_target(sheet, part))
    result = dict(parts)
    result[pointers] = add_pointers(parts.get(pointers, _NO_POINTERS), pointers, [target])[0]
    types = {part: _TYPE}
    if pointers not in parts:
        types[pointers] = "application/vnd.openxmlformats-package.relationships+xml"
    result[CONTENT_TYPES] = add_types(parts[CONTENT_TYPES], types)
    seal_content = {
        "book": book,
        "sha256": {name: hashlib.sha256(content).hexdigest() for name, content in result.items()},
    }
    return {**result, part: json.dumps(seal_content, indent=1).encode()}


def sealed_text(content: bytes, ending: str, book: str) -> bytes:
    """Add its seal to a text.

    Args:
        content: the text; of JSON what stands before the end of the outermost object.
        ending: one of `ENDINGS`.
        book: the name of the workbook.
    """
    before, behind = ENDINGS[ending]
    digest = hashlib.sha256(content)
    return content + before + _seal(book, digest) + behind


def sealed_json(value: object, book: str) -> bytes:
    """Return an object as JSON, with the seal behind its other members; it holds no infinities."""
    text = json.dumps(value, ensure_ascii=False, allow_nan=False, indent=2)
    return sealed_text(text.removesuffix("\n}").encode(), ".json", book)


def seal_file(file: BinaryIO, book: str) -> None:
    """Seal a saved run, which ends in the zip's comment: one of the right length, made by `blank_seal`."""
    size = file.seek(0, 2) - len(blank_seal(book))
    digest = _digest(file, size)
    file.seek(size)
    file.write(_seal(book, digest))


def blank_seal(book: str) -> bytes:
    """Make a placeholder with as many bytes as the seal will have."""
    return _seal(book, hashlib.sha256())


def _seal(book: str, digest: hashlib._Hash) -> bytes:
    name = quote(book.encode("utf-8", "surrogatepass"), safe="").encode()
    full = digest.copy()
    full.update(b"\0" + name)
    return b"xlmc-seal book=%b sha256=%b" % (name, full.hexdigest().encode())


def _seal_at_end(path: Path, ending: str) -> Seal | None:
    before, behind = ENDINGS[ending]
    with path.open("rb") as file:
        size = file.seek(0, 2)
        start = file.seek(max(0, size - _MOST))
        end = file.read()
        match = re.search(re.escape(before) + _SEAL + re.escape(behind) + rb"\Z", end)
        if match is None:
            return None
        book = unquote(match["book"].decode(), errors="surrogatepass")
        return Seal(book, match[0] == before + _seal(book, _digest(file, start + match.start())) + behind)


def _digest(file: BinaryIO, size: int) -> hashlib._Hash:
    """Compute the SHA-256 of the first bytes of a file."""
    digest = hashlib.sha256()
    file.seek(0)
    while size > 0 and (chunk := file.read(min(size, _CHUNK))):
        digest.update(chunk)
        size -= len(chunk)
    return digest


@lru_cache(maxsize=1)
def _seal_of_package(data: bytes) -> Seal | None:
    """Return the seal in a workbook; a run asks three times about the file that it replaces."""
    try:
        parts = read_parts(data)
    except WorkbookError:  # it is no workbook, or one that was damaged
        return None
    seals = [name for name in parts if _SEAL_PART.fullmatch(name)]
    if len(seals) != 1:
        return None
    try:
        seal_content = json.loads(parts.pop(seals[0]))
        book, digests = str(seal_content["book"]), seal_content["sha256"]
    except (ValueError, KeyError, TypeError, RecursionError):  # somebody wrote it, and not xlmc
        return None
    return Seal(book, digests == {name: hashlib.sha256(content).hexdigest() for name, content in parts.items()})
