"""Put a package into a file: the same parts always give the same bytes; a failed write leaves the old file alone.

Windows opens paths of 260 characters and more only by their extended form (`openable`).
"""

from __future__ import annotations

import errno
import io
import ntpath
import os
import shutil
import stat
import time
import zipfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.temporary_names import new_file_name, owned, remove_abandoned_files

__all__ = [
    "QUICK",
    "SMALL",
    "TakenError",
    "check_folder",
    "extended",
    "openable",
    "package_bytes",
    "refuse_if_open",
    "whole_file",
    "write_workbook",
]

SMALL, QUICK = 6, 4
"""Levels of deflate: results, which are written at each run, are packed in .6 of the time, to 6 % more bytes."""

_EPOCH = (1980, 1, 1, 0, 0, 0)  # the earliest time a zip can hold
_FIRST = ("[Content_Types].xml", "_rels/.rels")  # where programs that read a package as it arrives look first
_FULL = (errno.ENOSPC, errno.EDQUOT)
_LIMITED = (errno.EFBIG,)
_REFUSED = (errno.EACCES, errno.EPERM, errno.EROFS)
_WRITABLE = stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH
_IN_USE = frozenset({5, 32, 33, 1224, *range(358, 405), 426})
"""What Windows says of a file that another program holds (access denied, sharing or lock violation, a mapped file) or
that OneDrive is at work on (cloud file errors)."""
_PAUSES = (0.05, 0.1, 0.2, 0.4, 0.8, 1.5)
"""Seconds between attempts to rename over a file that is held."""
_ATTEMPTS = 5
_CLOSE = "Close it in Excel (or wait until OneDrive has finished), or name another file"


class TakenError(WorkbookError):
    """The name is taken: by a file that is not to be replaced, or that another program holds. Another name is free."""


def package_bytes(parts: Mapping[str, bytes], level: int = SMALL) -> bytes:
    """Pack the parts into a zip, content types first, then in their order; no clock and no machine in it.

    Args:
        parts: of the package.
        level: `SMALL` or `QUICK`.
    """
    packed = io.BytesIO()
    names = [*(name for name in _FIRST if name in parts), *(name for name in parts if name not in _FIRST)]
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as package:
        for name in names:
            package.writestr(_entry(name), parts[name], compresslevel=level)
    return packed.getvalue()


def write_workbook(path: str | os.PathLike[str], data: bytes, check: Callable[[], None] | None = None) -> None:
    """Write the file whole or not at all: first beside it, onto the disk, then renamed.

    An existing file keeps its permissions; a link keeps pointing at the file it names.

    Args:
        path: where to.
        data: all of it.
        check: refuses, by an exception, what must not be replaced; asked last of all before it is.

    Raises:
        TakenError: another program holds the file, or it is something else than a file.
        WorkbookError: the folder is missing, the file may not be written, or the disk is full.
    """
    with _write_whole(path, check) as temporary:
        _write_synced(temporary, data)


@contextmanager
def whole_file(path: str | os.PathLike[str], check: Callable[[], None] | None = None) -> Iterator[BinaryIO]:
    """Open a file to write piece by piece, which gets its name when all is written, and not at all after an exception.

    An existing file keeps its permissions; a link keeps pointing at the file it names.

    Raises:
        WorkbookError: as for `write_workbook`.
    """
    with _write_whole(path, check) as temporary, temporary.open("w+b") as file:
        yield file
        file.flush()
        os.fsync(file.fileno())


@contextmanager
def _write_whole(path: str | os.PathLike[str], check: Callable[[], None] | None) -> Iterator[Path]:
    """Open a file beside the target, to be written and synced; then it is renamed."""
    with _naming_file(path):
        target = _meant(path)
        _refuse_protected(target)
        remove_abandoned_files(target.parent)
        with _new_file_beside(target) as temporary:
            yield temporary
            _publish(temporary, target, check)
        _sync_folder(target.parent)


