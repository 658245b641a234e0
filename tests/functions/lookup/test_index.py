from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.functions.families import function_named
from xlmc.functions.values import ShapeVaries, Value, constant

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
    found = evaluate("INDEX", *arguments)
    assert found == expected
    assert isinstance(found, bool) == isinstance(expected, bool)


def _numbers(*items):
    return Value.of_numbers(np.array(items, float))


def test_row_and_column_may_differ_between_trials(value):
    index = function_named("INDEX")
    assert index([value(GRID), _numbers(1, 2, 3), _numbers(2, 1, 1)]).objects().tolist() == ["b", 4, REF]
    assert index([value(GRID), constant(0), _numbers(1, 2)]).objects().tolist() == [[[1], [4]], [["b"], [True]]]


def test_so_may_the_cells():
    cells = Value.of_numbers(np.arange(12.0).reshape(3, 2, 2))
    found = function_named("INDEX")([cells, _numbers(1, 2, 1), _numbers(2, 1, 1)])
    assert found.numbers.tolist() == [1, 6, 8]


def test_a_cell_in_some_trials_and_a_column_in_others_have_no_one_shape(value):
    with pytest.raises(ShapeVaries):
        function_named("INDEX")([value(GRID), _numbers(0, 1), constant(1)])
