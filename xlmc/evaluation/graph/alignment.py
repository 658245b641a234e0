"""Arrays side by side whose sizes are known only when they are computed: as in Excel, what one lacks is #N/A."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.functions.registry import Function
from xlmc.functions.values import ERROR, Value, constant

__all__ = ["aligned", "arguments_of", "corner", "single"]

_NA = np.uint8(ERROR + ErrorCode.NA)
_NESTED = constant(ErrorCode.CALC)


def arguments_of(function: Function, values: Sequence[Value]) -> list[Value]:
    """The arguments, those that are taken element by element of one size; ranges that are taken whole as they are."""
    loose = [i for i in range(len(values)) if not function.parameter(i).ranged]
    if sum(values[i].numbers.ndim == 3 for i in loose) < 2:
        return list(values)
    given = list(values)
    for i, value in zip(loose, aligned([values[i] for i in loose]), strict=True):
        given[i] = value
    return given


def aligned(values: Sequence[Value]) -> list[Value]:
    """Arrays (n, r, c) of one size (r, c), or of one row, one column or one cell, which broadcast to it.

    Single values (n,) stay as they are. Where no array is larger than another, none is changed.
    """
    sizes = {value.shape[1:] for value in values if value.numbers.ndim == 3}
    rows, columns = ({size[axis] for size in sizes} - {1} for axis in (0, 1))
    if len(rows) < 2 and len(columns) < 2:
        return list(values)
    to = max(rows, default=1), max(columns, default=1)
    return [_padded(value, *to) if value.numbers.ndim == 3 else value for value in values]


def _padded(value: Value, rows: int, columns: int) -> Value:
    """The array with #N/A below and to the right; one row or column goes on as it is, being repeated."""
    shape = value.shape
    lacks = [(0, 0), *((0, 0 if has == 1 else to - has) for has, to in zip(shape[1:], (rows, columns), strict=True))]
    if not any(more for _, more in lacks):
        return value
    filled: list[tuple[Any, Any]] = [(value.numbers, 0.0), (value.kinds, _NA), (value.texts, "")]
    parts: list[Any] = [
        None if part is None else np.pad(np.broadcast_to(part, shape), lacks, constant_values=by) for part, by in filled
    ]
    return Value(parts[0], parts[1], parts[2])


def single(value: Value) -> Value:
    """What stands in one cell of an array: a value; an array of its own there is #CALC!, unless it is of one cell."""
    if value.numbers.ndim == 1:
        return value
    return corner(value) if value.shape[1:] == (1, 1) else _NESTED


def corner(value: Value) -> Value:
    """What a cell shows of an array that it does not spill: its upper left value; #CALC! of an array of nothing."""
    if value.numbers.ndim == 1:
        return value
    if 0 in value.shape[1:]:
        return _NESTED
    shape = value.shape
    parts: list[Any] = [None if part is None else np.broadcast_to(part, shape)[:, 0, 0] for part in value.arrays()]
    return Value(parts[0], parts[1], parts[2])
