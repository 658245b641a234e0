"""Lookups: they find the position of a key in a vector, and the cell at that position elsewhere.

Keys and tables may differ between trials. Errors of arguments go before `#N/A`, and `#N/A` before the error for a
column that the table does not have. If the cell found is empty, so is the result: formulas take it for 0 or "".

`XMATCH` and `XLOOKUP` need no order of the values. With them an empty cell as key finds an empty cell, and arguments
left empty take their defaults.
"""

from __future__ import annotations

from itertools import product
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import (
    align_ranges,
    error_everywhere,
    error_where,
    errors_unless_range,
    fill_blanks,
    first_error,
    require_same_in_all_trials,
    whole_numbers,
    with_errors,
)
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.logical import choose
from xlmc.excel.functions.lookup.picked_cells import (
    Indices,
    by_portions,
    column_of,
    map_parts,
    pick,
    transpose_cells,
    turn,
    width_of,
)
from xlmc.excel.functions.lookup.vector_search import (
    EXACT,
    LARGER,
    SMALLER,
    before_first_smaller,
    last_not_beyond,
    nearest,
)
from xlmc.excel.functions.ordering import to_ordered
from xlmc.excel.functions.registry import Anything, Arrays, Cells, Kind, Logical, Number, Ranges, excel
from xlmc.excel.functions.values import BLANK, Codes, Floats, Value, constant

__all__: list[str] = []

_NOT_FOUND: Final = ErrorCode.NA

_IN_A_TABLE: Final = (
    Anything(ranges=Ranges.SINGLE),
    Cells(ranges=Ranges.BESIDE),
    Number(ranges=Ranges.BESIDE),
    Logical(default=True, ranges=Ranges.SINGLE),
)


def _is_vector(cells: Value) -> bool:
    return 1 in cells.shape[1:]


def _classic_index(key: Value, vector: Value, order: Floats) -> Indices:
    """Search as MATCH does: `order` is 1 for rising values, -1 for falling ones, 0 for the first equal value."""
    key = fill_blanks(key)
    result = np.full(1, -1)
    for wanted in np.unique(order):
        if wanted == EXACT:
            values = nearest(key, vector, wildcards=True)
        else:
            values = before_first_smaller(key, vector) if wanted < 0 else last_not_beyond(key, vector)
        result = np.where(order == wanted, values, result)
    return result


@excel("MATCH", Anything, Cells, Number(default=1.0), facts=Facts(mode_argument=2, jumps=True, exact_steps=True))
def match(key: Value, cells: Value, order: Value | None = None) -> Value:
    """Position of the key, or of the last value before it, in a row or column in rising (1) or falling order (-1).

    `vector_search` says how these are searched. With `order` 0 it is that of the first equal value; wildcards count.
    """
    return by_portions(_match, [key, cells, constant(1) if order is None else order], width_of(cells))


def _match(key: Value, cells: Value, order: Value) -> Value:
    key, order = align_ranges(key, order)
    numbers, wrong = order.to_numbers()
    errors = first_error(key.errors, errors_unless_range(cells, key), wrong)
    if not _is_vector(cells.as_range()):
        return error_everywhere(key, _NOT_FOUND, errors)
    return _counted_from_1(_classic_index(key, cells.as_range(), np.sign(numbers)), errors)


def _counted_from_1(indices: Indices, errors: Codes) -> Value:
    return Value.of_numbers((indices + 1).astype(np.float64), first_error(errors, error_where(indices < 0, _NOT_FOUND)))


@excel("VLOOKUP", *_IN_A_TABLE, returns=Kind.ANY, facts=Facts(mode_argument=3, jumps=True))
def vlookup(key: Value, table: Value, column: Value, near: Value | None = None) -> Value:
    """Return the cell in a column of the table and the row that begins with the key or, if `near`, the last value up to
    it.
    """
    return by_portions(_vlookup, [key, table, column, constant(True) if near is None else near], width_of(table))


@excel("HLOOKUP", *_IN_A_TABLE, returns=Kind.ANY, facts=Facts(mode_argument=3, jumps=True))
def hlookup(key: Value, table: Value, row: Value, near: Value | None = None) -> Value:
    """Return the cell in a row of the table and the column that begins with the key or, if `near`, the last value up to
    it.
    """
    turned = turn(table) if table.numbers.ndim == 3 else table
    return by_portions(_vlookup, [key, turned, row, constant(True) if near is None else near], width_of(table))


