from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import ShapeVaries, Value, constant

DIV0, NA, REF, VALUE = ErrorCode.DIV0, ErrorCode.NA, ErrorCode.REF, ErrorCode.VALUE
GRID = [[1, "b", None], [4, True, DIV0]]

TABLE = [
    ((GRID, 1, 1), 1),
    ((GRID, 1, 2), "b"),
    ((GRID, 1, 3), None),
    ((GRID, 2, 2), True),
    ((GRID, 2, 3), DIV0),
    ((GRID, 2.9, "1"), 4),
    ((GRID, 3, 1), REF),
    ((GRID, 1, 4), REF),
    ((GRID, -1, 1), VALUE),
    ((GRID, 1, -0.5), [[1, "b", None]]),
    ((GRID, 0, 1), [[1], [4]]),
    ((GRID, None, 1), [[1], [4]]),
    ((GRID, 2, 0), [[4, True, DIV0]]),
    ((GRID, 2), [[4, True, DIV0]]),
    ((GRID, 0, 0), GRID),
    ((GRID, 3, 0), [[REF, REF, REF]]),
    (([[1, 2, 3]], 2), 2),
    (([[1, 2, 3]], 4), REF),
    (([[1], [2], [3]], 2), 2),
    (([[1], [2], [3]], 4), REF),
    (([[1], [2], [3]], 2, 2), REF),
    ((7, 1), 7),
    ((7, 1, 1), 7),
    ((GRID, 1, 1, 1), 1),
    ((GRID, 1, 1, 2), REF),
    ((GRID, 1, 1, 0), VALUE),
    ((GRID, "x", 1), VALUE),
    ((GRID, NA, DIV0), NA),
    ((GRID, 9, DIV0), DIV0),
    ((REF, NA), REF),
    ((GRID, [[2], [1]], 1), [[4], [1]]),
    ((GRID, [[2], [1]], [[2, 1]]), [[True, 4], ["b", 1]]),
]


@pytest.mark.parametrize(("arguments", "expected"), TABLE)
def test_table(evaluate, arguments, expected):
    result = evaluate("INDEX", *arguments)
    assert result == expected
    assert isinstance(result, bool) == isinstance(expected, bool)


def _numbers(*items):
    return Value.of_numbers(np.array(items, float))


def test_row_and_column_may_differ_between_trials(value):
    index = function_named("INDEX")
    assert index([value(GRID), _numbers(1, 2, 3), _numbers(2, 1, 1)]).objects().tolist() == ["b", 4, REF]
    assert index([value(GRID), constant(0), _numbers(1, 2)]).objects().tolist() == [[[1], [4]], [["b"], [True]]]


def test_so_may_the_cells():
    cells = Value.of_numbers(np.arange(12.0).reshape(3, 2, 2))
    result = function_named("INDEX")([cells, _numbers(1, 2, 1), _numbers(2, 1, 1)])
    assert result.numbers.tolist() == [1, 6, 8]


def test_a_cell_in_some_trials_and_a_column_in_others_have_no_one_shape(value):
    with pytest.raises(ShapeVaries):
        function_named("INDEX")([value(GRID), _numbers(0, 1), constant(1)])


DIV0_OF_REFERENCES, NA_OF_REFERENCES, NUM, REF_OF_REFERENCES, VALUE_OF_REFERENCES = (
    ErrorCode.DIV0,
    ErrorCode.NA,
    ErrorCode.NUM,
    ErrorCode.REF,
    ErrorCode.VALUE,
)

TABLE_OF_REFERENCES = [
    ("ROWS", ([[1, 2, 3], [4, 5, DIV0_OF_REFERENCES]],), 2),
    ("COLUMNS", ([[1, 2, 3], [4, 5, DIV0_OF_REFERENCES]],), 3),
    ("ROWS", (5,), 1),
    ("COLUMNS", (REF_OF_REFERENCES,), REF_OF_REFERENCES),
    ("HYPERLINK", ("http://a.b",), "http://a.b"),
    ("HYPERLINK", (5,), "5"),
    ("HYPERLINK", ("http://a.b", "here"), "here"),
    ("HYPERLINK", ("http://a.b", 12), 12),
    ("HYPERLINK", ("http://a.b", NA_OF_REFERENCES), NA_OF_REFERENCES),
    ("HYPERLINK", (NUM, "here"), NUM),
    ("ADDRESS", (2, 3), "$C$2"),
    ("ADDRESS", (2, 3, 2), "C$2"),
    ("ADDRESS", (2, 3, 3), "$C2"),
    ("ADDRESS", (2, 3, 4), "C2"),
    ("ADDRESS", (2, 3, 2, False), "R2C[3]"),
    ("ADDRESS", (2, 3, 3, False), "R[2]C3"),
    ("ADDRESS", (2, 3, 4, 0), "R[2]C[3]"),
    ("ADDRESS", (2, 3, 1, False, "[Book1]Sheet1"), "[Book1]Sheet1!R2C3"),
    ("ADDRESS", (2, 3, 1, False, "EXCEL SHEET"), "'EXCEL SHEET'!R2C3"),
    ("ADDRESS", (2, 3, 3, True, "[Book 1]Sheet1"), "'[Book 1]Sheet1'!$C2"),
    ("ADDRESS", (2, 3, 1, 1, "Bob's"), "'Bob''s'!$C$2"),
    ("ADDRESS", (2, 3, None, None, "S"), "S!$C$2"),
    ("ADDRESS", (2, 3, 1, 1, None), "!$C$2"),
    ("ADDRESS", (1048576.5, 16384, 4), "XFD1048576"),
    ("ADDRESS", (1048577, 1), VALUE_OF_REFERENCES),
    ("ADDRESS", (1, 16385), VALUE_OF_REFERENCES),
    ("ADDRESS", (0, 1), VALUE_OF_REFERENCES),
    ("ADDRESS", (1, 0), VALUE_OF_REFERENCES),
    ("ADDRESS", (1, 1, 5), VALUE_OF_REFERENCES),
    ("ADDRESS", (1, 1, 0), VALUE_OF_REFERENCES),
    ("ADDRESS", ("x", NA_OF_REFERENCES), VALUE_OF_REFERENCES),
    ("ADDRESS", (1, NA_OF_REFERENCES, DIV0_OF_REFERENCES), NA_OF_REFERENCES),
    ("ADDRESS", (1, 1, 1, "x"), VALUE_OF_REFERENCES),
    ("ADDRESS", (1, 1, 1, 1, DIV0_OF_REFERENCES), DIV0_OF_REFERENCES),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE_OF_REFERENCES)
def test_table_references(check, name, arguments, expected):
    check(name, arguments, expected)


def test_rows_and_columns_in_arrays(evaluate):
    assert evaluate("ADDRESS", [[1], [2]], [[1, 2]], 4) == [["A1", "B1"], ["A2", "B2"]]
