"""A temporary folder of column files, which goes when nothing needs it any more."""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
import weakref
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.columns.mapped import mapped
from xlmc.columns.owners import new_folder_name, owned
from xlmc.errors import SimulationError

__all__ = ["Folder"]

_FULL = (errno.ENOSPC, errno.EDQUOT)
_HINT = "Set TMPDIR to a folder on a disk with more room, or ask for fewer trials"
_TOO_MANY = (errno.EMFILE, errno.ENFILE)


class Folder:
    """Files of raw numbers, each written front to back.

    It is removed with this object, or at the interpreter's end. An array that is still mapped keeps its numbers.

    Raises:
        SimulationError: there is no folder to write to.
    """

    def __init__(self) -> None:
        with _told(None):
            self.path = Path(tempfile.gettempdir(), new_folder_name())
            kept = ExitStack()
            kept.enter_context(owned(self.path.name))
            self.path.mkdir(mode=0o700)
        self._end = weakref.finalize(self, _remove, self.path, os.getpid(), kept)

    def append(self, name: str, arrays: Iterable[NDArray[Any]]) -> None:
        """Write `(n,)` arrays at the end of a file.

        Raises:
            SimulationError: the disk is full, or the folder cannot be written to.
        """
        with _told(self.path), (self.path / name).open("ab") as file:
            for array in arrays:
                file.write(array.data)

    def array(self, name: str, dtype: np.dtype[Any]) -> NDArray[Any]:
        """The numbers of a file, `(n,)`, read-only; see `release`.

        Raises:
            SimulationError: the file cannot be read.
        """
        with _told(self.path):
            return mapped(self.path / name, dtype)

    def remove(self, name: str) -> None:
        """Delete a file, if it is there; where an open file cannot be deleted, it goes with the folder."""
        with _told(self.path):
            try:
                (self.path / name).unlink(missing_ok=True)
            except PermissionError:  # Windows, while an array is mapped
                return


def _remove(path: Path, owner: int, kept: ExitStack) -> None:
    if os.getpid() == owner:  # a forked child inherits the object, not the folder
        shutil.rmtree(path, ignore_errors=True)
        kept.close()


@contextmanager
def _told(path: Path | None) -> Iterator[None]:
    """Failures of the disk in words."""
    try:
        yield
    except OSError as error:
        where, hint = path or "temporary folder", _HINT
        message = f"the accepted trials cannot be kept there: {error.strerror or error}"
        if error.errno in _FULL:
            message = "there is no room left on the disk for the accepted trials"
        elif error.errno in _TOO_MANY:
            hint = "Allow more open files: ulimit -n 8192"
        raise SimulationError(message, where=where, hint=hint) from error
