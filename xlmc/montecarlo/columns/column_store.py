"""Columns in files of a temporary folder, which goes when nothing needs it any more.

A `ColumnStore` gathers columns and writes them once they are long; a `Folder` holds their files; a column is read as an
array that is mapped into memory. Columns that will not be long lie in one file, each at a place of its own: to make,
to open and to delete a file for each of some hundred takes longer than to write what is in them.
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
from dataclasses import dataclass, replace
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


def mapped(path: Path, dtype: np.dtype[Any], begin: int = 0, count: int | None = None) -> NDArray[Any]:
    """Return the `(n,)` numbers of a file, read-only; the file may be deleted meanwhile where the system allows it.

    Args:
        path: the file.
        dtype: the type of the numbers.
        begin: the byte of the first one, a multiple of `_PLACES`.
        count: how many; None for all to the end.
    """
    size = path.stat().st_size - begin if count is None else count * dtype.itemsize
    if size == 0:
        return np.empty(0, dtype)
    with path.open("rb") as file:
        return np.frombuffer(_Mapping(file.fileno(), size, access=mmap.ACCESS_READ, offset=begin), dtype)


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
    """Files of raw numbers.

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

    def put(self, name: str, arrays: Iterable[tuple[int, NDArray[Any]]]) -> None:
        """Write `(n,)` arrays into a file, each from a byte on; what lies between them is not defined.

        Raises:
            SimulationError: the disk is full, or the folder cannot be written to.
        """
        with _naming_folder(self.path):
            path = self.path / name
            path.touch()
            with path.open("r+b") as file:
                for begin, array in arrays:
                    file.seek(begin)
                    file.write(array.data)

    def array(self, name: str, dtype: np.dtype[Any], begin: int = 0, count: int | None = None) -> NDArray[Any]:
        """Return numbers of a file, `(n,)`, read-only; see `release`, and `mapped`.

        Raises:
            SimulationError: the file cannot be read.
        """
        with _naming_folder(self.path):
            return mapped(self.path / name, dtype, begin, count)

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

_PLACES: Final = mmap.ALLOCATIONGRANULARITY
"""Bytes of which the beginning of a mapping is a multiple."""

_SHORT: Final = 1 << 23
"""Bytes of a column from which on it has a file of its own."""

_MORE: Final = 16
"""The same, as a multiple of what it has when it is first written: of a column that may be longer, but will not, much
of the place would stay empty, which not every system leaves out of a file.
"""

_SHARED: Final = "columns"

_RESERVED: Final = 1.5
"""Memory reserved for columns that are to be written, as a multiple of what is gathered before that."""

Array = NDArray[Any]

_LARGE: Final = 1 << 22
"""Bytes of an array from which on NumPy asks the system for large pages."""


@dataclass(slots=True)
class _Place:
    """Where a column lies.

    Attributes:
        file: its name.
        dtype: of its numbers.
        begin: the byte of its first number.
        most: numbers that it may have there; None for any.
        rows: numbers that are there.
    """

    file: str
    dtype: np.dtype[Any]
    begin: int = 0
    most: int | None = None
    rows: int = 0


