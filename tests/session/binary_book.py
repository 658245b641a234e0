"""Binary Excel workbooks (`.xlsb`) for tests, record by record."""

from __future__ import annotations

import io
import struct
import zipfile
from collections.abc import Mapping

__all__ = ["binary_book", "cell", "formula", "record", "row"]

_TYPES = (
    '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="bin" ContentType="application/vnd.ms-excel.sheet.binary.macroEnabled.main"/>'
    "{}</Types>"
)
_SHEET_TYPE = '<Override PartName="/xl/worksheets/sheet{}.bin" ContentType="application/vnd.ms-excel.worksheet"/>'
_OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_RELS = '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">{}</Relationships>'
_REL = '<Relationship Id="rId{}" Type="' + _OFFICE + '/{}" Target="{}"/>'


def record(kind: int, data: bytes = b"") -> bytes:
    """A record: its type, its length, its data."""
    head = bytes([kind]) if kind < 128 else bytes([kind & 0x7F | 0x80, kind >> 7])
    length, size = b"", len(data)
    while size >= 128:
        length, size = length + bytes([size & 0x7F | 0x80]), size >> 7
    return head + length + bytes([size]) + data


def text(value: str) -> bytes:
    return struct.pack("<I", len(value)) + value.encode("utf-16-le")


def row(number: int, *cells: bytes) -> bytes:
    """A row, from 1, with the records of its cells."""
    return record(0, struct.pack("<IIHHBI", number - 1, 0, 300, 0, 0, 0)) + b"".join(cells)


def cell(column: int, value: float | str) -> bytes:
    """A constant in a column, from 1."""
    at = struct.pack("<II", column - 1, 0)
    return record(6, at + text(value)) if isinstance(value, str) else record(5, at + struct.pack("<d", value))


def formula(column: int, tokens: bytes, value: float | bool) -> bytes:
    """A formula with the result that Excel saved."""
    at, is_logical = struct.pack("<II", column - 1, 0), isinstance(value, bool)
    saved = bytes([value]) if is_logical else struct.pack("<d", value)
    return record(
        10 if is_logical else 9, at + saved + struct.pack("<HI", 0, len(tokens)) + tokens + struct.pack("<I", 0)
    )


def ref(address_row: int, column: int) -> bytes:
    """A relative reference, as a token."""
    return struct.pack("<BIH", 0x44, address_row - 1, column - 1 | 0xC000)


def binary_book(
    sheets: Mapping[str, bytes],
    *,
    more: Mapping[str, bytes] | None = None,
    as_displayed: bool = False,
    manual: bool = False,
    relations: str = "",
) -> bytes:
    """A workbook; `more` are further parts, `relations` those of its first sheet."""
    calculation = struct.pack(
        "<IIIdIH", 191029, 0 if manual else 1, 100, 0.001, 1, (0 if as_displayed else 0x08) | 0x02
    )
    bundles = b"".join(
        record(156, struct.pack("<II", 0, n) + text(f"rId{n}") + text(name)) for n, name in enumerate(sheets, 1)
    )
    workbook = record(131) + record(143) + bundles + record(144) + record(157, calculation) + record(132)
    parts = {
        "[Content_Types].xml": _TYPES.format("".join(_SHEET_TYPE.format(n + 1) for n in range(len(sheets)))).encode(),
        "_rels/.rels": _RELS.format(_REL.format(1, "officeDocument", "xl/workbook.bin")).encode(),
        "xl/workbook.bin": workbook,
        "xl/_rels/workbook.bin.rels": _RELS.format(
            "".join(_REL.format(n + 1, "worksheet", f"worksheets/sheet{n + 1}.bin") for n in range(len(sheets)))
        ).encode(),
        **{
            f"xl/worksheets/sheet{n}.bin": record(129) + record(145) + rows + record(146) + record(130)
            for n, rows in enumerate(sheets.values(), 1)
        },
        **(more or {}),
    }
    if relations:
        parts["xl/worksheets/_rels/sheet1.bin.rels"] = _RELS.format(relations).encode()
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as package:
        for name, data in parts.items():
            package.writestr(name, data)
    return stream.getvalue()
