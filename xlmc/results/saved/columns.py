"""Columns of numbers as NumPy's `.npy` entries, written and read a part at a time; no object is ever unpickled."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Iterator
from typing import IO, Any, Final

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from xlmc.columns import PART, parts
from xlmc.errors import WorkbookError
from xlmc.results.saved.archive import AGAIN

__all__ = ["column_header", "column_parts", "read_column"]

_TYPES: Final = {"<f8": np.dtype("<f8"), "<i8": np.dtype("<i8")}


def column_header(count: int, kind: str) -> bytes:
    """What stands before the numbers of a column: `count` of them, of the type `<f8` or `<i8`."""
    header = io.BytesIO()
    npy.write_array_header_1_0(header, {"descr": kind, "fortran_order": False, "shape": (count,)})
    return header.getvalue()


def column_parts(values: NDArray[Any], kind: str, digest: hashlib._Hash) -> Iterator[bytes]:
    """A column's header and numbers, a part at a time; all of it goes into the digest too."""
    header = column_header(values.size, kind)
    digest.update(header)
    yield header
    for part in parts(values):
        written = np.ascontiguousarray(part.astype(_TYPES[kind], copy=False)).tobytes()
        digest.update(written)
        yield written


def read_column(entry: IO[bytes], kind: str, count: int, name: str, digest: hashlib._Hash) -> Iterator[NDArray[Any]]:
    """The numbers of a column, a part at a time, each in memory of its own.

    Args:
        entry: where it lies, from its start.
        kind: `<f8` or `<i8`.
        count: how many numbers it must hold.
        name: of the entry, for messages.
        digest: takes all that is read.

    Raises:
        WorkbookError: it holds something else.
    """
    expected = column_header(count, kind)
    header = entry.read(len(expected))
    digest.update(header)
    if header != expected:
        raise _other(name)
    left = count
    while left:
        size = min(left, PART)
        data = entry.read(size * _TYPES[kind].itemsize)
        digest.update(data)
        if len(data) != size * _TYPES[kind].itemsize:
            raise _other(name)
        yield np.frombuffer(bytearray(data), _TYPES[kind]).astype(_TYPES[kind].newbyteorder("="), copy=False)
        left -= size
    if entry.read(1):
        raise _other(name)


def _other(name: str) -> WorkbookError:
    return WorkbookError(f"the column {name!r} of the saved run is not what it says it is", hint=AGAIN)
