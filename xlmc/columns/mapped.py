"""A file as a read-only array, and the memory that reading it took given back."""

from __future__ import annotations

import mmap
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["mapped", "on_disk", "release"]


class _Mapping(mmap.mmap):
    """Tells our read-only maps, whose pages can be dropped at any time, from those of others, whose may not."""


def mapped(path: Path, dtype: np.dtype[Any]) -> NDArray[Any]:
    """The `(n,)` numbers of a file, read-only; the file may be deleted meanwhile where the system allows it."""
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
