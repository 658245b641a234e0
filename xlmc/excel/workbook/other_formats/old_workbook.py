"""The records of an old Excel workbook (`.xls`): numbers of its cells, and hidden texts of its drawings.

Nothing else is read here: LibreOffice converts the rest. It drops hidden texts, and writes numbers with 15 digits.

Source: [MS-XLS], BIFF8; and [MS-CFB], which `olefile` reads.
"""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final

import olefile

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.formats import XLS
from xlmc.excel.workbook.other_formats.shape_texts import ShapeText, shape_texts
from xlmc.excel.workbook.package import SAVE_AS

__all__ = ["OldBook", "OldSheet", "Position", "read_old_workbook", "short_number"]

_MACROS: Final = "_VBA_PROJECT_CUR"

_FORMULA, _END, _CALCULATION, _PRECISION, _FILE_PASSWORD, _CONTINUE, _OBJECT = 0x06, 0x0A, 0x0D, 0x0E, 0x2F, 0x3C, 0x5D
_SHEET, _MANY_SHORT, _DRAWING, _TEXT_OBJECT = 0x85, 0xBD, 0xEC, 0x1B6
_NUMBER, _ARRAY, _DATA_TABLE, _SHORT, _BEGIN = 0x203, 0x221, 0x236, 0x27E, 0x809
"""Records, by their type."""

_BIFF8: Final = 0x0600
_WORKSHEET: Final = 0
_NO_NUMBER: Final = b"\xff\xff"
"""Ends the value of a formula that is a text, a logical, an error or nothing."""

_LOGICAL: Final = 1
"""Begins such a value that is a logical."""

_DEEPEST: Final = 16
"""Substreams within substreams; a chart in a sheet is one."""

Position = tuple[int, int]
"""Row and column, from 1."""


@dataclass(slots=True)
class OldSheet:
    """A worksheet.

    Attributes:
        numbers: in cells without a formula.
        results: of formulas, as Excel saved them, where they are numbers or logicals.
        areas: of array formulas and what-if tables: the first and the last row and column. Of their cells one alone
            keeps a formula in an `.xlsx`.
        texts: of hidden shapes.
    """

    name: str
    numbers: dict[Position, float] = field(default_factory=dict)
    results: dict[Position, float | bool] = field(default_factory=dict)
    areas: list[tuple[int, int, int, int]] = field(default_factory=list)
    texts: list[ShapeText] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class OldBook:
    """What is read of a workbook.

    Attributes:
        sheets: the worksheets in tab order.
        macros: whether there are any.
        as_displayed: Excel calculates with the digits that are shown.
        manual: Excel calculates when it is asked to.
        tells_logicals: whether the file tells TRUE from 1 among the results of formulas.
    """

    sheets: tuple[OldSheet, ...]
    macros: bool
    as_displayed: bool
    manual: bool
    tells_logicals: bool = True


def read_old_workbook(data: bytes) -> OldBook:
    """Read the records of a file.

    Raises:
        WorkbookError: it is encrypted, older than Excel 97, damaged, or no workbook.
    """
    try:
        stream, macros = _stream(data)
        reading = _Reading(stream)
        return OldBook(tuple(reading.sheets()), macros, reading.as_displayed, reading.manual)
    except (struct.error, IndexError, UnicodeDecodeError) as error:
        raise _damaged(str(error) or "it ends too early") from error


def _stream(data: bytes) -> tuple[bytes, bool]:
    """Return the workbook's stream, and whether the file holds macros."""
    try:
        with olefile.OleFileIO(io.BytesIO(data)) as file:
            names = {path[0].casefold() for path in file.listdir(storages=True)}
            if "workbook" in names:
                return file.openstream("Workbook").read(), _MACROS.casefold() in names
    except Exception as error:  # olefile promises no kind of error for a damaged file
        raise _damaged(str(error) or type(error).__name__) from error
    if "book" in names:
        raise WorkbookError("the file is a workbook of Excel 95 or older (.xls)", hint=XLS.hint)
    raise WorkbookError("the file is an old Office file, but not a workbook", hint=SAVE_AS)


def _damaged(reason: str) -> WorkbookError:
    hint = f"Fetch or copy it again. {XLS.hint}"
    return WorkbookError(f"the file is {XLS.noun}, and it is damaged: {reason}", hint=hint)


