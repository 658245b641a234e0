"""The record's account of the cells that a run needed: one a row, or, where they are very many, packed.

Packed contents are JSON (cell -> content), deflated, in base64, cut into pieces that a cell of a worksheet holds.
"""

from __future__ import annotations

import base64
import binascii
import hashlib
import json
import zlib
from collections.abc import Iterator, Mapping
from typing import Final

from xlmc.address import Cell, parse_address, quote_sheet
from xlmc.errors import WorkbookError
from xlmc.results.record.model import Entry, Record, RecordTable, Section

__all__ = ["MOST_ROWS", "cell_section", "recorded_cells"]

MOST_ROWS: Final = 1_000
"""Cells that are listed one a row."""

_PIECE: Final = 30_000
_LONGEST: Final = 32_000
_MOST_BYTES: Final = 256 << 20
"""Of the contents unpacked: more is no record that xlmc wrote."""

_COLUMNS: Final[tuple[tuple[str, str], ...]] = (("cell", "Cell"), ("content", "Content"))


def cell_section(needed: Mapping[Cell, str], *, rows: int = MOST_ROWS) -> Section:
    """Every needed cell with its content, so that one that was changed can be named.

    Args:
        needed: the cells and their contents.
        rows: the most cells to list one a row.
    """
    sheets = {name: quote_sheet(name) for name in {cell.sheet for cell in needed}}  # once each: cells may be very many
    contents = {f"{sheets[cell.sheet]}!{cell.a1}": text for cell, text in needed.items()}
    packed = _json(contents)
    entries = (
        Entry("count", "Cells", len(contents)),
        Entry("sha256", "SHA-256 of their contents", hashlib.sha256(packed).hexdigest()),
    )
    listed = len(contents) <= rows and max(map(len, contents.values()), default=0) <= _LONGEST
    title = "Cells that the run needed"
    if listed:
        return Section("cells", title, entries, RecordTable(_COLUMNS, tuple(contents.items())))
    return Section("cells", title, (*entries, *_pieces(packed)))


def recorded_cells(record: Record) -> dict[Cell, str]:
    """The cells of a record with their contents.

    Raises:
        KeyError: the record does not hold them.
        WorkbookError: what it holds of them is damaged.
    """
    count, expected = record["cells.count"], record["cells.sha256"]
    contents = {str(row["cell"]): str(row["content"]) for row in record.rows("cells")}
    if not contents:
        contents = _unpacked(record)
    if len(contents) != count or hashlib.sha256(_json(contents)).hexdigest() != expected:
        raise WorkbookError(
            "the cells in the record are not those that were written there",
            hint="The record was edited: use a copy of the result workbook as xlmc wrote it",
        )
    return {_cell(address): text for address, text in contents.items()}


def _json(contents: Mapping[str, str]) -> bytes:
    return json.dumps(contents, ensure_ascii=False, separators=(",", ":")).encode()


def _pieces(packed: bytes) -> Iterator[Entry]:
    text = base64.b64encode(zlib.compress(packed, 6)).decode()
    for number, start in enumerate(range(0, len(text), _PIECE), 1):
        yield Entry(f"packed_{number}", f"Packed, part {number}", text[start : start + _PIECE])


def _unpacked(record: Record) -> dict[str, str]:
    pieces = [entry.value for entry in record.section("cells").entries if entry.key.startswith("packed_")]
    try:
        stream = zlib.decompressobj()
        packed = stream.decompress(base64.b64decode("".join(map(str, pieces)), validate=True), _MOST_BYTES)
        found = json.loads(packed or b"{}")
    except (binascii.Error, zlib.error, ValueError) as error:
        raise WorkbookError("the cells in the record cannot be read", hint="The record was edited") from error
    return {str(address): str(text) for address, text in dict(found).items()}


def _cell(address: str) -> Cell:
    try:
        found = parse_address(address)
    except ValueError:
        found = None
    if not isinstance(found, Cell):
        raise WorkbookError(f"the record names the cell {address!r}", hint="The record was edited")
    return found
