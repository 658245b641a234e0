"""Paths as Windows opens them: those of 260 characters and more only by their extended form."""

from __future__ import annotations

import ntpath
import os

__all__ = ["extended", "openable"]

_LONGEST = 247
"""Characters of a folder that every Windows creates; files beside it may have a dozen more."""
_TEMPORARY = 48
"""Characters of the name of the temporary file that is written beside it."""


def openable(path: str | os.PathLike[str]) -> str:
    """The path; on Windows a long one in its extended form, which must be absolute."""
    return extended(os.fspath(path)) if os.name == "nt" else os.fspath(path)


def extended(path: str) -> str:
    r"""A Windows path, `\\?\C:\…` or `\\?\UNC\server\share\…` where it, or a temporary file beside it, is long.

    The extended form takes no `..` and no `/`: the path is made absolute and plain first.
    """
    if path.startswith(("\\\\?\\", "\\\\.\\")):
        return path
    full = ntpath.normpath(path)
    if max(len(full), len(ntpath.dirname(full)) + _TEMPORARY) <= _LONGEST or not ntpath.isabs(full):
        return path
    return rf"\\?\UNC{full[1:]}" if full.startswith("\\\\") else rf"\\?\{full}"
