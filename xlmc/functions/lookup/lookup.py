"""Lookups: a key's position in a vector, and what stands at that position elsewhere.

Keys and tables may differ between trials. Errors of arguments go before `#N/A`, and `#N/A` before a column that the
table does not have. An empty cell found stays one: formulas take it for 0 or "".
"""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.functions.arguments import (
    direct_errors,
    earliest,
    if_blank,
    leveled,
    refused,
    where_wrong,
    whole_numbers,
    with_errors,
)
from xlmc.functions.facts import Facts
from xlmc.functions.lookup.picked_cells import Indices, by_portions, each_part, picked, transposed, width_of
from xlmc.functions.lookup.vector_search import EXACT, last_not_beyond, nearest
from xlmc.functions.registry import Anything, Arrays, Cells, Kind, Logical, Number, Ranges, excel
from xlmc.functions.values import Codes, Floats, Value, constant

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
    """As MATCH searches: `order` is 1 for rising values, -1 for falling ones, 0 for the first equal one of any."""
    key = if_blank(key)
    result = np.full(1, -1)
    for wanted in np.unique(order):
        if wanted == EXACT:
            found = nearest(key, vector, wildcards=True)
        else:
            found = last_not_beyond(key, vector, falling=bool(wanted < 0))
        result = np.where(order == wanted, found, result)
    return result


@excel("MATCH", Anything, Cells, Number(default=1.0), facts=Facts(mode_argument=2, finds=True, exact_steps=True))
def match(key: Value, cells: Value, order: Value | None = None) -> Value:
    """Position of the key, or of the last value before it, in a row or column in rising (1) or falling order (-1).

    These are searched by halves, see `vector_search`. With `order` 0 the first equal value; then wildcards hold.
    """
    return by_portions(_match, [key, cells, constant(1) if order is None else order], width_of(cells))


def _match(key: Value, cells: Value, order: Value) -> Value:
    key, order = leveled(key, order)
    numbers, wrong = order.to_numbers()
    errors = earliest(key.errors, direct_errors(cells, key), wrong)
    if not _is_vector(cells.as_range()):
        return refused(key, _NOT_FOUND, errors)
    return _counted_from_1(_classic_index(key, cells.as_range(), np.sign(numbers)), errors)


def _counted_from_1(indices: Indices, errors: Codes) -> Value:
    return Value.of_numbers((indices + 1).astype(np.float64), earliest(errors, where_wrong(indices < 0, _NOT_FOUND)))


@excel("VLOOKUP", *_IN_A_TABLE, returns=Kind.ANY, facts=Facts(mode_argument=3, finds=True))
def vlookup(key: Value, table: Value, column: Value, near: Value | None = None) -> Value:
    """What stands in a column of the table, in the row whose first cell is the key; or the last up to it if `near`."""
    return by_portions(_vlookup, [key, table, column, constant(True) if near is None else near], width_of(table))


@excel("HLOOKUP", *_IN_A_TABLE, returns=Kind.ANY, facts=Facts(mode_argument=3, finds=True))
def hlookup(key: Value, table: Value, row: Value, near: Value | None = None) -> Value:
    """What stands in a row of the table, in the column whose first cell is the key; or the last up to it if `near`."""
    turned = transposed(table) if table.numbers.ndim == 3 else table
    return by_portions(_vlookup, [key, turned, row, constant(True) if near is None else near], width_of(table))


def _vlookup(key: Value, table: Value, column: Value, near: Value) -> Value:
    key, column, near = leveled(key, column, near)
    close, unclear = near.to_logicals()
    cells = table.as_range()
    rows = _classic_index(key, each_part(cells, lambda part: part[:, :, :1]), close.astype(np.float64))
    columns, wrong = whole_numbers(column)
    errors = earliest(
        *(key.errors, direct_errors(table, key), unclear),
        *(where_wrong(rows < 0, _NOT_FOUND), wrong),
        *(where_wrong(columns < 1, ErrorCode.VALUE), where_wrong(columns > cells.shape[2], ErrorCode.REF)),
    )
    sound = errors == 0
    found = picked(cells, np.where(sound, rows, 0), np.where(sound, columns - 1, 0).astype(np.intp))
    return with_errors(found, errors)


@excel("LOOKUP", Anything, Arrays, Arrays(default=None), returns=Kind.ANY, facts=Facts(mode_argument=3, finds=True))
def lookup(key: Value, cells: Value, results: Value | None = None) -> Value:
    """What stands beside the last value up to the key.

    Without `results`, the key is sought in the first row of a wide range or the first column of another, and the result
    taken from its last row or column.
    """
    if results is None:
        return by_portions(_lookup_in_array, [key, cells], width_of(cells))
    return by_portions(_lookup_in_vector, [key, cells, results], width_of(cells, results))


def _lookup_in_array(key: Value, cells: Value) -> Value:
    grid = cells.as_range()
    if grid.shape[2] > grid.shape[1]:
        grid = transposed(grid)
    errors = earliest(key.errors, direct_errors(cells, key))
    first, last = each_part(grid, lambda part: part[:, :, :1]), each_part(grid, lambda part: part[:, :, -1:])
    return _beside(key, first, last, errors)


def _lookup_in_vector(key: Value, cells: Value, results: Value) -> Value:
    errors = earliest(key.errors, direct_errors(cells, key), direct_errors(results, key))
    if not (_is_vector(cells.as_range()) and _is_vector(results.as_range())):
        return refused(key, _NOT_FOUND, errors)
    return _beside(key, cells.as_range(), each_part(results.as_range(), _as_column), errors)


def _as_column(part: Floats) -> Floats:
    return part.reshape(part.shape[0], -1, 1)


def _beside(key: Value, vector: Value, results: Value, errors: Codes) -> Value:
    """The result, (n, k, 1), at the index of the last value up to the key."""
    indices = last_not_beyond(if_blank(key), vector)
    errors = earliest(errors, where_wrong((indices < 0) | (indices >= results.shape[1]), _NOT_FOUND))
    return with_errors(picked(results, np.where(errors == 0, indices, 0), np.zeros(1, np.intp)), errors)