class _Reading:
    """One pass over the records: first those of the workbook, which say where each sheet begins, then the sheets."""

    def __init__(self, stream: bytes) -> None:
        self._stream = stream
        self.as_displayed = self.manual = False
        self._starts: dict[int, OldSheet | None] = {}
        self._sheet: OldSheet | None = None
        self._drawing = bytearray()
        self._last = -1  # the record before, but for those that continue one
        self._characters = self._formats = 0  # of a text that go on in records that continue

    def sheets(self) -> Iterator[OldSheet]:
        depth, first, seen = 0, True, set()
        for at, kind, data in self._records():
            if kind == _BEGIN:
                depth += 1
                if depth > _DEEPEST:
                    raise _damaged("its parts are nested too deeply")
                if depth == 1:
                    self._begin(at, data, first)
                    first = False
                    seen.add(at)
            elif kind == _END:
                depth = max(depth - 1, 0)
                if depth == 0:
                    self._close()
            elif depth == 1:
                if kind == _FILE_PASSWORD:
                    hint = "Remove its password in Excel (File > Info) and save it"
                    raise WorkbookError("the workbook is encrypted", hint=hint)
                self._take(kind, data)
        if first:
            raise _damaged("it holds no workbook")
        for at, sheet in self._starts.items():
            if sheet is not None and at not in seen:
                raise _damaged(f"the sheet {sheet.name!r} is missing")
        self._close()
        yield from (sheet for sheet in self._starts.values() if sheet is not None)

    def _records(self) -> Iterator[tuple[int, int, bytes]]:
        at, end = 0, len(self._stream)
        while at + 4 <= end:
            kind, length = struct.unpack_from("<HH", self._stream, at)
            if kind == 0 and length == 0:  # the stream is filled up
                return
            if at + 4 + length > end:
                raise _damaged("it ends too early")
            yield at, kind, self._stream[at + 4 : at + 4 + length]
            at += 4 + length

    def _begin(self, at: int, data: bytes, first: bool) -> None:
        if struct.unpack_from("<H", data)[0] != _BIFF8:
            raise WorkbookError("the file is a workbook of Excel 95 or older (.xls)", hint=XLS.hint)
        self._sheet = None if first else self._starts.get(at)
        self._last = _BEGIN

    def _close(self) -> None:
        if self._sheet is not None and self._drawing:
            self._sheet.texts += shape_texts(bytes(self._drawing), self._sheet.name)
        self._drawing.clear()
        self._sheet = None

    def _take(self, kind: int, data: bytes) -> None:
        if kind == _SHEET:
            self._list_sheet(data)
        elif kind == _PRECISION:
            self.as_displayed = data[0] == 0
        elif kind == _CALCULATION:
            self.manual = data[0] == 0
        elif self._sheet is not None:
            if kind == _CONTINUE:
                self._go_on(data)
                return
            if kind == _DRAWING:
                self._drawing += data
            elif kind == _TEXT_OBJECT:
                self._characters, self._formats = struct.unpack_from("<HH", data, 10)
            else:
                _take_cells(self._sheet, kind, data)
            self._last = kind

    def _list_sheet(self, data: bytes) -> None:
        start, _, kind, length, wide = struct.unpack_from("<IBBBB", data)
        name = data[8 : 8 + length * (1 + (wide & 1))].decode("utf-16-le" if wide & 1 else "latin-1")
        if start in self._starts:
            raise _damaged("two sheets begin at one place")
        self._starts[start] = OldSheet(name) if kind == _WORKSHEET else None

    def _go_on(self, data: bytes) -> None:
        """Take a record that continues another: a drawing, also behind the object of a shape, or a text of one."""
        if self._last == _TEXT_OBJECT and self._characters > 0:
            wide = data[0] & 1
            self._characters -= (len(data) - 1) // (1 + wide)
        elif self._last == _TEXT_OBJECT and self._formats > 0:
            self._formats -= len(data)
        elif self._last in (_DRAWING, _OBJECT, _TEXT_OBJECT):
            self._drawing += data


def _take_cells(sheet: OldSheet, kind: int, data: bytes) -> None:
    if kind == _NUMBER:
        row, column, _, number = struct.unpack_from("<HHHd", data)
        sheet.numbers[row + 1, column + 1] = number
    elif kind == _SHORT:
        row, column, _, short = struct.unpack_from("<HHHI", data)
        sheet.numbers[row + 1, column + 1] = short_number(short)
    elif kind == _MANY_SHORT:
        row, column = struct.unpack_from("<HH", data)
        for offset, at in enumerate(range(4, len(data) - 2, 6)):
            (short,) = struct.unpack_from("<I", data, at + 2)
            sheet.numbers[row + 1, column + 1 + offset] = short_number(short)
    elif kind == _FORMULA:
        row, column, _, value = struct.unpack_from("<HHH8s", data)
        if value[6:] != _NO_NUMBER:
            (sheet.results[row + 1, column + 1],) = struct.unpack("<d", value)
        elif value[0] == _LOGICAL:
            sheet.results[row + 1, column + 1] = bool(value[2])
    elif kind in (_ARRAY, _DATA_TABLE):
        top, bottom, left, right = struct.unpack_from("<HHBB", data)
        sheet.areas.append((top + 1, left + 1, bottom + 1, right + 1))


def short_number(short: int) -> float:
    """Read a number in 30 bits: a whole one, or the first bits of a float; both perhaps times 100."""
    if short & 2:
        whole = short >> 2
        number = float(whole - (1 << 30) if whole >> 29 else whole)
    else:
        (number,) = struct.unpack("<d", struct.pack("<Q", (short & 0xFFFFFFFC) << 32))
    return number / 100 if short & 1 else number
