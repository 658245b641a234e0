"""Arrays that a function works in, kept by each thread from call to call: pages of fresh memory cost much time."""

from __future__ import annotations

import threading
from typing import Final

import numpy as np

from xlmc.functions.values import Floats

__all__ = ["work_arrays"]

_KEPT: Final = 2

_MEMORY = threading.local()


def work_arrays(n: int, arrays: int) -> list[Floats]:
    """One or two arrays `(n,)` of this thread's own, until it asks again."""
    kept: list[Floats] = getattr(_MEMORY, "arrays", [])
    if len(kept) < arrays or kept[0].size < n:
        _MEMORY.arrays = kept = [np.empty(n) for _ in range(_KEPT)]
    return [array[:n] for array in kept[:arrays]]
