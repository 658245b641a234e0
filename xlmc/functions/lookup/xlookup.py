"""XMATCH and XLOOKUP: lookups that ask for no order of the values.

A key that is an empty cell finds an empty cell. Arguments left empty take their defaults.
"""

from __future__ import annotations

from itertools import product
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.functions.arguments import (
    direct_errors,
    earliest,
    if_blank,
    leveled,
    refused,
    same_in_all_trials,
    where_wrong,
    whole_numbers,
    with_errors,
)
from xlmc.functions.facts import Facts
from xlmc.functions.logical import choose
from xlmc.functions.lookup.picked_cells import Indices, by_portions, each_part, picked, transposed, width_of
from xlmc.functions.lookup.vector_search import EXACT, LARGER, SMALLER, last_not_beyond, nearest
from xlmc.functions.ordering import ordered
from xlmc.functions.registry import Anything, Arrays, Kind, Number, excel
from xlmc.functions.values import BLANK, Codes, Value, constant

__all__: list[str] = []

_WILDCARDS: Final = 2
_MODES: Final = (EXACT, SMALLER, LARGER, _WILDCARDS)
_FROM_THE_END, _RISING, _FALLING = -1, 2, -2
_DIRECTIONS: Final = (1, _FROM_THE_END, _RISING, _FALLING)
"""From end to end either way, or by halves of values in order."""


def _indices(key: Value, vector: Value, mode: Value, direction: Value) -> tuple[Indices, Codes]:
    """The key's index, counted from 0, or -1; and the errors of the last two arguments."""
    (modes, wrong), (directions, wrong_too) = whole_numbers(if_blank(mode)), whole_numbers(if_blank(direction, 1.0))
    result = np.full(key.shape, -1)
    known = np.zeros(1, bool)
    for wanted, towards in product(_MODES, _DIRECTIONS):
        chosen = (modes == wanted) & (directions == towards)
        if chosen.any() and not (wanted == _WILDCARDS and abs(towards) == _RISING):
            result = np.where(chosen, _found_at(key, vector, wanted, towards), result)
            known = known | chosen
    return result, earliest(wrong, wrong_too, where_wrong(~known, ErrorCode.VALUE))


def _found_at(key: Value, vector: Value, mode: int, direction: int) -> Indices:
    if abs(direction) == _RISING:
        return _by_halves(key, vector, mode, direction == _FALLING)
    by_pattern = mode == _WILDCARDS
    return nearest(key, vector, EXACT if by_pattern else mode, last=direction == _FROM_THE_END, wildcards=by_pattern)


def _by_halves(key: Value, vector: Value, side: int, falling: bool) -> Indices:
    """As MATCH searches; a neighbour that is asked for may be of any kind."""
    before = last_not_beyond(key, vector, falling=falling)
    if side == (LARGER if falling else SMALLER):
        return before
    column = each_part(vector, lambda part: part.reshape(part.shape[0], -1, 1))
    wanted, found = ordered(key, picked(column, np.maximum(before, 0), np.zeros(1, np.intp)))
    equal = ((wanted.kinds == found.kinds) & (wanted.order == found.order)).reshape(before.shape) & (before >= 0)
    after = np.where(before + 1 < column.shape[1], before + 1, -1)
    return np.where(equal, before, -1 if side == EXACT else after)


@excel(
    "XMATCH",
    Anything,
    Arrays,
    Number(default=0.0),
    Number(default=1.0),
    facts=Facts(mode_argument=3, finds=True, exact_steps=True),
)
def xmatch(key: Value, cells: Value, mode: Value | None = None, direction: Value | None = None) -> Value:
    """Position of the key in a row or column: its equal, or the next smaller (-1) or larger (1); 2 for wildcards."""
    modes, directions = constant(None) if mode is None else mode, constant(None) if direction is None else direction
    return by_portions(_xmatch, [key, cells, modes, directions], width_of(cells))


def _xmatch(key: Value, cells: Value, mode: Value, direction: Value) -> Value:
    key, mode, direction = leveled(key, mode, direction)
    errors = earliest(key.errors, direct_errors(cells, key))
    vector = cells.as_range()
    if 1 not in vector.shape[1:]:
        return refused(key, ErrorCode.VALUE, errors)
    indices, wrong = _indices(key, vector, mode, direction)
    return Value.of_numbers(
        (indices + 1).astype(np.float64), earliest(errors, wrong, where_wrong(indices < 0, ErrorCode.NA))
    )


_OPTIONS: Final = (Anything(default=None), Number(default=0.0), Number(default=1.0))


@excel(
    "XLOOKUP",
    Anything,
    Arrays,
    Arrays,
    *_OPTIONS,
    returns=Kind.ANY,
    facts=Facts(spills=True, mode_argument=5, finds=True),
)
def xlookup(
    key: Value,
    cells: Value,
    results: Value,
    instead: Value | None = None,
    mode: Value | None = None,
    direction: Value | None = None,
) -> Value:
    """What stands in `results` where the key stands in `cells`, else `instead`: a cell, or the whole row or column.

    Raises:
        ShapeVaries: the result is a row or column, and not found in some of the trials.
    """
    absent = constant(None)
    options = [absent if value is None else value for value in (instead, mode, direction)]
    return by_portions(_xlookup, [key, cells, results, *options], width_of(cells, results))


def _xlookup(key: Value, cells: Value, results: Value, instead: Value, mode: Value, direction: Value) -> Value:
    key, instead, mode, direction = leveled(key, instead, mode, direction)
    instead = with_errors(instead, where_wrong(instead.kinds == BLANK, ErrorCode.NA))
    errors = earliest(key.errors, direct_errors(cells, key), direct_errors(results, key))
    vector, grid = cells.as_range(), results.as_range()
    if _goes_down(vector, grid):
        return _found(key, vector, grid, instead, mode, direction, errors)
    if _goes_down(transposed(vector), transposed(grid)):
        row = _found(key, transposed(vector), transposed(grid), instead, mode, direction, errors)
        return row if row.shape[1:] == key.shape[1:] else transposed(row)
    return refused(key, ErrorCode.VALUE, errors)


def _goes_down(vector: Value, results: Value) -> bool:
    """Whether the vector is a column, as long as the results."""
    return vector.shape[2] == 1 and vector.shape[1] == results.shape[1]


def _found(
    key: Value, vector: Value, results: Value, instead: Value, mode: Value, direction: Value, errors: Codes
) -> Value:
    """A single key finds a whole row of `results`, keys in an array formula the first cell of theirs."""
    indices, wrong = _indices(key, vector, mode, direction)
    errors = earliest(errors, wrong)
    found = (indices >= 0) & (errors == 0)
    rows = np.where(found, indices, 0)
    if results.shape[2] == 1 or indices.ndim == 3:
        return choose(found, picked(results, rows, np.zeros(1, np.intp)), with_errors(instead, errors))
    if not same_in_all_trials(found):
        return with_errors(instead, errors)
    return picked(results, rows[:, None, None], np.arange(results.shape[2])[None, None, :])
