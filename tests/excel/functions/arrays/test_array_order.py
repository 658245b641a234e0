from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import ShapeVaries, Value, constant, from_objects

CALC, DIV0, NA, NUM, REF, VALUE = (ErrorCode[name] for name in ("CALC", "DIV0", "NA", "NUM", "REF", "VALUE"))
SALES = [["East", "Tom", 6380], ["West", "Fred", 5619], ["East", "Amy", 4394], ["South", "Sal", 5544]]
JUMBLE = [[None], ["b"], [True], [2], [NA], ["A"], [False], [-1], [DIV0], ["a"]]

TABLE = [
    ("FILTER", (SALES, [[True], [False], [True], [False]]), [SALES[0], SALES[2]]),
    ("FILTER", (SALES, [[0], [2], [0], [0]]), [SALES[1]]),
    ("FILTER", (SALES, [["true"], [None], [False], [0]]), [SALES[0]]),
    ("FILTER", (SALES, [[True, False, True]]), [[row[0], row[2]] for row in SALES]),
    ("FILTER", (SALES, [[False]] * 4), CALC),
    ("FILTER", (SALES, [[False]] * 4, None), CALC),
    ("FILTER", (SALES, [[False]] * 4, "none"), [["none"]]),
    ("FILTER", (SALES, [[False]] * 4, [[1, 2]]), [[1, 2]]),
    ("FILTER", (SALES, [[True]] * 3), VALUE),
    ("FILTER", (SALES, [["x"]] * 4), VALUE),
    ("FILTER", (SALES, [[False], [NA], [DIV0], [True]], "none"), NA),
    ("FILTER", (REF, True), REF),
    ("SORT", ([[3], [1], [2]],), [[1], [2], [3]]),
    ("SORT", ([[3], [1], [2]], None, -1), [[3], [2], [1]]),
    ("SORT", ([[3, 1, 2]], 1, 1, True), [[1, 2, 3]]),
    ("SORT", (SALES, 3, -1), [SALES[0], SALES[1], SALES[3], SALES[2]]),
    ("SORT", (SALES, [[1, 3]], [[1, -1]]), [SALES[0], SALES[2], SALES[3], SALES[1]]),
    ("SORT", (SALES, [[1, 3]], 1), [SALES[2], SALES[0], SALES[3], SALES[1]]),
    ("SORT", (JUMBLE,), [[-1], [2], ["A"], ["a"], ["b"], [False], [True], [NA], [DIV0], [None]]),
    ("SORT", (JUMBLE, 1, -1), [[NA], [DIV0], [True], [False], ["b"], ["A"], ["a"], [2], [-1], [None]]),
    ("SORT", (SALES, 4), VALUE),
    ("SORT", (SALES, 0), VALUE),
    ("SORT", (SALES, 1, 2), VALUE),
    ("SORT", (SALES, [[1, 2]], [[1, 1, 1]]), VALUE),
    ("SORT", (SALES, NA, NUM), NA),
    ("SORTBY", (SALES, [[3], [1], [2], [1]], 1), [SALES[1], SALES[3], SALES[2], SALES[0]]),
    ("SORTBY", (SALES, [[3], [1], [2], [1]]), [SALES[1], SALES[3], SALES[2], SALES[0]]),
    ("SORTBY", (SALES, [[3], [1], [2], [1]], 1, [[1], [2], [3], [1]], 1), [SALES[3], SALES[1], SALES[2], SALES[0]]),
    ("SORTBY", (SALES, [[3], [1], [2], [1]], -1, [[1], [2], [3], [1]]), [SALES[0], SALES[2], SALES[3], SALES[1]]),
    ("SORTBY", ([["a", "b", "c"]], [[2, 3, 1]], -1), [["b", "a", "c"]]),
    ("SORTBY", (SALES, [[3], [1], [2]], 1), VALUE),
    ("SORTBY", (SALES, [[3], [1], [2], [1]], 0), VALUE),
    ("SORTBY", (SALES, NUM, 1), NUM),
    ("UNIQUE", ([[1], [2], [1], ["a"], ["A"], [None], [True]],), [[1], [2], ["a"], [None], [True]]),
    ("UNIQUE", ([[1], [2], [1], ["a"], ["A"]], False, True), [[2]]),
    ("UNIQUE", ([[1, 1], [1, 2], [1, 1]],), [[1, 1], [1, 2]]),
    ("UNIQUE", ([[1, 2, 1], [1, 2, 1]], True), [[1, 2], [1, 2]]),
    ("UNIQUE", ([[1], [1]], False, True), CALC),
    ("UNIQUE", ([[NA], [DIV0], [NA]],), [[NA], [DIV0]]),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(evaluate, name, arguments, expected):
    assert evaluate(name, *arguments) == expected


RANKS = {float: 0, str: 1, bool: 2, ErrorCode: 3}


def _key(item):
    return RANKS[type(item)], 0 if isinstance(item, ErrorCode) else item


cells = st.sampled_from([1.0, 2.0, -3.0, "a", "b", "", True, False, NA, DIV0, None])


@given(st.lists(st.lists(cells, min_size=6, max_size=6), min_size=1, max_size=3), st.booleans())
def test_sorted_as_python_sorts(trials, falling):
    box = np.empty((len(trials), 6, 1), object)
    box[:, :, 0] = np.array(trials, object)
    result = function_named("SORT")([from_objects(box), constant(1), constant(-1 if falling else 1)]).objects()
    for row, trial in zip(result, trials, strict=True):
        filled = [item for item in trial if item is not None]
        expected = sorted(filled, key=_key, reverse=falling)
        assert row[:, 0].tolist() == expected + [None] * (6 - len(filled))


X = np.array([[3.0, 1.0, 2.0], [5.0, 6.0, 4.0]])[:, :, None]
VARYING = Value.of_numbers(X)


def test_each_trial_in_its_own_order():
    assert function_named("SORT")([VARYING]).numbers[:, :, 0].tolist() == [[1, 2, 3], [4, 5, 6]]
    order = Value.of_numbers(np.array([1.0, -1.0]))
    assert function_named("SORT")([VARYING, constant(1), order]).numbers[:, :, 0].tolist() == [[1, 2, 3], [6, 5, 4]]
    column = Value.of_numbers(np.array([1.0, 2.0]))
    both = Value.of_numbers(np.concatenate([X, -X], axis=2))
    assert function_named("SORT")([both, column]).numbers[:, :, 0].tolist() == [[1, 2, 3], [6, 5, 4]]
    words = from_objects(np.array([[["x"], ["y"], ["z"]]], object))
    assert function_named("SORTBY")([words, VARYING]).objects()[:, :, 0].tolist() == [["y", "z", "x"], ["z", "x", "y"]]


def test_trials_that_keep_as_many_rows_have_one_shape():
    mask = Value.of_logicals(np.array([1.5, 4.5])[:, None, None] < X)
    assert function_named("FILTER")([VARYING, mask]).numbers[:, :, 0].tolist() == [[3, 2], [5, 6]]
    repeated = Value.of_numbers(np.array([[1.0, 1.0, 2.0], [4.0, 3.0, 4.0]])[:, :, None])
    assert function_named("UNIQUE")([repeated]).numbers[:, :, 0].tolist() == [[1, 2], [4, 3]]


def test_others_have_none():
    with pytest.raises(ShapeVaries):
        function_named("FILTER")([VARYING, Value.of_logicals(X > 2.5)])
    with pytest.raises(ShapeVaries):
        function_named("FILTER")([VARYING, Value.of_logicals(X > 3.5), constant("none")])
    with pytest.raises(ShapeVaries):
        function_named("UNIQUE")([Value.of_numbers(np.array([[1.0, 1.0], [1.0, 2.0]])[:, :, None])])


def test_wide_data_of_many_trials_come_in_portions():
    x = np.random.default_rng(5).random((50_000, 50, 1))
    x[:, 7] = x[:, 3]
    result = function_named("UNIQUE")([Value.of_numbers(x)])
    assert np.array_equal(result.numbers, np.delete(x, 7, axis=1))


@given(st.lists(st.tuples(cells, cells), min_size=1, max_size=6))
def test_unique_rows_as_a_dictionary_has_them(rows):
    named = [tuple((type(item), item) for item in row) for row in rows]
    result = function_named("UNIQUE")([from_objects(np.array([rows], object))]).objects()[0]
    assert [tuple((type(item), item) for item in row) for row in result.tolist()] == list(dict.fromkeys(named))


def test_filter_is_taken_trial_by_trial_where_what_stands_in_is_empty_in_some():
    instead = from_objects(np.array([None, "none"], object))
    none = from_objects(np.full((1, 2, 1), False, object))
    with pytest.raises(ShapeVaries):
        function_named("FILTER")([none, none, instead])
