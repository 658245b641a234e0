from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.functions.families import function_named
from xlmc.functions.values import ShapeVaries, Value, constant, from_objects

DIV0, NA, NUM, REF, VALUE = ErrorCode.DIV0, ErrorCode.NA, ErrorCode.NUM, ErrorCode.REF, ErrorCode.VALUE

COUNTRY = [["China"], ["India"], ["United States"], ["Indonesia"], ["Brazil"]]
PREFIX = [[86], [91], [1], [62], [55]]
INCOME = [[9700], [39475], [84200], [160726], [204100], [510300]]
RATE = [[0.1], [0.22], [0.24], [0.32], [0.35], [0.37]]
FALLING = INCOME[::-1]
TWICE = [["a", "b", "a", "c"]]
SALES = [[42000], [35000], [25000], [15901], [13801], [12181], [9201]]

TABLE = [
    ("XLOOKUP", ("Brazil", COUNTRY, PREFIX), 55),
    ("XLOOKUP", ("Peru", COUNTRY, PREFIX), NA),
    ("XLOOKUP", ("Peru", COUNTRY, PREFIX, "none"), "none"),
    ("XLOOKUP", ("Peru", COUNTRY, PREFIX, None), NA),
    ("XLOOKUP", ("ind*", COUNTRY, PREFIX, "none"), "none"),
    ("XLOOKUP", ("ind*", COUNTRY, PREFIX, None, 2), 91),
    ("XLOOKUP", ("ind*", COUNTRY, PREFIX, None, 2, -1), 62),
    ("XLOOKUP", ("ind*", COUNTRY, PREFIX, None, 2, 2), VALUE),
    ("XLOOKUP", (46523, INCOME, RATE, 0, 1, 1), 0.24),
    ("XLOOKUP", (46523, INCOME, RATE, 0, 1, 2), 0.24),
    ("XLOOKUP", (46523, FALLING, RATE[::-1], 0, 1, -2), 0.24),
    ("XLOOKUP", (46523, FALLING, RATE[::-1], 0, -1, -2), 0.22),
    ("XLOOKUP", (46523, INCOME, RATE, 0, -1, 2), 0.22),
    ("XLOOKUP", (84200, FALLING, RATE[::-1], 0, 0, -2), 0.24),
    ("XLOOKUP", (84201, FALLING, RATE[::-1], 0, 0, -2), 0),
    ("XLOOKUP", (84200, INCOME, RATE, 0, 1, 2), 0.24),
    ("XLOOKUP", (600000, INCOME, RATE, "top", 1, 2), "top"),
    ("XLOOKUP", (46523, [[9700], ["xyz"], ["xyz"], [160726]], [[1], [2], [3], [4]], 0, 1, 2), 2),
    ("XLOOKUP", (1, INCOME, RATE, "free", -1), "free"),
    ("XLOOKUP", ("a", TWICE, [[1, 2, 3, 4]]), 1),
    ("XLOOKUP", ("a", TWICE, [[1, 2, 3, 4]], None, 0, -1), 3),
    ("XLOOKUP", ("a", TWICE, [[1, 2, 3, 4]], None, None, None), 1),
    ("XLOOKUP", ("a", TWICE, [[1, 2, 3]]), VALUE),
    ("XLOOKUP", ("a", [["a", "b"], ["c", "d"]], [[1, 2], [3, 4]]), VALUE),
    ("XLOOKUP", ("a", TWICE, [[1, 2, 3, 4]], None, 5), VALUE),
    ("XLOOKUP", ("a", TWICE, [[1, 2, 3, 4]], None, 0, 0), VALUE),
    ("XLOOKUP", ("a", TWICE, [[1, 2, 3, 4]], None, DIV0), DIV0),
    ("XLOOKUP", (NUM, TWICE, REF), NUM),
    ("XLOOKUP", ("a", TWICE, REF), REF),
    ("XLOOKUP", (None, [[1, None, 0]], [["x", "y", "z"]]), "y"),
    ("XLOOKUP", (1, [[1]], [[NA]], "none"), NA),
    ("XMATCH", (15000, SALES, -1), 5),
    ("XMATCH", (15000, SALES, 1), 4),
    ("XMATCH", (15000, SALES), NA),
    ("XMATCH", (25000, SALES), 3),
    ("XMATCH", ("gra?e", [["Apple", "Grape", "Pear"]], 2), 2),
    ("XMATCH", ("x", [["Apple"]], 2), NA),
    ("XMATCH", ("a", TWICE, 0, -1), 3),
    ("XMATCH", ("a", TWICE, None, None), 1),
    ("XMATCH", ("a", [["a", "b"], ["c", "d"]]), VALUE),
    ("XMATCH", (NUM, REF, 9), NUM),
    ("XMATCH", (1, REF, 9), REF),
    ("XMATCH", (1, [[1]], 9), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected)


def test_a_key_finds_a_whole_row_or_column(evaluate):
    wide = [["a", 1, 2], ["b", 3, 4]]
    assert evaluate("XLOOKUP", "y", [["x"], ["y"]], wide) == [["b", 3, 4]]
    assert evaluate("XLOOKUP", "y", [["x", "y"]], [["a", 1], ["b", 2]]) == [[1], [2]]
    assert evaluate("XLOOKUP", "z", [["x"], ["y"]], wide, "none") == "none"


def test_keys_in_an_array_give_an_array(evaluate):
    assert evaluate("XLOOKUP", [["y"], ["z"]], [["x"], ["y"]], [["a", 1], ["b", 2]], "none") == [["b"], ["none"]]
    assert evaluate("XMATCH", [["y", NUM]], [["x"], ["y"]]) == [[2, NUM]]


def test_keys_in_an_array_with_an_unknown_mode_are_errors_each(evaluate):
    assert evaluate("XLOOKUP", [[1.0, 2.0, NUM]], [[1.0]], [[3.0, 4.0, 5.0]], 0, 170) == [[VALUE, VALUE, NUM]]
    assert evaluate("XLOOKUP", [["x", "z"]], [["x"], ["y"]], [["a"], ["b"]], None, 2, -2) == [[VALUE, VALUE]]
    assert evaluate("XMATCH", [["y"], ["z"]], [["x"], ["y"]], 170) == [[VALUE], [VALUE]]


def _many(items):
    box = np.empty(len(items), object)
    box[:] = items
    return from_objects(box)


def test_a_row_found_in_some_trials_only_has_no_one_shape(value):
    function = function_named("XLOOKUP")
    arguments = [value([["x"], ["y"]]), value([["a", 1], ["b", 2]])]
    assert function([_many(["x", "y"]), *arguments]).objects().tolist() == [[["a", 1]], [["b", 2]]]
    assert function([_many(["v", "w"]), *arguments]).objects().tolist() == [NA, NA]
    with pytest.raises(ShapeVaries):
        function([_many(["x", "w"]), *arguments])


few = st.sampled_from([0.0, 1.0, 2.0, "a", "B", "b", True, None, DIV0])


@given(st.data())
def test_trials_together_are_the_trials_alone(data):
    def drawn(strategy, *shape):
        box = np.empty((data.draw(st.sampled_from([1, 3])), *shape), object)
        box.ravel()[:] = data.draw(st.lists(strategy, min_size=box.size, max_size=box.size))
        return from_objects(box)

    mode, direction = drawn(st.sampled_from([-1.0, 0.0, 1.0, 2.0])), drawn(st.sampled_from([1.0, -1.0, 2.0, -2.0]))
    key = drawn(st.sampled_from([-1.0, 0.0, 1.0, 1.5, "a", "?", True, None, NUM]))
    arguments = [key, drawn(few, 4, 1), drawn(few, 4, 1), drawn(few), mode, direction]
    function = function_named("XLOOKUP")
    together = np.broadcast_to(function(arguments).objects(), (3,)).tolist()
    alone = [function([argument.take(np.array([i])) for argument in arguments]).objects()[0] for i in range(3)]
    assert together == alone


def test_many_keys_in_lists_of_their_own():
    rng = np.random.default_rng(4)
    cells, wanted = rng.random((8192, 400)), rng.random(8192)
    kinds = np.zeros((1, 1, 1), np.uint8)
    found = function_named("XLOOKUP")(
        [
            Value(wanted, np.zeros(1, np.uint8)),
            Value(cells[:, :, None], kinds),
            Value(cells[:, :, None], kinds),
            constant(-1),
            constant(1),
        ]
    )
    expected = np.where(cells >= wanted[:, None], cells, np.inf).min(axis=1)
    assert np.array_equal(found.numbers, np.where(np.isinf(expected), -1, expected))
