"""Cells picked from ranges, and what bodies that get `Value`s need for their single arguments.

Letters: n trials, (r, c) cells of a range, of an argument in an array formula, or of a result.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.functions.values import BLANK, ERROR, NUMBER, Bools, Codes, Floats, ShapeVaries, Value

__all__ = [
    "Places",
    "cell_of",
    "direct_errors",
    "each_part",
    "earliest",
    "first_errors",
    "if_blank",
    "leveled",
    "picked",
    "same_in_all_trials",
    "side_by_side",
    "transposed",
    "where_wrong",
    "whole_numbers",
    "with_errors",
]

Places = NDArray[np.intp]


def each_part(value: Value, change: Callable[[NDArray[Any]], NDArray[Any]]) -> Value:
    """Numbers, kinds and texts, each spread to the full shape and changed alike."""
    shape = value.shape
    texts = None if value.texts is None else change(np.broadcast_to(value.texts, shape))
    return Value(change(np.broadcast_to(value.numbers, shape)), change(np.broadcast_to(value.kinds, shape)), texts)


def transposed(cells: Value) -> Value:
    """Rows as columns: (n, r, c) -> (n, c, r)."""
    return each_part(cells, lambda part: part.swapaxes(1, 2))


def picked(cells: Value, rows: Places, columns: Places) -> Value:
    """The cell at a row and a column, counted from 0, of each trial; all places must lie inside.

    `rows` and `columns`, (n,) or (n, r, c) each, broadcast to the result's shape.
    """
    dimensions = max(rows.ndim, columns.ndim)
    n = cells.shape[0]
    trials = np.arange(n).reshape(n, *(1,) * (dimensions - 1))
    return each_part(cells, lambda part: part[trials, rows, columns])


def leveled(*values: Value) -> list[Value]:
    """All as ranges where one of them is one, so that they broadcast."""
    many = any(value.numbers.ndim == 3 for value in values)
    return [value.as_range() if many else value for value in values]


def if_blank(value: Value, instead: float = 0.0) -> Value:
    """A number where there is nothing: what Excel takes an empty cell for, or an argument left out."""
    blank = value.kinds == BLANK
    numbers = np.where(blank, instead, value.numbers)
    return Value(numbers, np.where(blank, np.uint8(NUMBER), value.kinds).astype(np.uint8), value.texts)


def whole_numbers(value: Value) -> tuple[Floats, Codes]:
    """As arithmetic sees it, the fraction dropped; and errors."""
    numbers, errors = value.to_numbers()
    return np.trunc(numbers), errors


def same_in_all_trials(array: NDArray[Any]) -> NDArray[Any]:
    """What decides on the shape of a result, (n, …), as it is in any trial.

    Raises:
        ShapeVaries: it differs between trials.
    """
    first: NDArray[Any] = array[0]
    if array.shape[0] > 1 and not (array == first).all():
        raise ShapeVaries
    return first


def cell_of(values: Value, row: int, column: int) -> Value:
    """One cell of a range: (n, r, c) -> (n,). A single row, column or value stands for all of them."""
    if values.numbers.ndim == 1:
        return values
    row, column = (min(place, size - 1) for place, size in zip((row, column), values.shape[1:], strict=True))
    return each_part(values, lambda part: part[:, row, column])


def side_by_side(cells: Sequence[Value], rows: int, columns: int) -> Value:
    """Values (n,), row by row, as a range (n, r, c)."""
    n = max(cell.shape[0] for cell in cells)
    texts = None
    if any(cell.texts is not None for cell in cells):
        texts = _stacked([np.full(1, "", object) if cell.texts is None else cell.texts for cell in cells], n)
    parts = (_stacked([c.numbers for c in cells], n), _stacked([c.kinds for c in cells], n), texts)
    numbers, kinds, texts = (None if part is None else part.reshape(n, rows, columns) for part in parts)
    return Value(numbers, kinds, texts)  # type: ignore[arg-type]  # only texts may be None


def _stacked(columns: list[NDArray[Any]], n: int) -> NDArray[Any]:
    return np.stack([np.broadcast_to(column, (n,)) for column in columns], axis=1)


def where_wrong(condition: Bools, code: int) -> Codes:
    """That error where the condition holds."""
    return np.where(condition, np.uint8(code), np.uint8(0))


def earliest(*codes: Codes) -> Codes:
    """The first that is an error; they broadcast."""
    result = np.zeros(1, np.uint8)
    for found in codes:
        result = np.where(result > 0, result, found)
    return result


def first_errors(codes: Codes) -> Codes:
    """The first error of each trial, 0 for none: (n, k) -> (n,)."""
    return np.asarray(np.take_along_axis(codes, (codes > 0).argmax(axis=1, keepdims=True), axis=1)[:, 0])


def direct_errors(cells: Value, like: Value | None = None) -> Codes:
    """The errors of an argument that should be a range and is a single value; cells of ranges may hold errors.

    They broadcast with the argument `like`.
    """
    if cells.numbers.ndim == 3:
        return np.zeros(1, np.uint8)
    return cells.errors if like is None or like.numbers.ndim == 1 else cells.errors.reshape(-1, 1, 1)


def with_errors(value: Value, errors: Codes) -> Value:
    """The value, but these errors where there are any."""
    if not errors.any():
        return value
    kinds = np.where(errors > 0, errors + np.uint8(ERROR), value.kinds).astype(np.uint8)
    return Value(np.where(errors > 0, 0.0, value.numbers), kinds, value.texts)