def check_folder(path: str | os.PathLike[str]) -> None:
    """Refuse, before any work, a file that has no folder to go to, is none, or may not be written.

    Raises:
        TakenError: it is a folder, a device, a link to nothing, or read-only.
        WorkbookError: there is no folder, or the folder may not be written to.
    """
    with _naming_file(path):
        target = _meant(path)
        _refuse_protected(target)
        if not target.parent.is_dir():
            raise FileNotFoundError(errno.ENOENT, "no folder")
        if not os.access(target.parent, os.W_OK):
            hint = "Name a file in another folder, or allow writing to this one"
            raise WorkbookError(f"the folder {str(target.parent)!r} may not be written to", where=path, hint=hint)


def refuse_if_open(path: str | os.PathLike[str]) -> None:
    """Refuse a workbook that Excel or LibreOffice holds open, as the owner file each keeps beside it shows.

    Raises:
        WorkbookError: such a file is there.
    """
    target = _meant(path)
    for program, owner in (("Excel", f"~${target.name}"), ("LibreOffice", f".~lock.{target.name}#")):
        if os.path.exists(target.with_name(owner)):
            raise TakenError(
                f"{program} holds the workbook open",
                where=path,
                hint=f"Close it there first (if it is not open, a crash left {owner!r} behind: delete that file)",
            )


def _entry(name: str) -> zipfile.ZipInfo:
    entry = zipfile.ZipInfo(name, _EPOCH)
    entry.compress_type = zipfile.ZIP_DEFLATED
    entry.create_system = 0  # otherwise the file would say on which system it was written
    return entry


def _meant(path: str | os.PathLike[str]) -> Path:
    """Return the file that a path names: what a link points to.

    Only links are followed: on Windows following a whole path turns a drive's letter into the server it stands for.
    What `..` means is left to the system, which says too whether the file is the workbook itself: behind a link to a
    folder it is another folder than the text says, and behind a folder that does not exist it is none.

    Raises:
        TakenError: the link points to nothing.
    """
    given = Path(path).absolute()
    if not given.is_symlink():
        return Path(openable(given))
    target = Path(os.path.realpath(given))
    if not target.exists():
        message = f"this is a link to {str(target)!r}, which is not there"
        raise TakenError(message, hint="Remove the link, or name another file")
    return Path(openable(target))


def _refuse_protected(target: Path) -> None:
    """Refuse what is no file, and a read-only one: renaming over it works on most systems, and nobody would want it.

    Raises:
        TakenError: it is a folder, a device or the like, or is read-only, also for an administrator.
    """
    if not target.exists():
        return
    mode = target.stat().st_mode
    if stat.S_ISDIR(mode):
        raise TakenError("this is a folder, not a file", hint="Name a file")
    if not stat.S_ISREG(mode):
        raise TakenError("this is a device or a pipe, not a file", hint="Name a file")
    if not mode & _WRITABLE or not os.access(target, os.W_OK):
        hint = "Allow writing to it, or name another file"
        raise TakenError("the file is read-only and may not be written", hint=hint)


@contextmanager
def _new_file_beside(target: Path) -> Iterator[Path]:
    """Make an empty file in the target's folder, removed again unless it was renamed."""
    path = target.with_name(new_file_name())
    with owned(path.name):
        try:
            path.touch(exist_ok=False)
            yield path
        finally:
            path.unlink(missing_ok=True)


def _publish(temporary: Path, target: Path, check: Callable[[], None] | None) -> None:
    """Give the finished file its name: instead of the old one, or only while there is still none."""
    for _ in range(_ATTEMPTS):
        replaces = os.path.lexists(target)  # known before it is checked: what appears later was not
        if check is not None:
            check()
        if replaces:
            shutil.copymode(target, temporary)
            _replace(temporary, target)
            return
        try:
            _name_new(temporary, target)
        except FileExistsError:  # it appeared this moment: whose is it?
            continue
        return
    raise TakenError("other programs keep writing this file", hint="Name another file")