def _vlookup(key: Value, table: Value, column: Value, near: Value) -> Value:
    key, column, near = align_ranges(key, column, near)
    close, unclear = near.to_logicals()
    cells = table.as_range()
    rows = _classic_index(key, column_of(cells, 0), close.astype(np.float64))
    columns, wrong = whole_numbers(column)
    errors = first_error(
        *(key.errors, errors_unless_range(table, key), unclear),
        *(error_where(rows < 0, _NOT_FOUND), wrong),
        *(error_where(columns < 1, ErrorCode.VALUE), error_where(columns > cells.shape[2], ErrorCode.REF)),
    )
    sound = errors == 0
    value = pick(cells, np.where(sound, rows, 0), np.where(sound, columns - 1, 0).astype(np.intp))
    return with_errors(value, errors)


@excel("LOOKUP", Anything, Arrays, Arrays(default=None), returns=Kind.ANY, facts=Facts(mode_argument=3, jumps=True))
def lookup(key: Value, cells: Value, results: Value | None = None) -> Value:
    """Return the cell beside the last value up to the key.

    The key is searched in the first column of the range; without `results`, the result is in its last column. In a
    range that is wider than high, these are rows.
    """
    if results is None:
        return by_portions(_lookup_in_array, [key, cells], width_of(cells))
    return by_portions(_lookup_in_vector, [key, cells, results], width_of(cells, results))


def _lookup_in_array(key: Value, cells: Value) -> Value:
    grid = _upright(cells.as_range())
    errors = first_error(key.errors, errors_unless_range(cells, key))
    first, last = column_of(grid, 0), column_of(grid, grid.shape[2] - 1)
    return _take_beside(key, first, last, errors)


def _lookup_in_vector(key: Value, cells: Value, results: Value) -> Value:
    errors = first_error(key.errors, errors_unless_range(cells, key), errors_unless_range(results, key))
    if not _is_vector(results.as_range()):
        return error_everywhere(key, _NOT_FOUND, errors)
    first = column_of(_upright(cells.as_range()), 0)
    return _take_beside(key, first, map_parts(results.as_range(), _as_column), errors)


def _upright(grid: Value) -> Value:
    """Return the range, turned where it is wider than high: LOOKUP searches its first row then."""
    return turn(grid) if grid.shape[2] > grid.shape[1] else grid


def _as_column(part: Floats) -> Floats:
    return part.reshape(part.shape[0], -1, 1)


def _take_beside(key: Value, vector: Value, results: Value, errors: Codes) -> Value:
    """Take from the results, (n, k, 1), the one at the index of the last value up to the key."""
    indices = last_not_beyond(fill_blanks(key), vector)
    errors = first_error(errors, error_where((indices < 0) | (indices >= results.shape[1]), _NOT_FOUND))
    return with_errors(pick(results, np.where(errors == 0, indices, 0), np.zeros(1, np.intp)), errors)


_WILDCARDS: Final = 2
_MODES: Final = (EXACT, SMALLER, LARGER, _WILDCARDS)
_FROM_THE_END, _RISING, _FALLING = -1, 2, -2
_DIRECTIONS: Final = (1, _FROM_THE_END, _RISING, _FALLING)
"""Cell by cell from either end, or by halving values that are in order."""


def _find_indices(key: Value, vector: Value, mode: Value, direction: Value) -> tuple[Indices, Codes]:
    """Find the key's index, counted from 0, or -1; and the errors of the last two arguments."""
    (modes, wrong), (directions, wrong_too) = (
        whole_numbers(fill_blanks(mode)),
        whole_numbers(fill_blanks(direction, 1.0)),
    )
    result = np.full(key.shape, -1)
    known = np.zeros(1, bool)
    for wanted, towards in product(_MODES, _DIRECTIONS):
        chosen = (modes == wanted) & (directions == towards)
        if chosen.any() and not (wanted == _WILDCARDS and abs(towards) == _RISING):
            result = np.where(chosen, _search(key, vector, wanted, towards), result)
            known = known | chosen
    return result, first_error(wrong, wrong_too, error_where(~known, ErrorCode.VALUE))


def _search(key: Value, vector: Value, mode: int, direction: int) -> Indices:
    if abs(direction) == _RISING:
        return _search_by_halves(key, vector, mode, direction == _FALLING)
    by_pattern = mode == _WILDCARDS
    return nearest(key, vector, EXACT if by_pattern else mode, last=direction == _FROM_THE_END, wildcards=by_pattern)


