"""Arrays cut, joined and laid out anew, and how all functions that give arrays take their arguments.

What decides on the shape must be the same in all trials; where it is not, `ShapeVaries` is raised. A body raises
`Refusal` where the result is one error instead of an array.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps

import numpy as np

from xlmc.address import MAX_COLUMN, MAX_ROW
from xlmc.errors import ErrorCode
from xlmc.functions.arguments import (
    direct_errors,
    earliest,
    first_errors,
    if_blank,
    same_in_all_trials,
    where_wrong,
    whole_numbers,
)
from xlmc.functions.budget import ask_for_cells
from xlmc.functions.facts import Facts
from xlmc.functions.logical import choose
from xlmc.functions.lookup.picked_cells import Indices, each_part, flattened, joined, picked, transposed
from xlmc.functions.registry import Anything, Arrays, Kind, Logical, Number, Parameter, excel
from xlmc.functions.values import BLANK, ERROR, Bools, Codes, Floats, Value, constant

__all__ = ["Refusal", "array_function", "decided", "grid_of", "kept", "refuse_errors"]


class Refusal(Exception):  # noqa: N818 - it is no error of ours: Excel shows one
    """The whole result is an error."""

    def __init__(self, code: ErrorCode) -> None:
        super().__init__(code.text)
        self.code = code


def array_function(
    name: str, *parameters: Parameter, sized_by_numbers: bool = False
) -> Callable[[Callable[..., Value]], Callable[..., Value]]:
    """Register a body that gives an array, (n, r, c), or raises `Refusal`; see `Facts` for what sizes it."""
    facts = Facts(spills=True, sized_by_numbers=sized_by_numbers)

    def register(body: Callable[..., Value]) -> Callable[..., Value]:
        @wraps(body)
        def refusing(*values: Value) -> Value:
            try:
                return body(*values)
            except Refusal as refusal:
                return constant(refusal.code)

        excel(name, *parameters, returns=Kind.ANY, facts=facts)(refusing)
        return body

    return register


def refuse_errors(codes: Codes) -> None:
    """Refuse where the first error of each trial, (n,), is one.

    Raises:
        Refusal: there is that error in all trials.
        ShapeVaries: it differs between trials.
    """
    code = int(same_in_all_trials(codes))
    if code:
        raise Refusal(ErrorCode(code))


def grid_of(value: Value) -> Value:
    """An argument as a range; a single error is refused."""
    refuse_errors(direct_errors(value))
    return value.as_range()


def decided(value: Value | None, default: float | None = None) -> int | None:
    """A whole number that decides on the shape; the default where it is left out or empty."""
    if value is None or same_in_all_trials(flattened(value.kinds == BLANK, value)).all():
        return None if default is None else int(default)
    numbers, errors = if_blank(value).to_numbers()
    refuse_errors(first_errors(flattened(errors, value)))
    if value.numbers.ndim == 3 and value.shape[1:] != (1, 1):
        raise Refusal(ErrorCode.CALC)  # each of many numbers would make an array of its own
    return int(np.trunc(same_in_all_trials(flattened(numbers, value))[0]))


def kept(mask: Bools) -> Indices:
    """The indices that are kept: (n, k) -> (n, as many as are TRUE).

    Raises:
        ShapeVaries: as many differ between trials.
        Refusal: there are none.
    """
    count = int(same_in_all_trials(mask.sum(axis=1)))
    if count == 0:
        raise Refusal(ErrorCode.CALC)
    return np.argsort(~mask, axis=1, kind="stable")[:, :count]


@array_function(
    "SEQUENCE", Anything, Anything(default=None), Anything(default=None), Anything(default=None), sized_by_numbers=True
)
def sequence(rows: Value, columns: Value | None = None, start: Value | None = None, step: Value | None = None) -> Value:
    """Numbers from `start` on by `step`, row by row."""
    r, c = decided(rows, 1), decided(columns, 1)
    assert r is not None and c is not None  # noqa: PT018 - they have defaults
    if not (0 <= r <= MAX_ROW and 0 <= c <= MAX_COLUMN):
        raise Refusal(ErrorCode.VALUE)
    if 0 in (r, c):
        raise Refusal(ErrorCode.CALC)
    first, by = _number(start), _number(step)
    ask_for_cells(max(first.shape[0], by.shape[0]), r, c)
    return Value.of_numbers(first + by * np.arange(float(r * c)).reshape(1, r, c))


def _number(value: Value | None) -> Floats:
    """A single number, (n, 1, 1); 1 by default."""
    if value is None:
        return np.ones((1, 1, 1))
    numbers, errors = if_blank(value.as_range(), 1.0).to_numbers()
    refuse_errors(errors[:, 0, 0])
    return numbers[:, :1, :1]


@array_function("TAKE", Arrays, Number, Number(default=None), sized_by_numbers=True)
def take(array: Value, rows: Value, columns: Value | None = None) -> Value:
    """The first rows and columns, or with negative numbers the last."""
    grid = grid_of(array)
    r, c = (_taken(decided(number)) for number in (rows, columns))
    return each_part(grid, lambda part: part[:, r, c])


def _taken(count: int | None) -> slice:
    if count == 0:
        raise Refusal(ErrorCode.CALC)
    if count is None:
        return slice(None)
    return slice(count) if count > 0 else slice(count, None)


@array_function("DROP", Arrays, Number, Number(default=None), sized_by_numbers=True)
def drop(array: Value, rows: Value, columns: Value | None = None) -> Value:
    """All but the first rows and columns, or with negative numbers but the last."""
    grid = grid_of(array)
    r, c = (_left(decided(number), size) for number, size in zip((rows, columns), grid.shape[1:], strict=True))
    return each_part(grid, lambda part: part[:, r, c])


def _left(count: int | None, size: int) -> slice:
    count = count or 0
    if abs(count) >= size:
        raise Refusal(ErrorCode.CALC)
    return slice(count, None) if count >= 0 else slice(count)


@array_function("CHOOSEROWS", Arrays, Arrays(repeat=True))
def choose_rows(array: Value, *numbers: Value) -> Value:
    """Rows by their numbers, from 1, or from -1 backwards; these may differ between trials."""
    grid = grid_of(array)
    rows = _chosen(numbers, grid.shape[1])
    ask_for_cells(max(grid.shape[0], rows.shape[0]), rows.shape[1], grid.shape[2])
    return picked(grid, rows[:, :, None], np.arange(grid.shape[2])[None, None, :])


@array_function("CHOOSECOLS", Arrays, Arrays(repeat=True))
def choose_columns(array: Value, *numbers: Value) -> Value:
    """Columns by their numbers, from 1, or from -1 backwards; these may differ between trials."""
    grid = grid_of(array)
    columns = _chosen(numbers, grid.shape[2])
    ask_for_cells(max(grid.shape[0], columns.shape[0]), grid.shape[1], columns.shape[1])
    return picked(grid, np.arange(grid.shape[1])[None, :, None], columns[:, None, :])


def _chosen(numbers: tuple[Value, ...], size: int) -> Indices:
    """Indices counted from 0: (n, m) of m numbers in any number of arguments."""
    n = max(value.shape[0] for value in numbers)
    wholes, errors = [], []
    for value in numbers:
        whole, found = whole_numbers(value)
        wholes.append(np.broadcast_to(whole, (n, *value.shape[1:])).reshape(n, -1))
        errors.append(np.broadcast_to(found, (n, *value.shape[1:])).reshape(n, -1))
    wanted = np.concatenate(wholes, axis=1)
    off = where_wrong((wanted == 0) | (np.abs(wanted) > size), ErrorCode.VALUE)
    refuse_errors(earliest(first_errors(np.concatenate(errors, axis=1)), first_errors(off)))
    return np.where(wanted > 0, wanted - 1, wanted + size).astype(np.intp)


@array_function("EXPAND", Arrays, Number, Number(default=None), Anything(default=None), sized_by_numbers=True)
def expand(array: Value, rows: Value, columns: Value | None = None, pad: Value | None = None) -> Value:
    """The array with rows and columns of `pad` added, up to so many; `#VALUE!` for fewer than there are."""
    grid = grid_of(array)
    r, c = (decided(number, size) for number, size in zip((rows, columns), grid.shape[1:], strict=True))
    assert r is not None and c is not None  # noqa: PT018 - they have defaults
    if r < grid.shape[1] or c < grid.shape[2] or r > MAX_ROW or c > MAX_COLUMN:
        raise Refusal(ErrorCode.VALUE)
    ask_for_cells(grid.shape[0], r, c)
    return _padded(grid, np.arange(r)[None, :, None], np.arange(c)[None, None, :], pad)


@array_function("VSTACK", Arrays(repeat=True))
def vstack(*arrays: Value) -> Value:
    """The arrays one below the other, the narrow ones filled up with `#N/A`."""
    return _stacked([value.as_range() for value in arrays])


@array_function("HSTACK", Arrays(repeat=True))
def hstack(*arrays: Value) -> Value:
    """The arrays side by side, the short ones filled up with `#N/A`."""
    return transposed(_stacked([transposed(value.as_range()) for value in arrays]))


def _stacked(grids: list[Value]) -> Value:
    n, c = max(grid.shape[0] for grid in grids), max(grid.shape[2] for grid in grids)
    ask_for_cells(n, sum(grid.shape[1] for grid in grids), c)
    columns = np.arange(c)[None, None, :]
    wide = [_padded(grid, np.arange(grid.shape[1])[None, :, None], columns, None) for grid in grids]
    tall = [each_part(grid, lambda part: np.broadcast_to(part, (n, *part.shape[1:]))) for grid in wide]
    return joined(tall, axis=1)


@array_function("TOCOL", Arrays, Number(default=0.0), Logical(default=False), sized_by_numbers=True)
def to_column(array: Value, ignore: Value | None = None, by_column: Value | None = None) -> Value:
    """All cells in one column, row by row or column by column; `ignore` is 1 for blanks, 2 for errors, 3 for both."""
    grid = grid_of(array)
    if decided(by_column, 0):
        grid = transposed(grid)
    column = each_part(grid, lambda part: part.reshape(part.shape[0], -1, 1))
    ignored = decided(ignore, 0)
    if ignored not in (0, 1, 2, 3):
        raise Refusal(ErrorCode.VALUE)
    blank, wrong = (column.kinds == BLANK) & (ignored in (1, 3)), (column.kinds >= ERROR) & (ignored in (2, 3))
    return picked(column, kept(~(blank | wrong)[:, :, 0])[:, :, None], np.zeros((1, 1, 1), np.intp))


@array_function("TOROW", Arrays, Number(default=0.0), Logical(default=False), sized_by_numbers=True)
def to_row(array: Value, ignore: Value | None = None, by_column: Value | None = None) -> Value:
    """All cells in one row, as `TOCOL` has them in one column."""
    return transposed(to_column(array, ignore, by_column))


@array_function("WRAPROWS", Arrays, Number, Anything(default=None), sized_by_numbers=True)
def wrap_rows(vector: Value, count: Value, pad: Value | None = None) -> Value:
    """A row or column laid out in rows of so many cells, the last filled up with `pad`."""
    grid, size = grid_of(vector), decided(count, 0)
    if 1 not in grid.shape[1:]:
        raise Refusal(ErrorCode.VALUE)
    if size is None or size < 1:
        raise Refusal(ErrorCode.NUM)
    row = each_part(grid, lambda part: part.reshape(part.shape[0], 1, -1))
    size = min(size, row.shape[2])
    indices = np.arange(-(-row.shape[2] // size) * size).reshape(1, -1, size)
    return _padded(row, np.zeros((1, 1, 1), np.intp), indices, pad)


@array_function("WRAPCOLS", Arrays, Number, Anything(default=None), sized_by_numbers=True)
def wrap_columns(vector: Value, count: Value, pad: Value | None = None) -> Value:
    """A row or column laid out in columns of so many cells, the last filled up with `pad`."""
    return transposed(wrap_rows(vector, count, pad))


def _padded(cells: Value, rows: Indices, columns: Indices, pad: Value | None) -> Value:
    """The cells at these indices, (1, r, c) together; the pad, or `#N/A`, where an index lies outside."""
    inside = (rows < cells.shape[1]) & (columns < cells.shape[2])
    found = picked(cells, np.minimum(rows, cells.shape[1] - 1), np.minimum(columns, cells.shape[2] - 1))
    missing = pad is None or bool((pad.kinds == BLANK).all())
    return choose(inside, found, constant(ErrorCode.NA) if pad is None or missing else pad)
