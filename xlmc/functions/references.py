"""Of references as such: how many cells they have, how an address is written, what a link shows."""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from xlmc.address import MAX_COLUMN, MAX_ROW, column_letters, quote_sheet
from xlmc.errors import ErrorCode
from xlmc.functions.per_element import per_element
from xlmc.functions.picking import direct_errors, earliest, if_blank, leveled, with_errors
from xlmc.functions.registry import Anything, Cells, Kind, Number, Text, excel
from xlmc.functions.values import BLANK, Floats, Value, constant

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
        return with_errors(shown, link.errors)
    texts, errors = link.to_texts()
    return Value.of_texts(texts, errors)


@excel("ADDRESS", Number, Number, Number(default=1.0), Anything(default=True), Text(default=None), returns=Kind.TEXT)
def address(
    row: Value, column: Value, fixed: Value | None = None, a1: Value | None = None, sheet: Value | None = None
) -> Value:
    """The address of a cell as text. `fixed` is 1 for both, 2 for the row, 3 for the column, 4 for neither with a `$`.

    Without `a1` in the style R1C1. An argument left empty takes its default, but an empty `sheet` leaves its `!`.
    """