class Columns(Mapping[str, Array]):
    """Columns in files, by name. Each is mapped anew whenever it is asked for, so that none stays in memory."""

    def __init__(self, folder: Folder, places: Mapping[str, _Place]) -> None:
        self._folder, self._places = folder, places

    def __getitem__(self, name: str) -> Array:
        place = self._places[name]
        if not place.rows:
            return np.empty(0, place.dtype)
        return self._folder.array(place.file, place.dtype, place.begin, place.rows)

    def __contains__(self, name: object) -> bool:
        return name in self._places  # a mapping would map the column to find that out

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)


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
        in_memory: bytes of all columns together that stay in memory; None for `IN_MEMORY`.
    """

    def __init__(
        self,
        types: Mapping[Hashable, np.dtype[Any]],
        expected: Mapping[Hashable, int] | None = None,
        *,
        in_memory: int | None = None,
    ) -> None:
        self._in_memory = IN_MEMORY if in_memory is None else in_memory
        self._types = dict(types)
        self._files = {key: f"{number}.column" for number, key in enumerate(types)}
        self._places = {key: _Place(self._files[key], dtype) for key, dtype in types.items()}
        self._expected: dict[Hashable, int] = {}
        self.expect(expected or {})
        self._arrays = {key: np.empty(0, dtype) for key, dtype in types.items()}
        self._sizes = dict.fromkeys(types, 0)
        self._bytes = 0
        self._folder: Folder | None = None
        remove_abandoned_folders()

    def expect(self, rows: Mapping[Hashable, int]) -> None:
        """Take it that columns will have about so many numbers: what they are made for, as long as they have none."""
        self._expected |= rows
        self._together = sum(self._types[key].itemsize * rows for key, rows in self._expected.items())

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
        if not array_now.size and self._folder is None and (self._stays or size * array_now.itemsize < _LARGE):
            self._grow_together(key, size)
            return
        array = np.empty(size, array_now.dtype)
        array[: self._sizes[key]] = self._added(key)
        self._arrays[key] = array

    def _grow_together(self, key: Hashable, size: int) -> None:
        """Make arrays for so many numbers, in one piece of memory: for a column, and for those that will be as long.

        The pages at the ends of a piece are small ones, which take ten times as long. But where columns are written
        before they are full, large pages between them would take memory for nothing.
        """
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
        expected = self._expected.get(key, 0)
        return expected if self._stays else int(expected * _RESERVED * self._most / self._together)

    @property
    def _stays(self) -> bool:
        """Whether all columns are expected to stay in memory."""
        return self._together <= _RESERVED * self._most

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
        if before is None:
            self._share()
        waiting = [key for key, size in self._sizes.items() if size]
        for key in waiting:
            self._leave_if_full(key, self._folder)
        shared = [key for key in waiting if self._places[key].file == _SHARED]
        if shared:
            self._folder.put(_SHARED, map(self._placed, shared))
        for key in waiting:
            place, added = self._places[key], self._added(key)
            if place.file != _SHARED:
                checkpoint()
                self._folder.append(place.file, [added])
            place.rows += added.size
            self._sizes[key] = 0
        if before is None:  # these may be somebody's columns
            self._arrays = {key: np.empty(0, dtype) for key, dtype in self._types.items()}
        self._bytes = 0

    def _share(self) -> None:
        """Give those columns that will be short places in one file."""
        end = 0
        for key, size in self._sizes.items():
            most, place = self._expected.get(key, 0), self._places[key]
            if most * place.dtype.itemsize <= _SHORT and size <= most <= _MORE * size:
                place.file, place.begin, place.most = _SHARED, end, most
                end += -(-most * place.dtype.itemsize // _PLACES) * _PLACES

    def _placed(self, key: Hashable) -> tuple[int, Array]:
        """Return what waits of a column, after the byte of the shared file where it belongs."""
        checkpoint()
        place = self._places[key]
        return place.begin + place.rows * place.dtype.itemsize, self._added(key)

    def _leave_if_full(self, key: Hashable, folder: Folder) -> None:
        """Move a column that gets longer than was expected into a file of its own."""
        place = self._places[key]
        if place.most is None or place.rows + self._sizes[key] <= place.most:
            return
        if place.rows:
            folder.append(self._files[key], [folder.array(place.file, place.dtype, place.begin, place.rows)])
        self._places[key] = _Place(self._files[key], place.dtype, rows=place.rows)

    def columns(self, keys: Mapping[str, Hashable], rows: int | None = None) -> Mapping[str, Array]:
        """Return the columns so far, each under a name of its own, or their first `rows`; in memory if none was written
        yet.

        Raises:
            SimulationError: there is no space on the disk.
        """
        if self._folder is None:
            return {name: self._compact(key)[:rows] for name, key in keys.items()}
        self._write()
        result = {name: replace(self._places[key]) for name, key in keys.items()}
        for place in result.values():
            place.rows = place.rows if rows is None else min(place.rows, rows)
        return Columns(self._folder, result)

    def _compact(self, key: Hashable) -> Array:
        """Copy a column into no more than twice the memory that it needs."""
        if 2 * self._sizes[key] < self._arrays[key].size:
            self._arrays[key] = self._added(key).copy()
        return self._added(key)
