"""INDEX, and functions that count the cells of a reference, write an address, or show a link."""

from __future__ import annotations

import re
from typing import Any, Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.address import MAX_COLUMN, MAX_ROW, column_letters, quote_sheet
from xlmc.excel.functions.arguments import (
    align_ranges,
    error_where,
    errors_unless_range,
    fill_blanks,
    first_error,
    require_same_in_all_trials,
    whole_numbers,
    with_errors,
)
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.lookup.picked_cells import Indices, cell_of, pick
from xlmc.excel.functions.per_element import per_element
from xlmc.excel.functions.registry import Anything, Arrays, Cells, Kind, Number, Ranges, Text, excel
from xlmc.excel.functions.values import Codes, Floats, Value, constant

__all__: list[str] = []

_NUMBER = Number(ranges=Ranges.SINGLE)


@excel(
    "INDEX",
    Arrays,
    _NUMBER,
    _NUMBER(default=None),
    _NUMBER(default=1.0),
    returns=Kind.ANY,
    facts=Facts(spills=True, jumps=True),
)
def index(cells: Value, row: Value, column: Value | None = None, area: Value | None = None) -> Value:
    """Return the cell in a row and a column; row 0 stands for a whole column, column 0 for a whole row.

    With one number, it is the column of a single row, and else the row. The only area here is area 1: references of
    several areas, and one number for a reference of several rows and columns, are handled where formulas are lowered.

    Raises:
        ShapeVaries: some trials ask for a cell and some for a whole row or column.
    """
    grid = cells.as_range()
    row, column = (row, column) if column is not None else _read_one_number(row, grid)
    row, column, area = align_ranges(row, column, constant(1) if area is None else area)
    (rows, wrong_row), (columns, wrong_column), (areas, wrong_area) = map(whole_numbers, (row, column, area))
    row_indices, off_rows = _find_indices(rows, wrong_row, grid.shape[1], axis=1)
    column_indices, off_columns = _find_indices(columns, wrong_column, grid.shape[2], axis=2)
    no_area = first_error(error_where(areas < 1, ErrorCode.VALUE), error_where(areas > 1, ErrorCode.REF))
    codes = (errors_unless_range(cells), wrong_row, wrong_column, wrong_area, off_rows, off_columns, no_area)
    many = max(row_indices.ndim, column_indices.ndim) == 3
    indices = [_spread(indices, many) for indices in (row_indices, column_indices)]
    value = with_errors(pick(grid, *indices), first_error(*(_spread(part, many) for part in codes)))
    return cell_of(value, 0, 0) if cells.numbers.ndim == 1 else value


def _read_one_number(number: Value, grid: Value) -> tuple[Value, Value]:
    """Return row and column where only one number is given."""
    _, rows, columns = grid.shape
    if rows == 1 and columns > 1:
        return constant(1), number
    return number, constant(1 if columns == 1 else 0)


def _find_indices(numbers: Floats, errors: Codes, size: int, axis: int) -> tuple[Indices, Codes]:
    """Return indices counted from 0, and errors for those outside the range; for the number 0, all along the axis."""
    if numbers.ndim == 1 and require_same_in_all_trials((numbers == 0) & (errors == 0)):
        return np.arange(size).reshape(1, *(size if a == axis else 1 for a in (1, 2))), np.zeros(1, np.uint8)
    off = first_error(error_where(numbers < 1, ErrorCode.VALUE), error_where(numbers > size, ErrorCode.REF))
    off = np.where(errors > 0, np.uint8(0), off)
    sound = (off == 0) & (errors == 0)
    return np.where(sound, numbers - 1, 0).astype(np.intp), off


def _spread(array: Any, many: bool) -> Any:
    """Turn (n,) into (n, 1, 1) if the result is many cells."""
    return array.reshape(-1, 1, 1) if many and array.ndim == 1 else array


_BOOK: Final = re.compile(r"(\[[^\[\]]*\])(.*)", re.DOTALL)
_PLAIN_BOOK: Final = re.compile(r"\[[\w.]+\]")


@excel("ROWS", Cells)
def rows(cells: Value) -> Value:
    """How many rows the range has."""
    return _size(cells, 1)


@excel("COLUMNS", Cells)
def columns(cells: Value) -> Value:
    """How many columns the range has."""
    return _size(cells, 2)


def _size(cells: Value, axis: int) -> Value:
    return with_errors(Value.of_numbers(np.full(1, float(cells.as_range().shape[axis]))), errors_unless_range(cells))


@excel("HYPERLINK", Text, Anything(default=None), returns=Kind.ANY)
def hyperlink(link: Value, shown: Value | None = None) -> Value:
    """Return the text that the cell of a link shows: its second argument, or else the link."""
    if shown is not None:
        link, shown = align_ranges(link, shown)
        return with_errors(shown, np.broadcast_to(link.errors, link.shape))
    texts, errors = link.to_texts()
    return Value.of_texts(texts, errors)


@excel("ADDRESS", Number, Number, Number(default=1.0), Anything(default=True), Text(default=None), returns=Kind.TEXT)
def address(
    row: Value, column: Value, fixed: Value | None = None, a1: Value | None = None, sheet: Value | None = None
) -> Value:
    """Return the address of a cell as text. `fixed` says where a `$` stands: 1 both, 2 the row, 3 the column, 4
    neither.

    If `a1` is FALSE, the style is R1C1. Arguments left empty take their defaults, but an empty `sheet` leaves its `!`.
    """
    row, column, *options = align_ranges(row, column, *(value for value in (fixed, a1, sheet) if value is not None))
    fixed_, a1_, sheet_ = [*options, *[constant(None)] * (3 - len(options))]
    numbers = [value.to_numbers() for value in (row, column, fill_blanks(fixed_, 1.0))]
    style, unclear = fill_blanks(a1_, 1.0).to_logicals()
    names, wrong = sheet_.to_texts()
    parts = [*(array for array, _ in numbers), style, None if sheet is None else names]
    return with_errors(
        per_element(_write_address)(*parts), first_error(*(values for _, values in numbers), unclear, wrong)
    )


def _write_address(row: float, column: float, fixed: float, a1: bool, sheet: str | None) -> str | ErrorCode:
    row, column, fixed = int(row), int(column), int(fixed)
    if not (1 <= row <= MAX_ROW and 1 <= column <= MAX_COLUMN and 1 <= fixed <= 4):
        return ErrorCode.VALUE
    row_fixed, column_fixed = fixed in (1, 2), fixed in (1, 3)
    if a1:
        written = f"{'$' * column_fixed}{column_letters(column)}{'$' * row_fixed}{row}"
    else:
        written = f"R{row if row_fixed else f'[{row}]'}C{column if column_fixed else f'[{column}]'}"
    return written if sheet is None else f"{_quote(sheet)}!{written}"


def _quote(sheet: str) -> str:
    """Write a sheet's name as Excel does before an address; a book's name may come first: `[Book1]Sheet1`."""
    match = _BOOK.fullmatch(sheet)
    book, name = match.groups() if match else ("", sheet)
    plain = (not name or quote_sheet(name) == name) and (not book or _PLAIN_BOOK.fullmatch(book) is not None)
    return sheet if plain else "'" + sheet.replace("'", "''") + "'"
