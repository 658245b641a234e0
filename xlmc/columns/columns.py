"""Columns that grow block by block: in memory while they are small together, else in files."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.columns.folder import Folder
from xlmc.columns.owners import remove_stray_folders

__all__ = ["IN_MEMORY", "Columns", "Keeper"]

IN_MEMORY: Final = 1 << 27
"""Bytes of all columns of a keeper together that stay in memory."""

WRITTEN: Final = 1 << 24
"""Bytes that are gathered before they are written: large writes cost least."""

Array = NDArray[Any]


class Columns(Mapping[str, Array]):
    """Columns in files, by name. Each is mapped anew whenever it is asked for, so that none stays in memory."""

    def __init__(self, folder: Folder, files: Mapping[str, tuple[str, np.dtype[Any]]]) -> None:
        self._folder, self._files = folder, files

    def __getitem__(self, name: str) -> Array:
        file, dtype = self._files[name]
        return self._folder.array(file, dtype)

    def __iter__(self) -> Iterator[str]:
        return iter(self._files)

    def __len__(self) -> int:
        return len(self._files)


class Keeper:
    """Collects columns; the arrays it is given are its own from then on. Folders that killed runs left are removed.

    Args:
        types: column -> the type of its numbers.
    """

    def __init__(self, types: Mapping[Hashable, np.dtype[Any]]) -> None:
        self._types = dict(types)
        self._files = {key: f"{number}.column" for number, key in enumerate(types)}
        self._waiting: dict[Hashable, list[Array]] = {key: [] for key in types}
        self._bytes = 0
        self._folder: Folder | None = None
        remove_stray_folders()

    def add(self, key: Hashable, values: Array) -> None:
        """Put `(m,)` values at the end of a column."""
        if values.size:
            self._waiting[key].append(values)
            self._bytes += values.nbytes

    def settle(self) -> None:
        """Write what waits, if it is much; to be called when all columns of a block are added.

        Raises:
            SimulationError: there is no room on the disk.
        """
        if self._bytes > (IN_MEMORY if self._folder is None else WRITTEN):
            self._write()

    def _write(self) -> None:
        self._folder = self._folder or Folder()
        for key, waiting in self._waiting.items():
            self._folder.append(self._files[key], waiting)
            waiting.clear()
        self._bytes = 0

    def columns(self, keys: Mapping[str, Hashable]) -> Mapping[str, Array]:
        """Finished columns, each under a name of its own; in memory if nothing was written yet.

        Raises:
            SimulationError: there is no room on the disk.
        """
        if self._folder is None:
            return {name: self._joined(key) for name, key in keys.items()}
        self._write()
        return Columns(self._folder, {name: (self._files[key], self._types[key]) for name, key in keys.items()})

    def _joined(self, key: Hashable) -> Array:
        if len(self._waiting[key]) != 1:
            self._waiting[key] = [np.concatenate([np.empty(0, self._types[key]), *self._waiting[key]])]
        return self._waiting[key][0]
