"""Put a package into a file: the same parts always give the same bytes; a failed write leaves the old file alone."""

from __future__ import annotations

import errno
import io
import os
import secrets
import shutil
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from xlmc.errors import WorkbookError

__all__ = ["check_folder", "package_bytes", "refuse_if_open", "whole_file", "write_workbook"]

_EPOCH = (1980, 1, 1, 0, 0, 0)  # the earliest time a zip can hold
_FIRST = ("[Content_Types].xml", "_rels/.rels")  # where programs that read a package as it arrives look first
_FULL = (errno.ENOSPC, errno.EDQUOT)
_REFUSED = (errno.EACCES, errno.EPERM, errno.EROFS)


def package_bytes(parts: Mapping[str, bytes]) -> bytes:
    """The zip package that holds the parts, content types first, then in their order; no clock and no machine in it."""
    packed = io.BytesIO()
    names = [*(name for name in _FIRST if name in parts), *(name for name in parts if name not in _FIRST)]
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as package:
        for name in names:
            package.writestr(_entry(name), parts[name])
    return packed.getvalue()


def write_workbook(path: str | os.PathLike[str], data: bytes) -> None:
    """Write the file whole or not at all: beside its place first, onto the disk, then renamed into place.

    An existing file keeps its permissions; a link keeps pointing at the file it names.

    Raises:
        WorkbookError: the folder is missing, the file may not be written or is in use, or the disk is full.
    """
    with _written_whole(path) as temporary:
        _write_synced(temporary, data)


@contextmanager
def whole_file(path: str | os.PathLike[str]) -> Iterator[BinaryIO]:
    """A file to write piece by piece, which takes its place when all is written, and not at all after an exception.

    An existing file keeps its permissions; a link keeps pointing at the file it names.

    Raises:
        WorkbookError: as for `write_workbook`.
    """
    with _written_whole(path) as temporary, temporary.open("w+b") as file:
        yield file
        file.flush()
        os.fsync(file.fileno())


@contextmanager
def _written_whole(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A file beside the target, to be written and synced; then it is renamed."""
    target = Path(os.path.realpath(path))
    try:
        _refuse_protected(target)
        with _new_file_beside(target) as temporary:
            yield temporary
            if target.exists():
                shutil.copymode(target, temporary)
            os.replace(temporary, target)
        _sync_folder(target.parent)
    except OSError as error:
        raise _told(error, path) from error


def check_folder(path: str | os.PathLike[str]) -> None:
    """Refuse, before any work, a file that has no folder to go to, is a folder, or may not be written.

    Raises:
        WorkbookError: so it is.
    """
    target = Path(os.path.realpath(path))
    if target.is_dir():
        raise _told(IsADirectoryError(errno.EISDIR, "is a folder"), path)
    if not target.parent.is_dir():
        raise _told(FileNotFoundError(errno.ENOENT, "no folder"), path)
    if not os.access(target if target.exists() else target.parent, os.W_OK):
        raise _told(PermissionError(errno.EACCES, "read-only"), path)


def refuse_if_open(path: str | os.PathLike[str]) -> None:
    """Refuse a workbook that Excel or LibreOffice holds open, as the owner file each keeps beside it shows.

    Raises:
        WorkbookError: such a file is there.
    """
    target = Path(os.path.realpath(path))
    for program, owner in (("Excel", f"~${target.name}"), ("LibreOffice", f".~lock.{target.name}#")):
        if target.with_name(owner).exists():
            raise WorkbookError(
                f"{program} holds the workbook open",
                where=path,
                hint=f"Close it there first (if it is not open, a crash left {owner!r} behind: delete that file)",
            )


def _entry(name: str) -> zipfile.ZipInfo:
    entry = zipfile.ZipInfo(name, _EPOCH)
    entry.compress_type = zipfile.ZIP_DEFLATED
    entry.create_system = 0  # otherwise the file would say on which system it was written
    return entry


def _refuse_protected(target: Path) -> None:
    # Renaming over a read-only file works on most systems; the person who protected it would not want it.
    if target.exists() and not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, "read-only", str(target))


@contextmanager
def _new_file_beside(target: Path) -> Iterator[Path]:
    """An empty file in the target's folder, removed again unless it was renamed."""
    path = target.with_name(f".xlmc-{secrets.token_hex(8)}.tmp")
    path.touch(exist_ok=False)
    try:
        yield path
    finally:
        path.unlink(missing_ok=True)


def _write_synced(path: Path, data: bytes) -> None:
    with path.open("wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())


def _sync_folder(folder: Path) -> None:
    if os.name != "posix":
        return  # elsewhere a folder cannot be opened, and the rename is on the disk when it returns
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _told(error: OSError, path: str | os.PathLike[str]) -> WorkbookError:
    if isinstance(error, FileNotFoundError | NotADirectoryError):
        folder = str(Path(path).absolute().parent)
        return WorkbookError(f"there is no folder {folder!r}", where=path, hint="Create it or name another")
    if Path(path).is_dir():
        return WorkbookError("this is a folder, not a file", where=path, hint="Name a file")
    if error.errno in _FULL:
        return WorkbookError("the disk is full", where=path, hint="Free some space or name another folder")
    if error.errno in _REFUSED:
        hint = "Close it if a program has it open, see to its permissions, or name another file"
        return WorkbookError("the file is in use or may not be written", where=path, hint=hint)
    return WorkbookError(f"the file cannot be written ({error.strerror})", where=path)
