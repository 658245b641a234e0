"""The records of a binary Excel workbook (`.xlsb`): numbers of its cells, and how Excel calculates it.

Each part is a row of records: a type in one or two bytes, a length in up to four, of which each but the last has its
highest bit set, and the data. A record of a row is followed by those of its cells, which begin with their column.

Source: [MS-XLSB] for the types of records; LibreOffice's import filter for the settings of the calculation.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping
from typing import Final

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.formats import XLSB
from xlmc.excel.workbook.hidden_scripts import DamagedDrawing, scripts_of_sheet
from xlmc.excel.workbook.other_formats.old_workbook import OldBook, OldSheet, short_number
from xlmc.excel.workbook.other_formats.shape_texts import ShapeText
from xlmc.excel.workbook.package import relationships

__all__ = ["read_binary_workbook"]

_WORKBOOK: Final = "xl/workbook.bin"
_MACROS: Final = "xl/vbaProject.bin"

_ROW, _SHORT, _NUMBER, _FORMULA_NUMBER, _FORMULA_LOGICAL = 0, 2, 5, 9, 10
_SHEET, _CALCULATION, _ARRAY, _DATA_TABLE = 156, 157, 426, 428
"""Records, by their type."""

_FULL_PRECISION: Final = 0x0008
_CELL: Final = 8
"""Bytes of a cell before its value: column and style."""


def read_binary_workbook(parts: Mapping[str, bytes]) -> OldBook:
    """Read the records of the parts.

    Raises:
        WorkbookError: they are damaged.
    """
    try:
        return _read(parts)
    except (struct.error, IndexError, UnicodeDecodeError) as error:
        raise _damaged(str(error) or "it ends too early") from error


def _read(parts: Mapping[str, bytes]) -> OldBook:
    if _WORKBOOK not in parts:
        raise _damaged(f"it lacks its part {_WORKBOOK}")
    rels = relationships(parts, _WORKBOOK)
    sheets, as_displayed, manual = [], False, False
    for kind, data in _records(parts[_WORKBOOK]):
        if kind == _SHEET:
            relation, end = _text(data, 8)
            name, _ = _text(data, end)
            target = rels.get(relation)
            if target is not None and target.kind == "worksheet":
                if target.target not in parts:
                    raise _damaged(f"the sheet {name!r} is missing")
                sheets.append(_sheet(parts, name, target.target))
        elif kind == _CALCULATION:
            manual = struct.unpack_from("<i", data, 4)[0] == 0
            as_displayed = not struct.unpack_from("<H", data, 24)[0] & _FULL_PRECISION
    return OldBook(tuple(sheets), _MACROS in parts, as_displayed, manual)


def _sheet(parts: Mapping[str, bytes], name: str, part: str) -> OldSheet:
    sheet, row = OldSheet(name), 0
    for kind, data in _records(parts[part]):
        if kind == _ROW:
            row = struct.unpack_from("<I", data)[0] + 1
        elif kind in (_SHORT, _NUMBER, _FORMULA_NUMBER, _FORMULA_LOGICAL):
            at = (row, struct.unpack_from("<I", data)[0] + 1)
            if kind == _SHORT:
                sheet.numbers[at] = short_number(struct.unpack_from("<I", data, _CELL)[0])
            elif kind == _NUMBER:
                sheet.numbers[at] = struct.unpack_from("<d", data, _CELL)[0]
            elif kind == _FORMULA_NUMBER:
                sheet.results[at] = struct.unpack_from("<d", data, _CELL)[0]
            else:
                sheet.results[at] = bool(data[_CELL])
        elif kind in (_ARRAY, _DATA_TABLE):
            top, bottom, left, right = struct.unpack_from("<IIII", data)
            sheet.areas.append((top + 1, left + 1, bottom + 1, right + 1))
    for each in scripts_of_sheet(parts, name, part):
        if isinstance(each, DamagedDrawing):
            raise _damaged(f"the drawing of the sheet {name!r}: {each.reason}")
        sheet.texts.append(ShapeText(each.shape, each.text, ""))
    return sheet


def _records(stream: bytes) -> Iterator[tuple[int, bytes]]:
    """Return the type and the data of each record."""
    at, end = 0, len(stream)
    while at < end:
        kind, at = _number(stream, at, 2)
        length, at = _number(stream, at, 4)
        if at + length > end:
            raise _damaged("it ends too early")
        yield kind, stream[at : at + length]
        at += length


def _number(stream: bytes, at: int, most: int) -> tuple[int, int]:
    """Read a number of 7 bits in each byte, and where the next begins."""
    number = 0
    for each in range(most):
        byte = stream[at + each]
        number |= (byte & 0x7F) << 7 * each
        if not byte & 0x80:
            return number, at + each + 1
    return number, at + most


def _text(data: bytes, at: int) -> tuple[str, int]:
    """Read a text, which its length precedes, and where the next begins."""
    (length,) = struct.unpack_from("<I", data, at)
    if length == 0xFFFFFFFF:
        return "", at + 4
    end = at + 4 + 2 * length
    if end > len(data):
        raise _damaged("a name is longer than its record")
    return data[at + 4 : end].decode("utf-16-le"), end


def _damaged(reason: str) -> WorkbookError:
    hint = f"Fetch or copy it again. {XLSB.hint}"
    return WorkbookError(f"the file is {XLSB.noun}, and it is damaged: {reason}", hint=hint)
