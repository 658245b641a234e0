"""Columns in files of a temporary folder, which goes when nothing needs it any more.

A `ColumnStore` gathers columns and writes them once they are long; a `Folder` holds their files; each file is read as
an array that is mapped into memory.
"""

from __future__ import annotations

import ctypes
import errno
import mmap
import os
import shutil
import tempfile
import weakref
from collections.abc import Hashable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.cache_lines import CACHE_LINE
from xlmc.errors import SimulationError
from xlmc.excel.workbook.temporary_names import new_folder_name, owned, remove_abandoned_folders
from xlmc.montecarlo.interruption import checkpoint

__all__ = [
    "IN_MEMORY",
    "ColumnStore",
    "Columns",
    "Folder",
    "free_disk",
    "mapped",
    "on_disk",
    "release",
]


class _Mapping(mmap.mmap):
    """Tells our read-only maps, whose pages can be dropped at any time, from those of others, whose may not."""


def mapped(path: Path, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Return the `(n,)` numbers of a file, read-only; the file may be deleted meanwhile where the system allows it."""
    if path.stat().st_size == 0:
        return np.empty(0, dtype)
    with path.open("rb") as file:
        return np.frombuffer(_Mapping(file.fileno(), 0, access=mmap.ACCESS_READ), dtype)


def on_disk(values: NDArray[Any]) -> bool:
    """Whether the array is one of `mapped`, or part of one."""
    return _mapping(values) is not None


def release(values: NDArray[Any]) -> None:
    """Give back the memory that an array of `mapped` took so far; it is read again when it is asked for."""
    mapping = _mapping(values)
    if mapping is not None and hasattr(mmap, "MADV_DONTNEED"):
        mapping.madvise(mmap.MADV_DONTNEED)


def _mapping(values: NDArray[Any]) -> _Mapping | None:
    base: object = values
    while isinstance(base, np.ndarray):
        base = base.base
    if isinstance(base, memoryview):
        base = base.obj
    return base if isinstance(base, _Mapping) else None


_FULL = (errno.ENOSPC, errno.EDQUOT)
_HINT = "Set TMPDIR to a folder on a disk with more space, or ask for fewer trials"
_TOO_MANY = (errno.EMFILE, errno.ENFILE)


class Folder:
    """Files of raw numbers, each written front to back.

    It is removed with this object, or at the interpreter's end. An array that is still mapped keeps its numbers.

    Raises:
        SimulationError: there is no folder to write to.
    """

    def __init__(self) -> None:
        with _naming_folder(None):
            self.path = Path(tempfile.gettempdir(), new_folder_name())
            resources = ExitStack()
            resources.enter_context(owned(self.path.name))
            # Before there is a folder: a signal that ends the process may come at any time.
            self._end = weakref.finalize(self, _remove, self.path, os.getpid(), resources)
            self.path.mkdir(mode=0o700)

    def append(self, name: str, arrays: Iterable[NDArray[Any]]) -> None:
        """Write `(n,)` arrays at the end of a file.

        Raises:
            SimulationError: the disk is full, or the folder cannot be written to.
        """
        with _naming_folder(self.path), (self.path / name).open("ab") as file:
            for array in arrays:
                file.write(array.data)

    def array(self, name: str, dtype: np.dtype[Any]) -> NDArray[Any]:
        """Return the numbers of a file, `(n,)`, read-only; see `release`.

        Raises:
            SimulationError: the file cannot be read.
        """
        with _naming_folder(self.path):
            return mapped(self.path / name, dtype)

    def remove(self, name: str) -> None:
        """Delete a file, if it is there; where an open file cannot be deleted, it goes with the folder."""
        with _naming_folder(self.path):
            try:
                (self.path / name).unlink(missing_ok=True)
            except PermissionError:  # Windows, while an array is mapped
                return


def _remove(path: Path, owner: int, resources: ExitStack) -> None:
    if os.getpid() == owner:  # a forked child inherits the object, not the folder
        shutil.rmtree(path, ignore_errors=True)
        resources.close()


def free_disk() -> tuple[Path, int]:
    """Return the temporary folder and the bytes that are free there.

    Raises:
        SimulationError: there is no folder to write to.
    """
    with _naming_folder(None):
        folder = Path(tempfile.gettempdir())
        return folder, shutil.disk_usage(folder).free


@contextmanager
def _naming_folder(path: Path | None) -> Iterator[None]:
    """Turn errors of the disk into messages that name the folder."""
    try:
        yield
    except OSError as error:
        where, hint = path or "temporary folder", _HINT
        message = f"the accepted trials cannot be kept there: {error.strerror or error}"
        if error.errno in _FULL:
            message = "there is no space left on the disk for the accepted trials"
        elif error.errno in _TOO_MANY:
            hint = "Allow more open files: ulimit -n 8192"
        raise SimulationError(message, where=where, hint=hint) from error


IN_MEMORY: Final = 1 << 27
"""Bytes of all columns of a store together that stay in memory."""

WRITTEN: Final = 1 << 24
"""Bytes that are gathered before they are written: large writes cost least."""

_OF_A_COLUMN: Final = 1 << 18
"""The same of a column, where there are so many that each would be opened for little."""

_RESERVED: Final = 1.5
"""Memory reserved for columns that are to be written, as a multiple of what is gathered before that."""

Array = NDArray[Any]

_LARGE: Final = 1 << 22
"""Bytes of an array from which on NumPy asks the system for large pages: many small ones take ten times as long."""


class Columns(Mapping[str, Array]):
    """Columns in files, by name. Each is mapped anew whenever it is asked for, so that none stays in memory.

    `rows` are the numbers of each, from the first on, that count; None for all.
    """

    def __init__(self, folder: Folder, files: Mapping[str, tuple[str, np.dtype[Any]]], rows: int | None = None) -> None:
        self._folder, self._files, self._rows = folder, files, rows

    def __getitem__(self, name: str) -> Array:
        file, dtype = self._files[name]
        return self._folder.array(file, dtype)[: self._rows]

    def __iter__(self) -> Iterator[str]:
        return iter(self._files)

    def __len__(self) -> int:
        return len(self._files)


def _address(array: Array) -> int:
    """Return the address of an array that can be written to; NumPy's own way takes five times as long."""
    return ctypes.addressof(ctypes.c_char.from_buffer(array))  # type: ignore[arg-type]  # it has a buffer


class ColumnStore:
    """Collects columns of numbers. Folders that killed runs left are removed.

    Each column is one array, made for as many numbers as are expected: memory that is taken once costs less than
    memory for every part, and what is not written to is only reserved.

    Args:
        types: column -> the type of its numbers.
        expected: column -> about how many numbers it will have; more is allowed.
        filled: whether all will have so many: then memory is taken for many columns at once.
        in_memory: bytes of all columns together that stay in memory; None for `IN_MEMORY`.
    """

    def __init__(
        self,
        types: Mapping[Hashable, np.dtype[Any]],
        expected: Mapping[Hashable, int] | None = None,
        *,
        filled: bool = False,
        in_memory: int | None = None,
    ) -> None:
        self._in_memory = IN_MEMORY if in_memory is None else in_memory
        self._types, self._filled = dict(types), filled
        self._files = {key: f"{number}.column" for number, key in enumerate(types)}
        self._expected = expected or {}
        self._together = sum(types[key].itemsize * rows for key, rows in self._expected.items())
        self._arrays = {key: np.empty(0, dtype) for key, dtype in types.items()}
        self._sizes = dict.fromkeys(types, 0)
        self._bytes = 0
        self._folder: Folder | None = None
        remove_abandoned_folders()

    def add(self, key: Hashable, values: Array) -> None:
        """Put `(m,)` values at the end of a column; those that were written to `reserve` are there already.

        The system gives memory when it is first written to, which may take longer than all else: so work that is not
        wanted any more is given up here.
        """
        checkpoint()
        end = self.reserve(key, values.size)
        if values.size and (values.base is not end.base or _address(values) != _address(end)):
            end[:] = values
        self._sizes[key] += values.size
        self._bytes += values.nbytes

    def reserve(self, key: Hashable, n: int) -> Array:
        """Reserve the memory of a column's next `n` numbers."""
        begin = self._sizes[key]
        if begin + n > self._arrays[key].size:
            self._grow(key, begin + n)
        return self._arrays[key][begin : begin + n]

    def _grow(self, key: Hashable, least: int) -> None:
        """Move a column into an array for at least so many numbers, and for twice as many as it was made for."""
        array_now = self._arrays[key]
        size = max(least, 2 * array_now.size, self._expected_size(key))
        if self._filled and not array_now.size and self._folder is None and size * array_now.itemsize < _LARGE:
            self._grow_together(key, size)
            return
        array = np.empty(size, array_now.dtype)
        array[: self._sizes[key]] = self._added(key)
        self._arrays[key] = array

    def _grow_together(self, key: Hashable, size: int) -> None:
        """Make arrays for so many numbers, in one piece of memory: for a column, and for those that will be as long."""
        expected = self._expected.get(key)
        alike = [other for other, rows in self._expected.items() if rows == expected and not self._arrays[other].size]
        # An odd number of lines of the cache: else the same rows of all columns would have the same place in it.
        lines = max(-(-size * self._types[other].itemsize // CACHE_LINE) for other in (key, *alike)) | 1
        memory = np.empty((len({key, *alike}), lines * CACHE_LINE), np.uint8)
        for other, row in zip(dict.fromkeys((key, *alike)), memory, strict=True):
            self._arrays[other] = row.view(self._types[other])[:size]

    def _expected_size(self, key: Hashable) -> int:
        """How many numbers a column will have, or have when all columns are written, if they grow together.

        These are written after the block that fills the memory, which may be large.
        """
        expected, reserved = self._expected.get(key, 0), _RESERVED * self._most
        return expected if self._together <= reserved else int(expected * reserved / self._together)

    def _added(self, key: Hashable) -> Array:
        """Return the numbers of a column that are in memory, `(m,)`."""
        return self._arrays[key][: self._sizes[key]]

    def write_if_full(self) -> None:
        """Write what waits, if it is much; to be called when all columns of a block are added.

        Raises:
            SimulationError: there is no space on the disk.
        """
        if self._bytes > self._most:
            self._write()

    @property
    def _most(self) -> int:
        """Bytes that are gathered before they are written."""
        if self._folder is None:
            return self._in_memory
        return max(WRITTEN, min(self._in_memory // 2, _OF_A_COLUMN * len(self._types)))

    def _write(self) -> None:
        before, self._folder = self._folder, self._folder or Folder()
        for key, file in self._files.items():
            checkpoint()
            self._folder.append(file, [self._added(key)])
            self._sizes[key] = 0
            if before is None:  # these may be somebody's columns
                self._arrays[key] = np.empty(0, self._types[key])
        self._bytes = 0

    def columns(self, keys: Mapping[str, Hashable], rows: int | None = None) -> Mapping[str, Array]:
        """Return the columns so far, each under a name of its own, or their first `rows`; in memory if none was written
        yet.

        Raises:
            SimulationError: there is no space on the disk.
        """
        if self._folder is None:
            return {name: self._compact(key)[:rows] for name, key in keys.items()}
        self._write()
        return Columns(self._folder, {name: (self._files[key], self._types[key]) for name, key in keys.items()}, rows)

    def _compact(self, key: Hashable) -> Array:
        """Copy a column into no more than twice the memory that it needs."""
        if 2 * self._sizes[key] < self._arrays[key].size:
            self._arrays[key] = self._added(key).copy()
        return self._added(key)
