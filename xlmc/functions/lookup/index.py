"""INDEX: the cell, row or column of a range."""

from __future__ import annotations

from typing import Any

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.functions.arguments import (
    direct_errors,
    earliest,
    leveled,
    same_in_all_trials,
    where_wrong,
    whole_numbers,
    with_errors,
)
from xlmc.functions.facts import Facts
from xlmc.functions.lookup.picking import Places, cell_of, picked
from xlmc.functions.registry import Arrays, Kind, Number, Ranges, excel
from xlmc.functions.values import Codes, Floats, Value, constant

__all__: list[str] = []


_NUMBER = Number(ranges=Ranges.SINGLE)


@excel(
    "INDEX",
    Arrays,
    _NUMBER,
    _NUMBER(default=None),
    _NUMBER(default=1.0),
    returns=Kind.ANY,
    facts=Facts(spills=True, finds=True),
)
def index(cells: Value, row: Value, column: Value | None = None, area: Value | None = None) -> Value:
    """The cell in a row and a column; row 0 stands for a whole column, column 0 for a whole row.

    Of a single row the second argument alone counts the columns. Of a single value, it gives a single value. Only one
    area is known here: area 1.

    Raises:
        ShapeVaries: some trials ask for a cell and some for a whole row or column.
    """
    grid = cells.as_range()
    row, column = (row, column) if column is not None else _alone(row, grid)
    row, column, area = leveled(row, column, constant(1) if area is None else area)
    (rows, wrong_row), (columns, wrong_column), (areas, wrong_area) = map(whole_numbers, (row, column, area))
    row_places, off_rows = _places(rows, wrong_row, grid.shape[1], axis=1)
    column_places, off_columns = _places(columns, wrong_column, grid.shape[2], axis=2)
    no_area = earliest(where_wrong(areas < 1, ErrorCode.VALUE), where_wrong(areas > 1, ErrorCode.REF))
    codes = (direct_errors(cells), wrong_row, wrong_column, wrong_area, off_rows, off_columns, no_area)
    many = max(row_places.ndim, column_places.ndim) == 3
    places = [_spread(places, many) for places in (row_places, column_places)]
    found = with_errors(picked(grid, *places), earliest(*(_spread(part, many) for part in codes)))
    return cell_of(found, 0, 0) if cells.numbers.ndim == 1 else found


def _alone(number: Value, grid: Value) -> tuple[Value, Value]:
    """Row and column where only one number is given."""
    _, rows, columns = grid.shape
    if rows == 1 and columns > 1:
        return constant(1), number
    return number, constant(1 if columns == 1 else 0)


def _places(numbers: Floats, errors: Codes, size: int, axis: int) -> tuple[Places, Codes]:
    """Places counted from 0, and where they are off the range; all places along the axis if the number is 0."""
    if numbers.ndim == 1 and same_in_all_trials((numbers == 0) & (errors == 0)):
        return np.arange(size).reshape(1, *(size if a == axis else 1 for a in (1, 2))), np.zeros(1, np.uint8)
    off = earliest(where_wrong(numbers < 1, ErrorCode.VALUE), where_wrong(numbers > size, ErrorCode.REF))
    off = np.where(errors > 0, np.uint8(0), off)
    sound = (off == 0) & (errors == 0)
    return np.where(sound, numbers - 1, 0).astype(np.intp), off


def _spread(array: Any, many: bool) -> Any:
    """(n,) as (n, 1, 1) where the result is many cells."""
    return array.reshape(-1, 1, 1) if many and array.ndim == 1 else array
