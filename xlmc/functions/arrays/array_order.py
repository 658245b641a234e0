"""Arrays filtered, put in order, freed of repetitions.

Order: numbers, texts, logicals, errors, or all of these backwards; blanks come last in any case. What stands in order
keeps its order. Letters: n trials, r rows, c columns.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.functions.arguments import (
    earliest,
    first_errors,
    if_blank,
    same_in_all_trials,
    where_wrong,
    whole_numbers,
)
from xlmc.functions.arrays.array_shapes import Refusal, array_function, decided, grid_of, kept, refuse_errors
from xlmc.functions.lookup.picked_cells import Indices, by_portions, flattened, picked, transposed
from xlmc.functions.ordering import ordered
from xlmc.functions.registry import Anything, Arrays, Logical, Number
from xlmc.functions.values import BLANK, ERROR, Bools, Codes, Floats, Value, constant

__all__: list[str] = []


@array_function("FILTER", Arrays, Arrays, Anything(default=None))
def filter_(array: Value, include: Value, if_empty: Value | None = None) -> Value:
    """The rows, or columns, where `include` holds; `if_empty`, or `#CALC!`, where it holds nowhere."""
    grid, test = grid_of(array), grid_of(include)
    if test.shape[2] == 1 and test.shape[1] == grid.shape[1]:
        return _filtered(grid, test, if_empty)
    if test.shape[1] == 1 and test.shape[2] == grid.shape[2]:
        return transposed(_filtered(transposed(grid), transposed(test), if_empty))
    raise Refusal(ErrorCode.VALUE)


def _filtered(grid: Value, test: Value, if_empty: Value | None) -> Value:
    truth, errors = test.to_logicals()
    refuse_errors(first_errors(np.broadcast_to(errors, test.shape)[:, :, 0]))
    mask = np.broadcast_to(truth, test.shape)[:, :, 0]
    if not mask.any() and if_empty is not None and not _is_blank(if_empty):
        return if_empty.as_range()
    return _rows(grid, kept(mask))


def _is_blank(value: Value) -> bool:
    """Whether all cells are empty; trial by trial where that differs."""
    return bool(same_in_all_trials(np.asarray(flattened(value.kinds == BLANK, value).all(axis=1))))


def _rows(grid: Value, rows: Indices) -> Value:
    """Rows by their indices, (n, m)."""
    return picked(grid, rows[:, :, None], np.arange(grid.shape[2])[None, None, :])


@array_function("SORT", Arrays, Arrays(default=None), Arrays(default=None), Logical(default=False))
def sort(array: Value, index: Value | None = None, order: Value | None = None, by_column: Value | None = None) -> Value:
    """The rows in the order of one column, or of several; 1 rising, -1 falling. Or so the columns."""
    grid = grid_of(array)
    if decided(by_column, 0):
        return transposed(_sorted(transposed(grid), index, order))
    return _sorted(grid, index, order)


def _sorted(grid: Value, index: Value | None, order: Value | None) -> Value:
    columns, wrong = _numbers(index)
    signs, wrong_too = _numbers(order)
    off = where_wrong((columns < 1) | (columns > grid.shape[2]), ErrorCode.VALUE)
    if signs.shape[1] not in (1, columns.shape[1]):
        raise Refusal(ErrorCode.VALUE)
    unknown = where_wrong(np.abs(signs) != 1, ErrorCode.VALUE)
    refuse_errors(earliest(*(first_errors(codes) for codes in (wrong, wrong_too, off, unknown))))
    rows = np.arange(grid.shape[1])[None, :, None]
    keys = [picked(grid, rows, column[:, None, None] - 1) for column in columns.T.astype(np.intp)]
    return _rows(grid, _in_order(keys, [signs[:, min(i, signs.shape[1] - 1)] for i in range(len(keys))]))


def _numbers(value: Value | None) -> tuple[Floats, Codes]:
    """The whole numbers of an argument that may be several, and errors: (n, k); 1 by default."""
    value = constant(1) if value is None else value
    numbers, errors = whole_numbers(if_blank(value, 1.0))
    return flattened(numbers, value), flattened(errors, value)


@array_function("SORTBY", Arrays, Arrays(repeat=True), Number(default=1.0, repeat=True))
def sort_by(array: Value, *pairs: Value) -> Value:
    """The rows, or columns, in the order of the first column, or row, beside the array; of the next where equal."""
    grid, keys = grid_of(array), [grid_of(key) for key in pairs[::2]]
    orders = [*pairs[1::2], constant(1)][: len(keys)]
    wholes = [whole_numbers(if_blank(order.as_range(), 1.0)) for order in orders]
    signs = [numbers[:, 0, 0] for numbers, _ in wholes]
    unknown = [where_wrong(np.abs(sign) != 1, ErrorCode.VALUE) for sign in signs]
    refuse_errors(earliest(*(errors[:, 0, 0] for _, errors in wholes), *unknown))
    if all(key.shape[1:] == (grid.shape[1], 1) for key in keys):
        return _rows(grid, _in_order(keys, signs))
    if all(key.shape[1:] == (1, grid.shape[2]) for key in keys):
        return transposed(_rows(transposed(grid), _in_order([transposed(key) for key in keys], signs)))
    raise Refusal(ErrorCode.VALUE)


_GROUPS: Final = np.array([0.0, 2.0, 1.0, np.inf])
"""Numbers, logicals, texts, blanks."""


def _in_order(keys: Sequence[Value], signs: Sequence[Floats]) -> Indices:
    """The indices of rows in the order of keys (n, r, 1), the first before the next; a sign (n,) of -1 turns one."""
    least_first: list[Floats] = []
    for key, sign in zip(keys, signs, strict=True):
        (by,) = ordered(key)
        group = np.where(by.kinds >= ERROR, 3.0, _GROUPS[np.minimum(by.kinds, BLANK)])
        turned = np.where(by.kinds == BLANK, 1.0, sign[:, None])
        least_first = [by.order * turned, group * turned, *least_first]
    return np.asarray(np.lexsort(np.broadcast_arrays(*least_first), axis=-1))


@array_function("UNIQUE", Arrays, Logical(default=False), Logical(default=False))
def unique(array: Value, by_column: Value | None = None, once: Value | None = None) -> Value:
    """Each different row, or column, once; or those only that occur once. Texts differ by more than case."""
    grid = grid_of(array)
    if decided(by_column, 0):
        return transposed(_unique(transposed(grid), bool(decided(once, 0))))
    return _unique(grid, bool(decided(once, 0)))


def _unique(grid: Value, once: bool) -> Value:
    def which(grid: Value) -> Value:
        return Value.of_logicals(_is_new(grid, once)[:, :, None])

    mask = by_portions(which, [grid], grid.shape[1] * grid.shape[2])
    return _rows(grid, kept(mask.numbers[:, :, 0] != 0))


def _is_new(grid: Value, once: bool) -> Bools:
    """Which rows occur not before, or nowhere else: (n, r). Equal rows stand together once they are in order."""
    (cells,) = ordered(grid)
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
