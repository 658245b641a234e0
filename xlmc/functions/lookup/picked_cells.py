"""Cells taken from ranges and put together; of wide ranges a portion of the trials at a time, to bound memory.

Letters: n trials, (r, c) cells of a range, k cells in a row.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.functions.values import Objects, ShapeVaries, Value

__all__ = [
    "Indices",
    "by_portions",
    "cell_of",
    "each_part",
    "flattened",
    "joined",
    "picked",
    "side_by_side",
    "transposed",
    "width_of",
]

Indices = NDArray[np.intp]


def each_part(value: Value, change: Callable[[NDArray[Any]], NDArray[Any]]) -> Value:
    """Numbers, kinds and texts, each spread to the full shape and changed alike."""
    shape = value.shape
    texts = None if value.texts is None else change(np.broadcast_to(value.texts, shape))
    return Value(change(np.broadcast_to(value.numbers, shape)), change(np.broadcast_to(value.kinds, shape)), texts)


def flattened(part: NDArray[Any], value: Value) -> NDArray[Any]:
    """A part of a value, or what broadcasts to it, with the cells of each trial in a row: (n, k)."""
    return np.broadcast_to(part, value.shape).reshape(value.shape[0], -1)


def transposed(cells: Value) -> Value:
    """Rows as columns: (n, r, c) -> (n, c, r)."""
    return each_part(cells, lambda part: part.swapaxes(1, 2))


def picked(cells: Value, rows: Indices, columns: Indices) -> Value:
    """The cell at a row and a column, counted from 0, of each trial; all must lie inside.

    `rows` and `columns`, (n,) or (n, r, c) each, broadcast to the result's shape.
    """
    dimensions = max(rows.ndim, columns.ndim)
    n = cells.shape[0]
    trials = np.arange(n).reshape(n, *(1,) * (dimensions - 1))
    return each_part(cells, lambda part: part[trials, rows, columns])


def cell_of(values: Value, row: int, column: int) -> Value:
    """One cell of a range: (n, r, c) -> (n,). A single row, column or value stands for all of them."""
    if values.numbers.ndim == 1:
        return values
    row, column = (min(index, size - 1) for index, size in zip((row, column), values.shape[1:], strict=True))
    return each_part(values, lambda part: part[:, row, column])


def side_by_side(cells: Sequence[Value], rows: int, columns: int) -> Value:
    """Values (n,), row by row, as a range (n, r, c)."""
    n = max(cell.shape[0] for cell in cells)
    tall = [each_part(cell, lambda part: np.broadcast_to(part, (n,))[:, None]) for cell in cells]
    return each_part(joined(tall, axis=1), lambda part: part.reshape(n, rows, columns))


def joined(values: Sequence[Value], axis: int) -> Value:
    """Values along an axis; in the others they have one shape."""
    texts = None
    if any(value.texts is not None for value in values):
        texts = np.concatenate([_texts(value) for value in values], axis)
    numbers = [np.broadcast_to(value.numbers, value.shape) for value in values]
    kinds = [np.broadcast_to(value.kinds, value.shape) for value in values]
    return Value(np.concatenate(numbers, axis), np.concatenate(kinds, axis), texts)


def _texts(value: Value) -> Objects:
    absent = np.full(1, "", object) if value.texts is None else value.texts
    return np.broadcast_to(absent, value.shape)


_MOST: Final = 2**21
"""Cells of all trials together that a body spreads out at once."""


def width_of(*values: Value) -> int:
    """How many cells a trial has, in those values that differ between trials."""
    return max((int(np.prod(value.shape[1:])) for value in values if value.shape[0] > 1), default=0)


def by_portions(compute: Callable[..., Value], values: Sequence[Value], width: int) -> Value:
    """`compute(*values)`, where each trial takes memory for `width` cells.

    Raises:
        ShapeVaries: the portions' results differ in shape.
    """
    n = max(value.shape[0] for value in values)
    size = max(1, _MOST // max(1, width))
    if n <= size:
        return compute(*values)
    parts = [slice(start, min(start + size, n)) for start in range(0, n, size)]
    results = [_tall(compute(*(_trials(v, part) for v in values)), part.stop - part.start) for part in parts]
    if len({result.shape[1:] for result in results}) > 1:
        raise ShapeVaries
    return joined(results, axis=0)


def _trials(value: Value, part: slice) -> Value:
    """Some of the trials; a constant stays as it is."""
    texts = None if value.texts is None else _some(value.texts, part)
    return Value(_some(value.numbers, part), _some(value.kinds, part), texts)


def _some(array: NDArray[Any], part: slice) -> NDArray[Any]:
    return array if array.shape[0] == 1 else array[part]


def _tall(value: Value, n: int) -> Value:
    return each_part(value, lambda part: np.broadcast_to(part, (n, *part.shape[1:])))
