"""Of references as such: how many cells they have, how an address is written, what a link shows."""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from xlmc.address import MAX_COLUMN, MAX_ROW, column_letters, quote_sheet
from xlmc.errors import ErrorCode
from xlmc.functions.arguments import direct_errors, earliest, if_blank, leveled, with_errors
from xlmc.functions.per_element import per_element
from xlmc.functions.registry import Anything, Cells, Kind, Number, Text, excel
from xlmc.functions.values import Value, constant

__all__: list[str] = []

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
    return with_errors(Value.of_numbers(np.full(1, float(cells.as_range().shape[axis]))), direct_errors(cells))


@excel("HYPERLINK", Text, Anything(default=None), returns=Kind.ANY)
def hyperlink(link: Value, shown: Value | None = None) -> Value:
    """What the cell of a link shows: its second argument, or else the link."""
    if shown is not None:
        link, shown = leveled(link, shown)
        return with_errors(shown, np.broadcast_to(link.errors, link.shape))
    texts, errors = link.to_texts()
    return Value.of_texts(texts, errors)


@excel("ADDRESS", Number, Number, Number(default=1.0), Anything(default=True), Text(default=None), returns=Kind.TEXT)
def address(
    row: Value, column: Value, fixed: Value | None = None, a1: Value | None = None, sheet: Value | None = None
) -> Value:
    """The address of a cell as text. `fixed` is 1 for both, 2 for the row, 3 for the column, 4 for neither with a `$`.

    Without `a1` in the style R1C1. An argument left empty takes its default, but an empty `sheet` leaves its `!`.
    """
    row, column, *options = leveled(row, column, *(value for value in (fixed, a1, sheet) if value is not None))
    fixed_, a1_, sheet_ = [*options, *[constant(None)] * (3 - len(options))]
    numbers = [value.to_numbers() for value in (row, column, if_blank(fixed_, 1.0))]
    style, unclear = if_blank(a1_, 1.0).to_logicals()
    names, wrong = sheet_.to_texts()
    parts = [*(array for array, _ in numbers), style, None if sheet is None else names]
    return with_errors(per_element(_address)(*parts), earliest(*(found for _, found in numbers), unclear, wrong))


def _address(row: float, column: float, fixed: float, a1: bool, sheet: str | None) -> str | ErrorCode:
    row, column, fixed = int(row), int(column), int(fixed)
    if not (1 <= row <= MAX_ROW and 1 <= column <= MAX_COLUMN and 1 <= fixed <= 4):
        return ErrorCode.VALUE
    row_fixed, column_fixed = fixed in (1, 2), fixed in (1, 3)
    if a1:
        place = f"{'$' * column_fixed}{column_letters(column)}{'$' * row_fixed}{row}"
    else:
        place = f"R{row if row_fixed else f'[{row}]'}C{column if column_fixed else f'[{column}]'}"
    return place if sheet is None else f"{_quoted(sheet)}!{place}"


def _quoted(sheet: str) -> str:
    """The sheet's name as Excel writes it before an address; it may have its book's before it: `[Book1]Sheet1`."""
    found = _BOOK.fullmatch(sheet)
    book, name = found.groups() if found else ("", sheet)
    plain = (not name or quote_sheet(name) == name) and (not book or _PLAIN_BOOK.fullmatch(book) is not None)
    return sheet if plain else "'" + sheet.replace("'", "''") + "'"
