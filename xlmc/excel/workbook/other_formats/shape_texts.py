"""Hidden texts of the shapes in a drawing of an old Excel workbook.

A drawing is a tree of records; a shape is a container with tables of its properties, among them its name, and the
script text that a program keeps with it.

Source: [MS-ODRAW] 2.2.14 (a shape), 2.2.9 (its properties); five `.xls` workbooks that Crystal Ball 11.1.2 wrote, for
which properties hold the texts.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import Final, NamedTuple

from xlmc.errors import WorkbookError

__all__ = ["ShapeText", "shape_texts"]

_SHAPE: Final = 0xF004
_TABLES: Final = (0xF00B, 0xF121, 0xF122)
_NAME, _TEXT, _MORE = 0x380, 0x38E, 0x397
_DEEPEST: Final = 32
_CONTAINER: Final = 0xF


class ShapeText(NamedTuple):
    """The script text of a shape, under the shape's name; and what the program adds to it."""

    shape: str
    text: str
    more: str


def shape_texts(drawing: bytes, sheet: str) -> Iterator[ShapeText]:
    """Return the texts of all shapes, in the order of the drawing.

    Args:
        drawing: its bytes, from all its records.
        sheet: its name, for messages.

    Raises:
        WorkbookError: the drawing is damaged: a text might be missing.
    """
    try:
        for shape in _shapes(drawing, 0, len(drawing), 0):
            result = _properties(shape)
            if _TEXT in result:
                yield ShapeText(*(_text(result.get(key, b"")) for key in (_NAME, _TEXT, _MORE)))
    except (struct.error, _DrawingError) as error:
        message = f"the drawing of the sheet {sheet!r} is damaged ({error}), and it may hold data of Crystal Ball"
        raise WorkbookError(message, hint="Open the workbook in Excel with Crystal Ball, and save it again") from None


class _DrawingError(ValueError):
    """A record is longer than what holds it, or nested too deeply."""


def _shapes(data: bytes, start: int, end: int, depth: int) -> Iterator[bytes]:
    """Return the content of every shape's container, also in groups of shapes."""
    if depth > _DEEPEST:
        raise _DrawingError("its shapes are nested too deeply")
    for version, kind, at, stop in _records(data, start, end):
        if kind == _SHAPE:
            yield data[at:stop]
        elif version & 0xF == _CONTAINER:
            yield from _shapes(data, at, stop, depth + 1)


def _records(data: bytes, start: int, end: int) -> Iterator[tuple[int, int, int, int]]:
    """Version and instance, type, start and end of the records that lie one behind the other."""
    while start < end:
        if start + 8 > end:
            raise _DrawingError("it ends too early")
        version, kind, length = struct.unpack_from("<HHI", data, start)
        start += 8
        if start + length > end:
            raise _DrawingError("a record is longer than what holds it")
        yield version, kind, start, start + length
        start += length


def _properties(shape: bytes) -> dict[int, bytes]:
    """Return the properties of a shape that are longer than a number, by their identifiers."""
    result: dict[int, bytes] = {}
    for version, kind, at, stop in _records(shape, 0, len(shape)):
        if kind in _TABLES:
            values = at + 6 * (version >> 4)
            for entry in range(at, values, 6):
                name, length = struct.unpack_from("<HI", shape, entry)
                if name & 0x8000:
                    if values + length > stop:
                        raise _DrawingError("a property is longer than its table")
                    result[name & 0x3FFF] = shape[values : values + length]
                    values += length
    return result


def _text(value: bytes) -> str:
    """Read a text in UTF-16 up to its final zero; what is no text there is marked."""
    return value[: len(value) // 2 * 2].decode("utf-16-le", "replace").split("\0", 1)[0]
