"""The package of a saved run: entries stored as they are, so that none unpacks to more than the file holds."""

from __future__ import annotations

import hashlib
import io
import re
import struct
import zipfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any, BinaryIO, Final

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from xlmc.errors import WorkbookError
from xlmc.montecarlo.columns import PART, parts

__all__ = [
    "AGAIN",
    "DAMAGE",
    "RUN",
    "SUFFIX",
    "WORKBOOK",
    "Package",
    "column_header",
    "column_parts",
    "open_package",
    "read_column",
    "write_entries",
]


SUFFIX: Final = ".xlmcrun"
RUN: Final = "run.json"
WORKBOOK: Final = "workbook"
AGAIN: Final = "Save the run again, or fetch or copy the file again"
_NAMES: Final = re.compile(r"run\.json|workbook|fed/\d{1,4}|columns/\d{1,6}\.npy")
_EPOCH: Final = (1980, 1, 1, 0, 0, 0)  # the earliest time a zip can hold
_ENCRYPTED: Final = 0x1
_MOST_ENTRIES: Final = 100_000
DAMAGE: Final = (  # what zipfile raises on a damaged file
    zipfile.BadZipFile,
    struct.error,
    EOFError,
    OSError,
    OverflowError,
    RuntimeError,
    ValueError,
    NotImplementedError,
)
_TYPES: Final = {"<f8": np.dtype("<f8"), "<i8": np.dtype("<i8")}


def write_entries(file: BinaryIO, entries: Iterable[tuple[str, int, Iterable[bytes]]], comment: bytes = b"") -> None:
    """Write entries one after the other; the same entries give the same bytes.

    Args:
        file: where to, from its start.
        entries: name, size in bytes, and the bytes, a part at a time.
        comment: with which the file ends.
    """
    with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as package:
        package.comment = comment
        for name, size, parts in entries:
            entry = zipfile.ZipInfo(name, _EPOCH)
            entry.create_system = 0  # otherwise the file would say on which system it was written
            entry.file_size = size  # large ones need a larger header
            with package.open(entry, "w") as writer:
                for part in parts:
                    writer.write(part)


class Package:
    """An open package; its entries are read when they are asked for."""

    def __init__(self, package: zipfile.ZipFile, path: Path) -> None:
        self._package, self._path = package, path
        self._sizes = {entry.filename: entry.file_size for entry in package.infolist()}

    def __contains__(self, name: object) -> bool:
        return name in self._sizes

    def size(self, name: str) -> int:
        """Return the size of an entry, in bytes.

        Raises:
            WorkbookError: there is no such entry.
        """
        if name not in self._sizes:
            raise WorkbookError(f"the saved run lacks {name!r}", where=self._path, hint=AGAIN)
        return self._sizes[name]

    @contextmanager
    def reading(self, name: str) -> Iterator[IO[bytes]]:
        """Open an entry, to be read front to back; what lies in it is checked at its end.

        Raises:
            WorkbookError: there is no such entry, or it is damaged.
        """
        self.size(name)
        with _naming_damage(self._path), self._package.open(name) as entry:
            yield entry


@contextmanager
def open_package(path: Path) -> Iterator[Package]:
    """Open the package of a saved run.

    Raises:
        WorkbookError: the file cannot be opened, is no saved run, or is damaged.
    """
    try:
        file = path.open("rb")
    except FileNotFoundError as error:
        raise WorkbookError("there is no such file", where=path, hint="Check its name and folder") from error
    except OSError as error:
        hint = "Name a saved run, which ends in .xlmcrun, that you may read"
        raise WorkbookError(f"the file cannot be read ({error.strerror})", where=path, hint=hint) from error
    with file:
        with _naming_damage(path):
            package = zipfile.ZipFile(file)
        with package:
            _check(package, path)
            yield Package(package, path)


def _check(package: zipfile.ZipFile, path: Path) -> None:
    """Refuse what xlmc does not write: entries that are packed, overlap, or have other names."""
    entries = package.infolist()
    names = [entry.filename for entry in entries]
    if RUN not in names:
        raise WorkbookError(
            "the file is not a saved run", where=path, hint="Save one with xlmc simulate BOOK -o RUN.xlmcrun"
        )
    plain = all(
        entry.compress_type == zipfile.ZIP_STORED
        and entry.file_size == entry.compress_size
        and not entry.flag_bits & _ENCRYPTED
        and _NAMES.fullmatch(entry.filename)
        for entry in entries
    )
    together = sum(entry.file_size for entry in entries)
    if not plain or len(set(names)) < len(names) or len(names) > _MOST_ENTRIES or together > path.stat().st_size:
        raise WorkbookError("the saved run was packed by something else than xlmc", where=path, hint=AGAIN)


@contextmanager
def _naming_damage(path: Path) -> Iterator[None]:
    """Raise what is damaged as a WorkbookError, in words.

    Raises:
        WorkbookError: the package is damaged.
    """
    try:
        yield
    except zipfile.BadZipFile as error:
        raise WorkbookError(f"the saved run is damaged ({error})", where=path, hint=AGAIN) from error
    except DAMAGE as error:
        reason = str(error) or "it ends too early"
        raise WorkbookError(f"the saved run is damaged ({reason})", where=path, hint=AGAIN) from error


def column_header(count: int, kind: str) -> bytes:
    """Return what stands before the numbers of a column: `count` of them, of the type `<f8` or `<i8`."""
    header = io.BytesIO()
    npy.write_array_header_1_0(header, {"descr": kind, "fortran_order": False, "shape": (count,)})
    return header.getvalue()


def column_parts(values: NDArray[Any], kind: str, digest: hashlib._Hash) -> Iterator[bytes]:
    """Yield a column's header and numbers, a part at a time; all of it goes into the digest too."""
    header = column_header(values.size, kind)
    digest.update(header)
    yield header
    for part in parts(values):
        written = np.ascontiguousarray(part.astype(_TYPES[kind], copy=False)).tobytes()
        digest.update(written)
        yield written


def read_column(entry: IO[bytes], kind: str, count: int, name: str, digest: hashlib._Hash) -> Iterator[NDArray[Any]]:
    """Yield the numbers of a column, a part at a time, each in memory of its own.

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
    return WorkbookError(f"the column {name!r} of the saved run differs from what the file says of it", hint=AGAIN)
