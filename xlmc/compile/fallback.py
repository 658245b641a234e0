"""Functions that xlmc has no body for and `formulas` has: computed by it, trial by trial."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, partial
from typing import Any, Final

import numpy as np

from xlmc.address import column_letters
from xlmc.formula import compile_with_formulas, foreign_functions
from xlmc.functions import Function, Kind
from xlmc.functions.registry import Cells
from xlmc.functions.values import Value, from_objects

__all__ = ["fallback"]

_UNFIT: Final = {
    "ARRAY",
    "ARRAYROW",
    "DUMMYFUNCTION",
    "SINGLE",
    "RAND",
    "RANDBETWEEN",
    "GROUPBY",
    "PIVOTBY",
    "TRIMRANGE",
}
"""Its own devices, random numbers that no seed reaches, and functions that give arrays."""


@cache
def fallback(name: str) -> Function | None:
    """The function of `formulas` by that name, as one of ours; None where there is none."""
    if name in _UNFIT or name not in foreign_functions():
        return None
    return Function(name, (Cells(repeat=True),), partial(_body, name), Kind.ANY)


def _body(name: str, *arguments: Value) -> Value:
    addresses, left = [], 1
    for argument in arguments:
        rows, columns = argument.shape[1:] or (1, 1)
        last = f":{column_letters(left + columns - 1)}{rows}" if rows * columns > 1 else ""
        addresses.append(f"{column_letters(left)}1{last}")
        left += columns
    call = compile_with_formulas(f"{name}({','.join(addresses)})")
    objects = [argument.objects() for argument in arguments]
    out = np.empty(max((o.shape[0] for o in objects), default=1), object)
    for i in range(out.size):
        out[i] = call(_trial(dict(zip(addresses, objects, strict=True)), i))
    return from_objects(out)


def _trial(objects: Mapping[str, Any], i: int) -> dict[str, Any]:
    """The arguments of one trial by address, single cells as they are and ranges (r, c)."""
    picked = {address: found[i if found.shape[0] > 1 else 0] for address, found in objects.items()}
    return {address: item.item() if np.size(item) == 1 and np.ndim(item) else item for address, item in picked.items()}