def _search_by_halves(key: Value, vector: Value, side: int, falling: bool) -> Indices:
    """Search as MATCH does; the next smaller or larger value may be of any kind."""
    before = last_not_beyond(key, vector, falling=falling)
    if side == (LARGER if falling else SMALLER):
        return before
    column = map_parts(vector, lambda part: part.reshape(part.shape[0], -1, 1))
    wanted, order = to_ordered(key, pick(column, np.maximum(before, 0), np.zeros(1, np.intp)))
    equal = ((wanted.kinds == order.kinds) & (wanted.order == order.order)).reshape(before.shape) & (before >= 0)
    after = np.where(before + 1 < column.shape[1], before + 1, -1)
    return np.where(equal, before, -1 if side == EXACT else after)


@excel(
    "XMATCH",
    Anything,
    Arrays,
    Number(default=0.0),
    Number(default=1.0),
    facts=Facts(mode_argument=3, jumps=True, exact_steps=True),
)
def xmatch(key: Value, cells: Value, mode: Value | None = None, direction: Value | None = None) -> Value:
    """Position of the key in a row or column: its equal, or the next smaller (-1) or larger (1); 2 for wildcards."""
    modes, directions = constant(None) if mode is None else mode, constant(None) if direction is None else direction
    return by_portions(_xmatch, [key, cells, modes, directions], width_of(cells))


def _xmatch(key: Value, cells: Value, mode: Value, direction: Value) -> Value:
    key, mode, direction = align_ranges(key, mode, direction)
    errors = first_error(key.errors, errors_unless_range(cells, key))
    vector = cells.as_range()
    if 1 not in vector.shape[1:]:
        return error_everywhere(key, ErrorCode.VALUE, errors)
    indices, wrong = _find_indices(key, vector, mode, direction)
    return Value.of_numbers(
        (indices + 1).astype(np.float64), first_error(errors, wrong, error_where(indices < 0, ErrorCode.NA))
    )


_OPTIONS: Final = (Anything(default=None), Number(default=0.0), Number(default=1.0))


@excel(
    "XLOOKUP",
    Anything,
    Arrays,
    Arrays,
    *_OPTIONS,
    returns=Kind.ANY,
    facts=Facts(spills=True, mode_argument=5, jumps=True),
)
def xlookup(
    key: Value,
    cells: Value,
    results: Value,
    instead: Value | None = None,
    mode: Value | None = None,
    direction: Value | None = None,
) -> Value:
    """Return the cell, row or column of `results` at the position of the key in `cells`; `instead` if it is not found.

    Raises:
        ShapeVaries: the result is a row or column, and some trials do not find the key.
    """
    absent = constant(None)
    options = [absent if value is None else value for value in (instead, mode, direction)]
    return by_portions(_xlookup, [key, cells, results, *options], width_of(cells, results))


def _xlookup(key: Value, cells: Value, results: Value, instead: Value, mode: Value, direction: Value) -> Value:
    key, instead, mode, direction = align_ranges(key, instead, mode, direction)
    instead = with_errors(instead, error_where(instead.kinds == BLANK, ErrorCode.NA))
    errors = first_error(key.errors, errors_unless_range(cells, key), errors_unless_range(results, key))
    vector, grid = cells.as_range(), results.as_range()
    if _is_column_beside(vector, grid):
        return _take_found(key, vector, grid, instead, mode, direction, errors)
    if _is_column_beside(turn(vector), turn(grid)):
        row = _take_found(key, turn(vector), turn(grid), instead, mode, direction, errors)
        return row if row.shape[1:] == key.shape[1:] else transpose_cells(row)
    return error_everywhere(key, ErrorCode.VALUE, errors)


def _is_column_beside(vector: Value, results: Value) -> bool:
    """Return whether the vector is a column as long as the results."""
    return vector.shape[2] == 1 and vector.shape[1] == results.shape[1]


def _take_found(
    key: Value, vector: Value, results: Value, instead: Value, mode: Value, direction: Value, errors: Codes
) -> Value:
    """Take the row of `results` that a single key finds; for the keys of an array formula, its first cell."""
    indices, wrong = _find_indices(key, vector, mode, direction)
    errors = first_error(errors, wrong)
    value = (indices >= 0) & (errors == 0)
    rows = np.where(value, indices, 0)
    if results.shape[2] == 1 or indices.ndim == 3:
        return choose(value, pick(results, rows, np.zeros(1, np.intp)), with_errors(instead, errors))
    found_in_all = require_same_in_all_trials(value)
    if not found_in_all:
        return with_errors(instead, errors)
    return pick(results, rows[:, None, None], np.arange(results.shape[2])[None, None, :])
