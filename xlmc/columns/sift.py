"""A column without its gaps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from xlmc.columns.folder import Folder
from xlmc.columns.mapped import on_disk
from xlmc.columns.passes import parts

__all__ = ["numbers"]

Floats = NDArray[np.float64]


def numbers(values: Floats) -> Floats:
    """`(n,)` values without NaN, in their order: the column itself where it has none; on disk where it was on disk."""
    if not any(np.isnan(part).any() for part in parts(values)):
        return values
    if not on_disk(values):
        return values[~np.isnan(values)]
    folder = Folder()
    for part in parts(values):
        folder.append("numbers", [part[~np.isnan(part)]])
    return folder.array("numbers", values.dtype)
