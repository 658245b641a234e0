from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.math.subtotal import Skips, aggregate, aggregate_skips, subtotal, subtotal_skips
from xlmc.excel.functions.values import ShapeVaries, Value, constant

DIV0, NA, NUM, VALUE = ErrorCode.DIV0, ErrorCode.NA, ErrorCode.NUM, ErrorCode.VALUE
CELLS = [[120], [10], [150], [23], ["x"], [None]]
WRONG = [[DIV0], [72], [30], [NUM], [31], [96], [32], [81], [33], [53], [34]]
TWIN = [[8], [20], [8]]

TABLE = [
    ("SUBTOTAL", (9, CELLS), 303),
    ("SUBTOTAL", (1, CELLS), 75.75),
    ("SUBTOTAL", (2, CELLS), 4),
    ("SUBTOTAL", (3, CELLS), 5),
    ("SUBTOTAL", (4, CELLS), 150),
    ("SUBTOTAL", (5, CELLS), 10),
    ("SUBTOTAL", (6, CELLS), 120 * 10 * 150 * 23),
    ("SUBTOTAL", (7, [[2], [4]]), 2**0.5),
    ("SUBTOTAL", (8, [[2], [4]]), 1),
    ("SUBTOTAL", (10, [[2], [4]]), 2),
    ("SUBTOTAL", (11, [[2], [4]]), 1),
    ("SUBTOTAL", (109, CELLS, [[7]]), 310),
    ("SUBTOTAL", (103.9, CELLS), 5),
    ("SUBTOTAL", (9, WRONG), DIV0),
    ("SUBTOTAL", ("9", CELLS), 303),
    ("SUBTOTAL", (0, CELLS), VALUE),
    ("SUBTOTAL", (12, CELLS), VALUE),
    ("SUBTOTAL", (112, CELLS), VALUE),
    ("SUBTOTAL", (NA, CELLS), NA),
    ("AGGREGATE", (4, 6, WRONG), 96),
    ("AGGREGATE", (14, 6, WRONG, 3), 72),
    ("AGGREGATE", (15, 6, WRONG), VALUE),
    ("AGGREGATE", (15, 6, WRONG, 1), 30),
    ("AGGREGATE", (12, 6, WRONG, [[5]]), 33.5),
    ("AGGREGATE", (4, 4, WRONG), DIV0),
    ("AGGREGATE", (9, 2, WRONG), 462),
    ("AGGREGATE", (2, 0, WRONG), 9),
    ("AGGREGATE", (3, 0, WRONG), 11),
    ("AGGREGATE", (3, 7, WRONG), 9),
    ("AGGREGATE", (13, 3, TWIN), 8),
    ("AGGREGATE", (16, 6, TWIN, 0.5), 8),
    ("AGGREGATE", (17, 6, TWIN, 4), 20),
    ("AGGREGATE", (18, 6, TWIN, 0.5), 8),
    ("AGGREGATE", (19, 6, TWIN, 2), 8),
    ("AGGREGATE", (14, 6, TWIN, 9), NUM),
    ("AGGREGATE", (14, 6, TWIN, NA), NA),
    ("AGGREGATE", (20, 0, TWIN), VALUE),
    ("AGGREGATE", (0, 0, TWIN), VALUE),
    ("AGGREGATE", (9, 8, TWIN), VALUE),
    ("AGGREGATE", (9, -1, TWIN), VALUE),
    ("AGGREGATE", (NA, NUM, TWIN), NA),
    ("AGGREGATE", (9, NUM, TWIN), NUM),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-15)


def test_ranks_in_an_array_give_an_array(evaluate):
    assert evaluate("AGGREGATE", 14, 6, WRONG, [[1, 2]]) == [[96, 81]]


def test_as_plain_functions(value):
    assert subtotal(9, [value(CELLS)]).numbers == 303
    assert aggregate(14, 6, [value(WRONG), constant(1)]).numbers == 96


@pytest.mark.parametrize(
    ("result", "nested", "filtered", "hidden"),
    [
        (subtotal_skips(9), True, True, False),
        (subtotal_skips(109), True, True, True),
        (aggregate_skips(0), True, False, False),
        (aggregate_skips(1), True, True, True),
        (aggregate_skips(2), True, False, False),
        (aggregate_skips(3), True, True, True),
        (aggregate_skips(4), False, False, False),
        (aggregate_skips(5), False, True, True),
        (aggregate_skips(6), False, False, False),
        (aggregate_skips(7), False, True, True),
    ],
)
def test_what_a_call_leaves_out(result, nested, filtered, hidden):
    assert result == Skips(nested, filtered, hidden)


def test_the_function_may_differ_between_trials(value):
    number = Value.of_numbers(np.array([9.0, 4.0, 99.0]))
    assert function_named("SUBTOTAL")([number, value(CELLS)]).objects().tolist() == [303, 150, VALUE]
    options = Value.of_numbers(np.array([6.0, 4.0, 9.0]))
    assert function_named("AGGREGATE")([constant(9), options, value(WRONG)]).objects().tolist() == [462, DIV0, VALUE]


def test_a_number_in_some_trials_and_an_array_in_others_have_no_one_shape(value):
    number = Value.of_numbers(np.array([14.0, 9.0]))
    with pytest.raises(ShapeVaries):
        function_named("AGGREGATE")([number, constant(6), value(TWIN), value([[1, 2]])])
