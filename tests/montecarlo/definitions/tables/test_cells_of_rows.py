from __future__ import annotations

import pytest

from xlmc.errors import DefinitionError, ErrorCode
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.reserved_tables import definition_tables
from xlmc.montecarlo.definitions.tables.table_rows import (
    logical,
    number,
    optional_text,
    parameter,
    required_text,
    rows_of,
    static_value,
)

HERE = Cell("S", 2, 2)


@pytest.fixture
def row_with(make_book, blocks):
    """A table row whose column `Thing`, in S!B2, holds the value."""

    def row(value):
        book = make_book(blocks("S!A1", [["Name", "Thing"], ["a", value]]), [("xlmc_filters", "S!A1:B2")])
        findings = Findings()
        (only,) = rows_of(book, definition_tables(book, findings)["xlmc_filters"], (), (), findings)
        return only

    return row


@pytest.mark.parametrize(
    ("reader", "value", "expected"),
    [
        (number, 12, 12.0),
        (number, ("=6*2", 12.0), 12.0),
        (number, None, None),
        (number, "  ", None),
        (number, ('=IF(A1,B1,"")', ""), None),
        (parameter, 12, 12.0),
        (parameter, ("=6*2", 12.0), HERE),
        (parameter, "=6*2", HERE),
        (parameter, ("=RiskUniform(1,2)", ErrorCode.NAME), HERE),
        (parameter, None, None),
        (parameter, ('=IF(A1,B1,"")', ""), None),
        (optional_text, None, ""),
        (optional_text, " lb ", "lb"),
        (optional_text, 12, "12"),
        (optional_text, True, "TRUE"),
        (optional_text, ("=A1", "lb"), "lb"),
        (required_text, "lb", "lb"),
        (logical, None, False),
        (logical, True, True),
        (logical, False, False),
        (logical, ("=1=1", True), True),
        (logical, "Yes", True),
        (logical, " TRUE ", True),
        (logical, "no", False),
        (logical, "False", False),
    ],
)
def test_what_a_cell_means(row_with, reader, value, expected):
    result = reader(row_with(value), "thing")
    assert result == expected
    assert type(result) is type(expected)


def test_a_column_that_is_not_there_is_blank(row_with):
    row = row_with(1)
    assert number(row, "Other") is None
    assert parameter(row, "Other") is None
    assert optional_text(row, "Other") == ""
    assert logical(row, "Other") is False


@pytest.mark.parametrize(
    ("reader", "value", "message", "hint"),
    [
        (number, "about 5", "Thing holds the text 'about 5', not a number", "Type a number"),
        (number, "1,234.5", "Thing holds the text '1,234.5', not a number", "Type it again as a number"),
        (number, True, "Thing holds TRUE, not a number", "Type a number"),
        (number, ErrorCode.DIV0, "Thing holds the error #DIV/0!", "Correct the cell"),
        (number, ("=1/0", ErrorCode.DIV0), "Thing holds the error #DIV/0!", "what it depends on"),
        (number, "=A1", "Thing has never been calculated", "Open the workbook in Excel"),
        (parameter, "low", "Thing holds the text 'low', not a number", "Type a number"),
        (parameter, ("=A1", "low"), "Thing holds the text 'low', not a number", "Type a number"),
        (parameter, ErrorCode.NAME, "Thing holds the error #NAME?", "Correct the cell"),
        (parameter, ("=NA()", ErrorCode.NA), "Thing holds the error #N/A", "Correct the cell"),
        (parameter, ("=1=1", True), "Thing holds TRUE, not a number", "Type a number"),
        (optional_text, ErrorCode.NAME, "Thing holds the error #NAME?", "Correct the cell"),
        (optional_text, "=A1", "Thing has never been calculated", "Open the workbook in Excel"),
        (required_text, None, "Thing is blank", "Fill in thing, or clear the whole row"),
        (logical, "perhaps", "Thing holds 'perhaps', neither TRUE nor FALSE", "Type TRUE or FALSE"),
        (logical, 1, "Thing holds '1', neither TRUE nor FALSE", "Type TRUE or FALSE"),
        (logical, ErrorCode.REF, "Thing holds the error #REF!", "Correct the cell"),
        (logical, "=A1", "Thing has never been calculated", "run xlmc calculate"),
        (number, "-5,25", "Thing holds the text '-5,25', not a number", "such as -5.25"),
    ],
)
def test_what_a_cell_must_not_hold(row_with, reader, value, message, hint):
    with pytest.raises(DefinitionError) as caught:
        reader(row_with(value), "thing")
    assert caught.value.message == message
    assert caught.value.where == "S!B2"
    assert hint in caught.value.hint


def test_static_values(make_book):
    cells = {"S!A1": 3, "S!A2": ("=A1", 4.0), "S!A3": "=A1", "S!A4": ("=A1", ErrorCode.NA), "S!A5": ("=A1", True)}
    book = make_book(cells)
    assert static_value(2.5, book) == 2.5
    assert static_value(None, book) is None
    assert [static_value(Cell("S", row, 1), book) for row in range(1, 6)] == [3.0, 4.0, None, None, None]
