"""Names of temporary files and folders that say which process made them, and the removal of those it left behind."""

from __future__ import annotations

import os
import re
import secrets
import shutil
import sys
import tempfile
import time
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

__all__ = ["new_file_name", "new_folder_name", "owned", "remove_abandoned_files", "remove_abandoned_folders"]

_FILE: Final = re.compile(r"\.xlmc-(?P<machine>[0-9a-f]{8})-(?P<process>\d+)-[0-9a-f]{16}\.tmp")
_FOLDER: Final = re.compile(r"xlmc-(?P<machine>[0-9a-f]{8})-(?P<process>\d+)-[0-9a-f]{16}")
_DAY: Final = 86_400.0
"""Seconds after which a file that nobody writes to is nobody's: a file is written within minutes."""

_OURS: set[str] = set()
"""The names that this process is at work on: an earlier process may have had its number."""


def new_file_name() -> str:
    """Make a name for a file that stands beside its target while it is written."""
    return f".{new_folder_name()}.tmp"


def new_folder_name() -> str:
    """Make a name for a folder of columns."""
    return f"xlmc-{_machine()}-{os.getpid()}-{secrets.token_hex(8)}"


@contextmanager
def owned(name: str) -> Iterator[None]:
    """Keep the file or folder of this name from being removed as an abandoned one of this process."""
    _OURS.add(name)
    try:
        yield
    finally:
        _OURS.discard(name)


def remove_abandoned_files(folder: Path) -> None:
    """Remove temporary files in this folder whose writers have died; what cannot be removed stays."""
    now = time.time()
    for path in _matching(folder, _FILE):
        with suppress(OSError):  # another process removed it, or it belongs to another person
            if _is_abandoned(path.name, _FILE) or now - path.lstat().st_mtime > _DAY:
                path.unlink()


def remove_abandoned_folders() -> None:
    """Remove folders of columns in the temporary folder whose processes have died; what cannot be removed stays."""
    with suppress(OSError):  # there is no temporary folder: whoever needs one gets an error
        for path in _matching(Path(tempfile.gettempdir()), _FOLDER):
            if _is_abandoned(path.name, _FOLDER) and not path.is_symlink():
                shutil.rmtree(path, ignore_errors=True)


def _matching(folder: Path, pattern: re.Pattern[str]) -> list[Path]:
    try:
        names = os.listdir(folder)  # every run looks through the temporary folder: a Path for each entry takes long
    except OSError:  # the folder is missing or may not be listed: nothing to find there
        return []
    return [folder / name for name in names if pattern.fullmatch(name)]


def _is_abandoned(name: str, pattern: re.Pattern[str]) -> bool:
    match = pattern.fullmatch(name)
    if match is None or match["machine"] != _machine():
        return False
    process = int(match["process"])
    return name not in _OURS if process == os.getpid() else not _lives(process)


def _machine() -> str:
    """Eight digits for this machine, or for this container: process numbers mean nothing in another."""
    name = os.uname().nodename if hasattr(os, "uname") else os.environ.get("COMPUTERNAME", "")
    space = ""
    with suppress(OSError):  # only Linux has it
        space = os.readlink("/proc/self/ns/pid")
    return f"{zlib.crc32(f'{name} {space}'.encode()):08x}"


def _lives(process: int) -> bool:
    if sys.platform == "win32":
        return _lives_on_windows(process)
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:  # it is another person's
        return True
    return True


def _lives_on_windows(process: int) -> bool:
    """Whether there is such a process; `os.kill` would end it there."""
    import ctypes

    kernel = ctypes.windll.kernel32  # type: ignore[attr-defined]  # Windows has it
    synchronise, denied, timeout = 0x0010_0000, 5, 0x102
    handle = kernel.OpenProcess(synchronise, False, process)
    if not handle:
        return bool(kernel.GetLastError() == denied)
    try:
        return bool(kernel.WaitForSingleObject(handle, 0) == timeout)
    finally:
        kernel.CloseHandle(handle)
