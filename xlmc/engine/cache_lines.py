"""Arrays and the lines of the processor's caches."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["CACHE_LINE", "aligned_array"]

CACHE_LINE: Final = 64
"""Bytes of a line."""


def aligned_array(size: int, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Make an array of one dimension that begins with a line of the cache."""
    raw = np.empty(size * dtype.itemsize + CACHE_LINE, np.uint8)
    start = -raw.ctypes.data % CACHE_LINE
    return raw[start : start + size * dtype.itemsize].view(dtype)
