from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import ShapeVaries, Value, constant

CALC, DIV0, NA, NUM, REF, VALUE = (ErrorCode[name] for name in ("CALC", "DIV0", "NA", "NUM", "REF", "VALUE"))
GRID = [[1, "b", None], [4, True, DIV0]]
LETTERS = [["a", "b", "c", "d", "e"]]

TABLE = [
    ("SEQUENCE", (2,), [[1], [2]]),
    ("SEQUENCE", (2, 3), [[1, 2, 3], [4, 5, 6]]),
    ("SEQUENCE", (1, 3, 10), [[10, 11, 12]]),
    ("SEQUENCE", (2, 2, 5, -5), [[5, 0], [-5, -10]]),
    ("SEQUENCE", (2.9, None, None, 2), [[1], [3]]),
    ("SEQUENCE", (0,), CALC),
    ("SEQUENCE", (1, 0), CALC),
    ("SEQUENCE", (-1,), VALUE),
    ("SEQUENCE", (1048577,), VALUE),
    ("SEQUENCE", (1, -1), VALUE),
    ("SEQUENCE", (1, 16385), VALUE),
    ("SEQUENCE", (-1, 0), VALUE),
    ("SEQUENCE", (0, -1), VALUE),
    ("SEQUENCE", ("x",), VALUE),
    ("SEQUENCE", (NUM, NA), NUM),
    ("SEQUENCE", (2, 1, 1, NA), NA),
    ("TAKE", (GRID, 1), [[1, "b", None]]),
    ("TAKE", (GRID, -1), [[4, True, DIV0]]),
    ("TAKE", (GRID, None, 2), [[1, "b"], [4, True]]),
    ("TAKE", (GRID, None, -1), [[None], [DIV0]]),
    ("TAKE", (GRID, 9, -9), GRID),
    ("TAKE", (GRID, 1, 1), [[1]]),
    ("TAKE", (GRID, 0), CALC),
    ("TAKE", (GRID, 1, 0), CALC),
    ("TAKE", (GRID, "x"), VALUE),
    ("TAKE", (REF, 1), REF),
    ("DROP", (GRID, 1), [[4, True, DIV0]]),
    ("DROP", (GRID, -1), [[1, "b", None]]),
    ("DROP", (GRID, None, 2), [[None], [DIV0]]),
    ("DROP", (GRID, 0, -2), [[1], [4]]),
    ("DROP", (GRID, 2), CALC),
    ("DROP", (GRID, 1, -3), CALC),
    ("CHOOSEROWS", (GRID, 2, 1, 2), [GRID[1], GRID[0], GRID[1]]),
    ("CHOOSEROWS", (GRID, [[-1, 1]]), [GRID[1], GRID[0]]),
    ("CHOOSEROWS", (GRID, 3), VALUE),
    ("CHOOSEROWS", (GRID, 0), VALUE),
    ("CHOOSEROWS", (GRID, 9, NA), NA),
    ("CHOOSECOLS", (GRID, 1, -1), [[1, None], [4, DIV0]]),
    ("CHOOSECOLS", (GRID, [[2], [2]]), [["b", "b"], [True, True]]),
    ("CHOOSECOLS", (GRID, -4), VALUE),
    ("EXPAND", (GRID, 3), [*GRID, [NA, NA, NA]]),
    ("EXPAND", (GRID, None, 4, "-"), [[*GRID[0], "-"], [*GRID[1], "-"]]),
    ("EXPAND", (1, 1, 2, 0), [[1, 0]]),
    ("EXPAND", (GRID, 1), VALUE),
    ("EXPAND", (GRID, 2, 2), VALUE),
    ("VSTACK", ([[1, 2]], [["x"]], 3), [[1, 2], ["x", NA], [3, NA]]),
    ("HSTACK", ([[1], [2]], [["x", True]], 3), [[1, "x", True, 3], [2, NA, NA, NA]]),
    ("TOCOL", (GRID,), [[1], ["b"], [None], [4], [True], [DIV0]]),
    ("TOCOL", (GRID, 1), [[1], ["b"], [4], [True], [DIV0]]),
    ("TOCOL", (GRID, 2, True), [[1], [4], ["b"], [True], [None]]),
    ("TOCOL", (GRID, 3), [[1], ["b"], [4], [True]]),
    ("TOCOL", (GRID, 4), VALUE),
    ("TOCOL", ([[None, None]], 1), CALC),
    ("TOROW", (GRID, 3, True), [[1, 4, "b", True]]),
    ("WRAPROWS", (LETTERS, 2), [["a", "b"], ["c", "d"], ["e", NA]]),
    ("WRAPROWS", (LETTERS, 2, "-"), [["a", "b"], ["c", "d"], ["e", "-"]]),
    ("WRAPROWS", (LETTERS, 9), LETTERS),
    ("WRAPROWS", (LETTERS, 0), NUM),
    ("WRAPROWS", (GRID, 2), VALUE),
    ("WRAPCOLS", ([["a"], ["b"], ["c"]], 2), [["a", "c"], ["b", NA]]),
    ("WRAPCOLS", (LETTERS, -1), NUM),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(evaluate, name, arguments, expected):
    assert evaluate(name, *arguments) == expected


def _numbers(*items):
    return Value.of_numbers(np.array(items, float))


VARYING = Value.of_numbers(np.arange(12.0).reshape(2, 3, 2))


def test_what_does_not_decide_on_the_shape_may_differ_between_trials():
    result = function_named("SEQUENCE")([constant(1), constant(2), _numbers(1, 5), _numbers(1, 2)])
    assert result.numbers.tolist() == [[[1, 2]], [[5, 7]]]
    result = function_named("CHOOSEROWS")([VARYING, _numbers(1, 3), constant(-1)])
    assert result.numbers.tolist() == [[[0, 1], [4, 5]], [[10, 11], [10, 11]]]
    result = function_named("VSTACK")([VARYING, constant("x")]).objects()
    assert result.tolist() == [[[0, 1], [2, 3], [4, 5], ["x", NA]], [[6, 7], [8, 9], [10, 11], ["x", NA]]]


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("SEQUENCE", (_numbers(1, 2),)),
        ("SEQUENCE", (constant(1), constant(1), Value.of_numbers(np.array([1.0, np.nan])))),
        ("TAKE", (VARYING, _numbers(1, 2))),
        ("DROP", (VARYING, constant(1), _numbers(0, 1))),
        ("CHOOSECOLS", (VARYING, _numbers(1, 5))),
        ("EXPAND", (VARYING, _numbers(4, 5))),
        ("TOCOL", (VARYING, _numbers(0, 1))),
        ("WRAPROWS", (constant(1), _numbers(4, 5))),
    ],
)
def test_what_decides_on_the_shape_may_not(name, arguments):
    with pytest.raises(ShapeVaries):
        function_named(name)(list(arguments))


def test_blanks_that_are_as_many_in_each_trial_leave_one_shape():
    kinds = np.array([[0, 3, 0], [3, 0, 0]], np.uint8)[:, None, :]
    cells = Value(np.arange(6.0).reshape(2, 1, 3), kinds)
    assert function_named("TOROW")([cells, constant(1)]).numbers.tolist() == [[[0, 2]], [[4, 5]]]
    with pytest.raises(ShapeVaries):
        function_named("TOROW")(
            [Value(cells.numbers, np.where(cells.numbers == 1, 3, 0).astype(np.uint8)), constant(1)]
        )
