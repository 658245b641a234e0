"""How cells are picked from ranges, rearranged and joined, and wide ranges computed in portions of the trials.

Letters: n trials, (r, c) cells of a range, k cells in a row.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.excel.functions.values import Objects, ShapeVaries, Value, kept_with_table

__all__ = [
    "Indices",
    "arrange",
    "by_portions",
    "cell_of",
    "column_of",
    "flatten_cells",
    "join_cells",
    "join_values",
    "map_parts",
    "pick",
    "repeat_trials",
    "transpose_cells",
    "turn",
    "width_of",
]

Indices = NDArray[np.intp]


def map_parts(value: Value, change: Callable[[NDArray[Any]], NDArray[Any]]) -> Value:
    """Spread numbers, kinds and texts to the full shape, and change each of them in the same way."""
    shape = value.shape
    texts = None if value.texts is None else change(np.broadcast_to(value.texts, shape))
    return Value(change(np.broadcast_to(value.numbers, shape)), change(np.broadcast_to(value.kinds, shape)), texts)


def flatten_cells(part: NDArray[Any], value: Value) -> NDArray[Any]:
    """Put the cells of each trial in a row, (n, k): of a part of the value, or of an array that broadcasts to it."""
    return np.broadcast_to(part, value.shape).reshape(value.shape[0], -1)


def join_cells(rows: Sequence[NDArray[Any]]) -> NDArray[Any]:
    """Put rows of cells side by side: (n, k) or (1, k) each -> (n, the sum of all k)."""
    n = max(row.shape[0] for row in rows)
    return np.concatenate([np.broadcast_to(row, (n, row.shape[1])) for row in rows], axis=1)


def transpose_cells(cells: Value) -> Value:
    """Turn rows into columns: (n, r, c) -> (n, c, r)."""
    return map_parts(cells, lambda part: part.swapaxes(1, 2))


@kept_with_table
def column_of(cells: Value, column: int) -> Value:
    """Return a column, (n, r, 1); of cells that do not vary it is the same object for every lookup in them."""
    return map_parts(cells, lambda part: part[:, :, column : column + 1])


@kept_with_table
def turn(cells: Value) -> Value:
    """Turn rows into columns; cells that do not vary give the same object for every lookup in them."""
    return transpose_cells(cells)


def pick(cells: Value, rows: Indices, columns: Indices) -> Value:
    """Return, for each trial, the cell at a row and a column, counted from 0; all must lie inside.

    `rows` and `columns`, (n,) or (n, r, c) each, broadcast to the result's shape.
    """
    dimensions = max(rows.ndim, columns.ndim)
    n = cells.shape[0]
    trials = np.arange(n).reshape(n, *(1,) * (dimensions - 1))
    return map_parts(cells, lambda part: part[trials, rows, columns])


def cell_of(values: Value, row: int, column: int) -> Value:
    """Return one cell of a range: (n, r, c) -> (n,). A single row, column or value counts as repeated."""
    if values.numbers.ndim == 1:
        return values
    row, column = (min(index, size - 1) for index, size in zip((row, column), values.shape[1:], strict=True))
    return map_parts(values, lambda part: part[:, row, column])


def arrange(cells: Sequence[Value], rows: int, columns: int) -> Value:
    """Arrange values (n,) row by row as a range (n, r, c)."""
    n = max(cell.shape[0] for cell in cells)
    tall = [map_parts(cell, lambda part: np.broadcast_to(part, (n,))[:, None]) for cell in cells]
    return map_parts(join_values(tall, axis=1), lambda part: part.reshape(n, rows, columns))


def join_values(values: Sequence[Value], axis: int) -> Value:
    """Join values along an axis; along the others they have the same length."""
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
"""The most cells, of all trials together, that a body computes at once."""


def width_of(*values: Value) -> int:
    """Return how many cells a trial has in the largest value that differs between trials."""
    return max((int(np.prod(value.shape[1:])) for value in values if value.shape[0] > 1), default=0)


def by_portions(compute: Callable[..., Value], values: Sequence[Value], width: int) -> Value:
    """Compute `compute(*values)` in portions of the trials, each trial taking memory for `width` cells.

    Raises:
        ShapeVaries: the results of the portions differ in shape.
    """
    n = max(value.shape[0] for value in values)
    size = max(1, _MOST // max(1, width))
    if n <= size:
        return compute(*values)
    parts = [slice(start, min(start + size, n)) for start in range(0, n, size)]
    results = [repeat_trials(compute(*(_trials(v, part) for v in values)), part.stop - part.start) for part in parts]
    if len({result.shape[1:] for result in results}) > 1:
        raise ShapeVaries
    return join_values(results, axis=0)


def _trials(value: Value, part: slice) -> Value:
    """Return some of the trials; a constant stays as it is."""
    if value.shape[0] == 1:
        return value
    texts = None if value.texts is None else _some(value.texts, part)
    return Value(_some(value.numbers, part), _some(value.kinds, part), texts)


def _some(array: NDArray[Any], part: slice) -> NDArray[Any]:
    return array if array.shape[0] == 1 else array[part]


def repeat_trials(value: Value, n: int) -> Value:
    """Repeat a constant for n trials; a value that has n stays as it is."""
    return map_parts(value, lambda part: np.broadcast_to(part, (n, *part.shape[1:])))
