"""Functions that tell what kind of value a cell holds."""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.excel.functions.registry import Anything, Cells, Kind, excel
from xlmc.excel.functions.values import BLANK, ERROR, LOGICAL, NA, NUMBER, TEXT, Floats, Value

__all__: list[str] = []

_ARRAY: Final = 64.0
_TYPES: Final = {NUMBER: 1.0, BLANK: 1.0, TEXT: 2.0, LOGICAL: 4.0}
_ERROR_TYPE: Final = 16.0


@excel("NA")
def not_available() -> Floats:
    """Return the error `#N/A`."""
    return np.full(1, NA)


@excel("ERROR.TYPE", Anything)
def error_type(value: Value) -> Value:
    """Return the number of an error: 1 `#NULL!`, 2 `#DIV/0!`, … 7 `#N/A`; `#N/A` for any other value."""
    return Value.of_numbers(np.where(value.errors > 0, value.errors.astype(np.float64), NA))


@excel("N", Anything, returns=Kind.ANY)
def number(value: Value) -> Value:
    """Return a number as it is, TRUE as 1, anything else as 0; errors stay."""
    counts = (value.kinds == NUMBER) | (value.kinds == LOGICAL)
    return Value.of_numbers(np.where(counts, value.numbers, 0.0), value.errors)


@excel("T", Anything, returns=Kind.ANY)
def text(value: Value) -> Value:
    """Return a text as it is, an empty one for anything else; errors stay."""
    texts = np.full(value.shape, "", object)
    if value.texts is not None:
        texts = np.where(value.kinds == TEXT, value.texts, "")
    return Value.of_texts(np.asarray(texts, object), value.errors)


@excel("TYPE", Cells)
def type_(value: Value) -> Floats:
    """1 for a number or blank, 2 for a text, 4 for a logical, 16 for an error, 64 for several values."""
    if value.numbers.ndim == 3 and value.shape[1:] != (1, 1):
        return np.full(1, _ARRAY)
    kinds = np.broadcast_to(value.kinds, value.shape).reshape(value.shape[0])
    codes = np.array([_TYPES.get(kind, _ERROR_TYPE) for kind in range(ERROR)])
    return np.where(kinds >= ERROR, _ERROR_TYPE, codes[np.where(kinds >= ERROR, 0, kinds)])
