"""FILTER, SORT, SORTBY and UNIQUE.

The order is numbers, texts, logicals, errors, or the reverse; blanks come last in either case. Equal rows keep their
order. Letters: n trials, r rows, c columns.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import (
    error_where,
    fill_blanks,
    first_error,
    first_error_in_row,
    require_same_in_all_trials,
    whole_numbers,
)
from xlmc.excel.functions.arrays.array_shapes import (
    Refusal,
    array_function,
    grid_of,
    read_size,
    refuse_errors,
    selected_indices,
)
from xlmc.excel.functions.lookup.picked_cells import Indices, by_portions, flatten_cells, pick, transpose_cells
from xlmc.excel.functions.ordering import to_ordered
from xlmc.excel.functions.registry import Anything, Arrays, Logical, Number
from xlmc.excel.functions.values import BLANK, ERROR, Bools, Codes, Floats, Value, constant

__all__: list[str] = []


@array_function("FILTER", Arrays, Arrays, Anything(default=None))
def filter_(array: Value, include: Value, if_empty: Value | None = None) -> Value:
    """Return the rows, or columns, where `include` holds; `if_empty`, or `#CALC!`, if it holds nowhere."""
    grid, test = grid_of(array), grid_of(include)
    if test.shape[2] == 1 and test.shape[1] == grid.shape[1]:
        return _filter_rows(grid, test, if_empty)
    if test.shape[1] == 1 and test.shape[2] == grid.shape[2]:
        return transpose_cells(_filter_rows(transpose_cells(grid), transpose_cells(test), if_empty))
    raise Refusal(ErrorCode.VALUE)


def _filter_rows(grid: Value, test: Value, if_empty: Value | None) -> Value:
    truth, errors = test.to_logicals()
    refuse_errors(first_error_in_row(np.broadcast_to(errors, test.shape)[:, :, 0]))
    mask = np.broadcast_to(truth, test.shape)[:, :, 0]
    if not mask.any() and if_empty is not None and not _is_blank(if_empty):
        return if_empty.as_range()
    return _pick_rows(grid, selected_indices(mask))


def _is_blank(value: Value) -> bool:
    """Return whether all cells are empty; where trials differ in this, evaluate trial by trial."""
    return bool(require_same_in_all_trials(np.asarray(flatten_cells(value.kinds == BLANK, value).all(axis=1))))


def _pick_rows(grid: Value, rows: Indices) -> Value:
    """Pick rows by their indices, (n, m)."""
    return pick(grid, rows[:, :, None], np.arange(grid.shape[2])[None, None, :])


@array_function("SORT", Arrays, Arrays(default=None), Arrays(default=None), Logical(default=False))
def sort(array: Value, index: Value | None = None, order: Value | None = None, by_column: Value | None = None) -> Value:
    """Return the rows in the order of one column or several, rising (1) or falling (-1); or the columns, in that of
    rows.
    """
    grid = grid_of(array)
    if read_size(by_column, 0):
        return transpose_cells(_sort_rows(transpose_cells(grid), index, order))
    return _sort_rows(grid, index, order)


def _sort_rows(grid: Value, index: Value | None, order: Value | None) -> Value:
    columns, wrong = _read_numbers(index)
    signs, wrong_too = _read_numbers(order)
    off = error_where((columns < 1) | (columns > grid.shape[2]), ErrorCode.VALUE)
    if signs.shape[1] not in (1, columns.shape[1]):
        raise Refusal(ErrorCode.VALUE)
    unknown = error_where(np.abs(signs) != 1, ErrorCode.VALUE)
    refuse_errors(first_error(*(first_error_in_row(codes) for codes in (wrong, wrong_too, off, unknown))))
    rows = np.arange(grid.shape[1])[None, :, None]
    keys = [pick(grid, rows, column[:, None, None] - 1) for column in columns.T.astype(np.intp)]
    return _pick_rows(grid, _sort_indices(keys, [signs[:, min(i, signs.shape[1] - 1)] for i in range(len(keys))]))


def _read_numbers(value: Value | None) -> tuple[Floats, Codes]:
    """Read one or several whole numbers, and errors: (n, k); 1 by default."""
    value = constant(1) if value is None else value
    numbers, errors = whole_numbers(fill_blanks(value, 1.0))
    return flatten_cells(numbers, value), flatten_cells(errors, value)


@array_function("SORTBY", Arrays, Arrays(repeat=True), Number(default=1.0, repeat=True))
def sort_by(array: Value, *pairs: Value) -> Value:
    """Return the rows, or columns, in the order of a column, or row, beside the array; where that is equal, of the
    next.
    """
    grid, keys = grid_of(array), [grid_of(key) for key in pairs[::2]]
    orders = [*pairs[1::2], constant(1)][: len(keys)]
    wholes = [whole_numbers(fill_blanks(order.as_range(), 1.0)) for order in orders]
    signs = [numbers[:, 0, 0] for numbers, _ in wholes]
    unknown = [error_where(np.abs(sign) != 1, ErrorCode.VALUE) for sign in signs]
    refuse_errors(first_error(*(errors[:, 0, 0] for _, errors in wholes), *unknown))
    if all(key.shape[1:] == (grid.shape[1], 1) for key in keys):
        return _pick_rows(grid, _sort_indices(keys, signs))
    if all(key.shape[1:] == (1, grid.shape[2]) for key in keys):
        return transpose_cells(
            _pick_rows(transpose_cells(grid), _sort_indices([transpose_cells(key) for key in keys], signs))
        )
    raise Refusal(ErrorCode.VALUE)


_GROUPS: Final = np.array([0.0, 2.0, 1.0, np.inf])
"""The places of numbers, logicals, texts and blanks in the order; errors have 3."""


def _sort_indices(keys: Sequence[Value], signs: Sequence[Floats]) -> Indices:
    """Return the indices of rows sorted by keys (n, r, 1), the first key first; a sign (n,) of -1 reverses one."""
    least_first: list[Floats] = []
    for key, sign in zip(keys, signs, strict=True):
        (by,) = to_ordered(key)
        group = np.where(by.kinds >= ERROR, 3.0, _GROUPS[np.minimum(by.kinds, BLANK)])
        turned = np.where(by.kinds == BLANK, 1.0, sign[:, None])
        least_first = [by.order * turned, group * turned, *least_first]
    return np.asarray(np.lexsort(np.broadcast_arrays(*least_first), axis=-1))


@array_function("UNIQUE", Arrays, Logical(default=False), Logical(default=False))
def unique(array: Value, by_column: Value | None = None, once: Value | None = None) -> Value:
    """Each different row, or column, once; or only those that occur once. Upper and lower case are equal."""
    grid = grid_of(array)
    if read_size(by_column, 0):
        return transpose_cells(_unique_rows(transpose_cells(grid), bool(read_size(once, 0))))
    return _unique_rows(grid, bool(read_size(once, 0)))


def _unique_rows(grid: Value, once: bool) -> Value:
    def which(grid: Value) -> Value:
        return Value.of_logicals(_is_new(grid, once)[:, :, None])

    mask = by_portions(which, [grid], grid.shape[1] * grid.shape[2])
    return _pick_rows(grid, selected_indices(mask.numbers[:, :, 0] != 0))


def _is_new(grid: Value, once: bool) -> Bools:
    """Return which rows occur for the first time, or only once: (n, r). Sorting brings equal rows together."""
    (cells,) = to_ordered(grid)
    columns = [part.reshape(grid.shape)[:, :, c] for part in (cells.kinds, cells.order) for c in range(grid.shape[2])]
    indices = np.lexsort(columns, axis=-1)
    differs = np.zeros((indices.shape[0], indices.shape[1] - 1), bool)
    for column in columns:
        in_order = np.take_along_axis(column, indices, axis=1)
        differs |= in_order[:, 1:] != in_order[:, :-1]
    edge = np.ones((indices.shape[0], 1), bool)
    first, last = np.concatenate([edge, differs], axis=1), np.concatenate([differs, edge], axis=1)
    result = np.empty(indices.shape, bool)
    np.put_along_axis(result, indices, first & last if once else first, axis=1)
    return result
