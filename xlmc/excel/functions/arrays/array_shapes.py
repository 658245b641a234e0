"""Functions that cut, join and rearrange arrays; and how all functions that give arrays take their arguments.

An argument that decides on the shape must be the same in all trials, else `ShapeVaries` is raised. A body raises
`Refusal` if the result is one error instead of an array.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.address import MAX_COLUMN, MAX_ROW
from xlmc.excel.functions.arguments import (
    error_where,
    errors_unless_range,
    fill_blanks,
    first_error,
    first_error_in_row,
    require_same_in_all_trials,
    whole_numbers,
)
from xlmc.excel.functions.budget import ask_for_cells
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.logical import choose
from xlmc.excel.functions.lookup.picked_cells import (
    Indices,
    flatten_cells,
    join_cells,
    join_values,
    map_parts,
    pick,
    repeat_trials,
    transpose_cells,
)
from xlmc.excel.functions.registry import Anything, Arrays, Kind, Logical, Number, Parameter, excel
from xlmc.excel.functions.values import BLANK, ERROR, Bools, Codes, Floats, Value, constant

__all__ = ["Refusal", "array_function", "grid_of", "read_size", "refuse_errors", "selected_indices"]


class Refusal(Exception):  # noqa: N818 - it is no error of xlmc: Excel shows one
    """The whole result is an error."""

    def __init__(self, code: ErrorCode) -> None:
        super().__init__(code.text)
        self.code = code


def array_function(
    name: str, *parameters: Parameter, sized_by_numbers: bool = False
) -> Callable[[Callable[..., Value]], Callable[..., Value]]:
    """Register a body that gives an array, (n, r, c), or raises `Refusal`; `Facts` describes `sized_by_numbers`."""
    facts = Facts(spills=True, sized_by_numbers=sized_by_numbers)

    def register(body: Callable[..., Value]) -> Callable[..., Value]:
        @wraps(body)
        def apply(*values: Value) -> Value:
            try:
                return body(*values)
            except Refusal as refusal:
                return constant(refusal.code)

        excel(name, *parameters, returns=Kind.ANY, facts=facts)(apply)
        return body

    return register


def refuse_errors(codes: Codes) -> None:
    """Refuse the result if the first error of each trial, (n,), is an error.

    Raises:
        Refusal: all trials have that error.
        ShapeVaries: the errors differ between trials.
    """
    code = int(require_same_in_all_trials(codes))
    if code:
        raise Refusal(ErrorCode(code))


def grid_of(value: Value) -> Value:
    """Return an argument as a range; refuse a single error."""
    refuse_errors(errors_unless_range(value))
    return value.as_range()


def read_size(value: Value | None, default: float | None = None) -> int | None:
    """Read a whole number that decides on the shape; the default if it is left out or empty."""
    if value is None or require_same_in_all_trials(flatten_cells(value.kinds == BLANK, value)).all():
        return None if default is None else int(default)
    numbers, errors = fill_blanks(value).to_numbers()
    refuse_errors(first_error_in_row(flatten_cells(errors, value)))
    if value.numbers.ndim == 3 and value.shape[1:] != (1, 1):
        raise Refusal(ErrorCode.CALC)  # each of many numbers would make an array of its own
    return int(np.trunc(require_same_in_all_trials(flatten_cells(numbers, value))[0]))


def selected_indices(mask: Bools) -> Indices:
    """Return the indices at which a mask is TRUE: (n, k) -> (n, how many these are).

    Raises:
        ShapeVaries: their number differs between trials.
        Refusal: there are none.
    """
    count = int(require_same_in_all_trials(mask.sum(axis=1)))
    if count == 0:
        raise Refusal(ErrorCode.CALC)
    return np.argsort(~mask, axis=1, kind="stable")[:, :count]


@array_function(
    "SEQUENCE", Anything, Anything(default=None), Anything(default=None), Anything(default=None), sized_by_numbers=True
)
def sequence(rows: Value, columns: Value | None = None, start: Value | None = None, step: Value | None = None) -> Value:
    """Numbers from `start` in steps of `step`, row by row."""
    r, c = read_size(rows, 1), read_size(columns, 1)
    assert r is not None and c is not None  # noqa: PT018 - they have defaults
    if not (0 <= r <= MAX_ROW and 0 <= c <= MAX_COLUMN):
        raise Refusal(ErrorCode.VALUE)
    if 0 in (r, c):
        raise Refusal(ErrorCode.CALC)
    first, by = _read_number(start), _read_number(step)
    ask_for_cells(max(first.shape[0], by.shape[0]), r, c)
    return Value.of_numbers(first + by * np.arange(float(r * c)).reshape(1, r, c))


def _read_number(value: Value | None) -> Floats:
    """Read a single number, (n, 1, 1); 1 by default."""
    if value is None:
        return np.ones((1, 1, 1))
    numbers, errors = fill_blanks(value.as_range(), 1.0).to_numbers()
    refuse_errors(errors[:, 0, 0])
    return numbers[:, :1, :1]


@array_function("TAKE", Arrays, Number, Number(default=None), sized_by_numbers=True)
def take(array: Value, rows: Value, columns: Value | None = None) -> Value:
    """Return the first rows and columns, or with negative numbers the last."""
    grid = grid_of(array)
    r, c = (_first_slice(read_size(number)) for number in (rows, columns))
    return map_parts(grid, lambda part: part[:, r, c])


def _first_slice(count: int | None) -> slice:
    if count == 0:
        raise Refusal(ErrorCode.CALC)
    if count is None:
        return slice(None)
    return slice(count) if count > 0 else slice(count, None)


@array_function("DROP", Arrays, Number, Number(default=None), sized_by_numbers=True)
def drop(array: Value, rows: Value, columns: Value | None = None) -> Value:
    """All but the first rows and columns, or with negative numbers all but the last."""
    grid = grid_of(array)
    r, c = (_rest_slice(read_size(number), size) for number, size in zip((rows, columns), grid.shape[1:], strict=True))
    return map_parts(grid, lambda part: part[:, r, c])


def _rest_slice(count: int | None, size: int) -> slice:
    count = count or 0
    if abs(count) >= size:
        raise Refusal(ErrorCode.CALC)
    return slice(count, None) if count >= 0 else slice(count)


@array_function("CHOOSEROWS", Arrays, Arrays(repeat=True))
def choose_rows(array: Value, *numbers: Value) -> Value:
    """Rows by their numbers, from 1, or from -1 backwards; the numbers may differ between trials."""
    grid = grid_of(array)
    rows = _read_indices(numbers, grid.shape[1])
    ask_for_cells(max(grid.shape[0], rows.shape[0]), rows.shape[1], grid.shape[2])
    return pick(grid, rows[:, :, None], np.arange(grid.shape[2])[None, None, :])


@array_function("CHOOSECOLS", Arrays, Arrays(repeat=True))
def choose_columns(array: Value, *numbers: Value) -> Value:
    """Columns by their numbers, from 1, or from -1 backwards; the numbers may differ between trials."""
    grid = grid_of(array)
    columns = _read_indices(numbers, grid.shape[2])
    ask_for_cells(max(grid.shape[0], columns.shape[0]), grid.shape[1], columns.shape[1])
    return pick(grid, np.arange(grid.shape[1])[None, :, None], columns[:, None, :])


def _read_indices(numbers: tuple[Value, ...], size: int) -> Indices:
    """Read the indices, counted from 0, of rows or columns: (n, m) for m numbers in any number of arguments."""
    wholes, errors = [], []
    for value in numbers:
        whole, values = whole_numbers(value)
        wholes.append(flatten_cells(whole, value))
        errors.append(flatten_cells(values, value))
    wanted = join_cells(wholes)
    off = error_where((wanted == 0) | (np.abs(wanted) > size), ErrorCode.VALUE)
    refuse_errors(first_error(first_error_in_row(join_cells(errors)), first_error_in_row(off)))
    return np.where(wanted > 0, wanted - 1, wanted + size).astype(np.intp)


@array_function("EXPAND", Arrays, Number, Number(default=None), Anything(default=None), sized_by_numbers=True)
def expand(array: Value, rows: Value, columns: Value | None = None, pad: Value | None = None) -> Value:
    """Return the array, filled up with `pad` to so many rows and columns; `#VALUE!` for fewer than it has."""
    grid = grid_of(array)
    r, c = (read_size(number, size) for number, size in zip((rows, columns), grid.shape[1:], strict=True))
    assert r is not None and c is not None  # noqa: PT018 - they have defaults
    if r < grid.shape[1] or c < grid.shape[2] or r > MAX_ROW or c > MAX_COLUMN:
        raise Refusal(ErrorCode.VALUE)
    ask_for_cells(grid.shape[0], r, c)
    return _pick_or_pad(grid, np.arange(r)[None, :, None], np.arange(c)[None, None, :], pad)


@array_function("VSTACK", Arrays(repeat=True))
def vstack(*arrays: Value) -> Value:
    """Return the arrays one below the other, narrow ones filled up with `#N/A`."""
    return _stack([value.as_range() for value in arrays])


@array_function("HSTACK", Arrays(repeat=True))
def hstack(*arrays: Value) -> Value:
    """Return the arrays side by side, short ones filled up with `#N/A`."""
    return transpose_cells(_stack([transpose_cells(value.as_range()) for value in arrays]))


def _stack(grids: list[Value]) -> Value:
    n, c = max(grid.shape[0] for grid in grids), max(grid.shape[2] for grid in grids)
    ask_for_cells(n, sum(grid.shape[1] for grid in grids), c)
    columns = np.arange(c)[None, None, :]
    wide = [_pick_or_pad(grid, np.arange(grid.shape[1])[None, :, None], columns, None) for grid in grids]
    return join_values([repeat_trials(grid, n) for grid in wide], axis=1)


@array_function("TOCOL", Arrays, Number(default=0.0), Logical(default=False), sized_by_numbers=True)
def to_column(array: Value, ignore: Value | None = None, by_column: Value | None = None) -> Value:
    """All cells in one column, row by row or column by column; `ignore` is 1 for blanks, 2 for errors, 3 for both."""
    grid = grid_of(array)
    if read_size(by_column, 0):
        grid = transpose_cells(grid)
    column = map_parts(grid, lambda part: part.reshape(part.shape[0], -1, 1))
    ignored = read_size(ignore, 0)
    if ignored not in (0, 1, 2, 3):
        raise Refusal(ErrorCode.VALUE)
    blank, wrong = (column.kinds == BLANK) & (ignored in (1, 3)), (column.kinds >= ERROR) & (ignored in (2, 3))
    return pick(column, selected_indices(~(blank | wrong)[:, :, 0])[:, :, None], np.zeros((1, 1, 1), np.intp))


@array_function("TOROW", Arrays, Number(default=0.0), Logical(default=False), sized_by_numbers=True)
def to_row(array: Value, ignore: Value | None = None, by_column: Value | None = None) -> Value:
    """All cells in one row, in the order of `TOCOL`."""
    return transpose_cells(to_column(array, ignore, by_column))


@array_function("WRAPROWS", Arrays, Number, Anything(default=None), sized_by_numbers=True)
def wrap_rows(vector: Value, count: Value, pad: Value | None = None) -> Value:
    """Return the cells of a row or column, rearranged in rows of so many cells, the last filled up with `pad`."""
    grid, size = grid_of(vector), read_size(count, 0)
    if 1 not in grid.shape[1:]:
        raise Refusal(ErrorCode.VALUE)
    if size is None or size < 1:
        raise Refusal(ErrorCode.NUM)
    row = map_parts(grid, lambda part: part.reshape(part.shape[0], 1, -1))
    size = min(size, row.shape[2])
    indices = np.arange(-(-row.shape[2] // size) * size).reshape(1, -1, size)
    return _pick_or_pad(row, np.zeros((1, 1, 1), np.intp), indices, pad)


@array_function("WRAPCOLS", Arrays, Number, Anything(default=None), sized_by_numbers=True)
def wrap_columns(vector: Value, count: Value, pad: Value | None = None) -> Value:
    """Return the cells of a row or column, rearranged in columns of so many cells, the last filled up with `pad`."""
    return transpose_cells(wrap_rows(vector, count, pad))


def _pick_or_pad(cells: Value, rows: Indices, columns: Indices, pad: Value | None) -> Value:
    """Pick the cells at these indices, together (1, r, c); where one lies outside, the pad or `#N/A`."""
    inside = (rows < cells.shape[1]) & (columns < cells.shape[2])
    value = pick(cells, np.minimum(rows, cells.shape[1] - 1), np.minimum(columns, cells.shape[2] - 1))
    missing = pad is None or bool((pad.kinds == BLANK).all())
    return choose(inside, value, constant(ErrorCode.NA) if pad is None or missing else pad)
