"""Native code that is kept from one program to the next, so that a workbook that was run before starts at once.

It lies in a folder of the user's own, never beside a workbook: `~/.cache/xlmc/code`, on macOS in `~/Library/Caches`, on
Windows in `%LOCALAPPDATA%`. Nothing is read from a folder or a file that another user could have written, nor where the
contents have another SHA-256 than stands before them: the code is then compiled again, as where nothing can be written.
A file is written under another name and then renamed, so that several programs may write at once. Where the folder has
become too large, the files go that were not read for the longest time.

With `XLMC_KEEP_CODE=0` in the environment nothing is read and nothing is written.
"""

from __future__ import annotations

import hashlib
import os
import secrets
import stat
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Final

__all__ = ["SWITCH", "code_key", "load_code", "save_code"]

SWITCH: Final = "XLMC_KEEP_CODE"

_MOST_BYTES: Final = 1 << 26
"""Bytes of all files together; those of a workbook of a thousand different formulas are some two million."""

_MARK: Final = b"xlmc code 1\n"
_DIGEST: Final = 32
_SUFFIX: Final = ".code"
_UNFINISHED: Final = ".tmp"
_HOUR: Final = 3600.0
"""Seconds after which a file that was not renamed never will be: it is written in no time."""

_READING: Final = os.O_RDONLY | getattr(os, "O_BINARY", 0) | getattr(os, "O_NOFOLLOW", 0)
"""Windows has the first of the two flags, the others have the second."""

_OF_OTHERS: Final = 0o077
_WRITABLE_BY_OTHERS: Final = 0o022


def code_key(*about: str) -> str:
    """Name the code that is made of these texts."""
    digest = hashlib.sha256()
    for text in about:
        encoded = text.encode()
        digest.update(len(encoded).to_bytes(8, "little") + encoded)
    return digest.hexdigest()


def load_code(key: str) -> bytes | None:
    """Return the code that was saved under a key; None if there is none, or it cannot be trusted."""
    folder = _folder()
    if folder is None:
        return None
    path = folder / f"{key}{_SUFFIX}"
    try:
        with os.fdopen(os.open(path, _READING), "rb") as file:
            if not _is_own(os.fstat(file.fileno()), stat.S_ISREG, _WRITABLE_BY_OTHERS):
                return None
            content = file.read()
        os.utime(path)
    except OSError:  # there is none, or it went meanwhile
        return None
    before, code = content[: len(_MARK) + _DIGEST], content[len(_MARK) + _DIGEST :]
    return code if before == _header(key, code) else None


def save_code(key: str, code: bytes) -> None:
    """Save code under a key, if there is a folder to save it in."""
    folder = _folder()
    if folder is None:
        return
    unfinished = folder / f"{secrets.token_hex(16)}{_UNFINISHED}"
    try:
        with unfinished.open("xb") as file:
            file.write(_header(key, code) + code)
        unfinished.replace(folder / f"{key}{_SUFFIX}")
    except OSError:  # the disk is full, say: the code will be compiled again
        with suppress(OSError):
            unfinished.unlink()
    _remove_oldest(folder)


def _header(key: str, code: bytes) -> bytes:
    return _MARK + hashlib.sha256(key.encode() + code).digest()


def _folder() -> Path | None:
    """Return the folder, made if need be; None if the user has none of their own, or wants none."""
    if os.environ.get(SWITCH) == "0":
        return None
    try:
        folder = _caches() / "xlmc" / "code"
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        return folder if _is_own(folder.lstat(), stat.S_ISDIR, _OF_OTHERS) else None
    except (OSError, RuntimeError):  # it cannot be made, or there is no home
        return None


def _caches() -> Path:
    """Return the folder in which programs keep files that they can make again."""
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    given = os.environ.get("XDG_CACHE_HOME", "")
    return Path(given) if os.path.isabs(given) else Path.home() / ".cache"


def _is_own(status: os.stat_result, is_kind: Callable[[int], bool], others: int) -> bool:
    """Whether it is of that kind, this user's, and closed to others; Windows keeps others out by other means."""
    if not is_kind(status.st_mode):
        return False
    return sys.platform == "win32" or (status.st_uid == os.getuid() and not stat.S_IMODE(status.st_mode) & others)


def _remove_oldest(folder: Path) -> None:
    """Remove what was not read for the longest time, where there is too much, and what was left half-way."""
    now, files = time.time(), []
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            with suppress(OSError):  # another program removed it
                status = entry.stat(follow_symlinks=False)
                if entry.name.endswith(_SUFFIX):
                    files.append((status.st_mtime, status.st_size, entry.path))
                elif entry.name.endswith(_UNFINISHED) and now - status.st_mtime > _HOUR:
                    os.unlink(entry.path)
    size = sum(size for _, size, _ in files)
    for _, each, path in sorted(files):
        if size <= _MOST_BYTES:
            break
        with suppress(OSError):
            os.unlink(path)
        size -= each