def _name_new(temporary: Path, target: Path) -> None:
    """Name the file, unless the name is taken.

    Raises:
        FileExistsError: it is.
    """
    if os.name == "nt":
        _patiently(os.rename, temporary, target)
        return
    try:
        os.link(temporary, target)
    except FileExistsError:
        raise
    except OSError:  # the file system knows no second names
        _replace(temporary, target)


def _replace(temporary: Path, target: Path) -> None:
    try:
        _patiently(os.replace, temporary, target)
    except OSError as error:
        if not _passing(error):
            raise
        raise TakenError("another program holds the file", hint=_CLOSE) from error


def _patiently(rename: Callable[[Path, Path], object], temporary: Path, target: Path) -> None:
    """Rename, and try again where Windows says that a program has the file: virus scanners and OneDrive soon let go."""
    for pause in _PAUSES:
        try:
            rename(temporary, target)
        except FileExistsError:
            raise
        except OSError as error:
            if not _passing(error):
                raise
            time.sleep(pause)
        else:
            return
    rename(temporary, target)


def _passing(error: OSError) -> bool:
    return getattr(error, "winerror", None) in _IN_USE


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


@contextmanager
def _naming_file(path: str | os.PathLike[str]) -> Iterator[None]:
    """Turn errors of the disk into messages that name the path as the person wrote it."""
    try:
        yield
    except TakenError as error:
        raise TakenError(error.message, where=path, hint=error.hint) from error.__cause__
    except OSError as error:
        raise _explain(error, path) from error


def _explain(error: OSError, path: str | os.PathLike[str]) -> WorkbookError:
    if _passing(error):
        return TakenError("another program holds the file", where=path, hint=_CLOSE)
    if isinstance(error, FileNotFoundError | NotADirectoryError):
        try:
            folder = str(Path(path).absolute().parent)
        except FileNotFoundError:
            hint = "Go to another folder, or name the file with its whole path"
            return WorkbookError("the folder in which xlmc was started is not there any more", where=path, hint=hint)
        return WorkbookError(f"there is no folder {folder!r}", where=path, hint="Create it or name another")
    if error.errno in _FULL:
        return WorkbookError("the disk is full", where=path, hint="Free some space or name another folder")
    if error.errno in _LIMITED:
        hint = "Name a folder on another disk, or allow larger files (ulimit -f)"
        return WorkbookError("the file is larger than may be written here", where=path, hint=hint)
    if error.errno in _REFUSED:
        hint = "Close it if a program has it open, see to its permissions, or name another file"
        return WorkbookError("the file is in use or may not be written", where=path, hint=hint)
    return WorkbookError(f"the file cannot be written ({error.strerror})", where=path, hint="Name another file")


_LONGEST = 247
"""Characters of a folder that every Windows creates; files beside it may have a dozen more."""
_TEMPORARY = 48
"""Characters of the name of the temporary file that is written beside it."""


def openable(path: str | os.PathLike[str]) -> str:
    """Return the path; on Windows a long one in its extended form, which must be absolute."""
    return extended(os.fspath(path)) if os.name == "nt" else os.fspath(path)


def extended(path: str) -> str:
    r"""Extend a Windows path to `\\?\C:\…` or `\\?\UNC\server\share\…` where it, or a temporary file beside it, is
    long.

    The extended form takes no `..` and no `/`: the path is made absolute and plain first.
    """
    if path.startswith(("\\\\?\\", "\\\\.\\")):
        return path
    full = ntpath.normpath(path)
    if max(len(full), len(ntpath.dirname(full)) + _TEMPORARY) <= _LONGEST or not ntpath.isabs(full):
        return path
    return rf"\\?\UNC{full[1:]}" if full.startswith("\\\\") else rf"\\?\{full}"
