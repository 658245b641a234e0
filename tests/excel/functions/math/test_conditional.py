from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import NUMBER, Value, constant, from_objects

DIV0, NA, REF, VALUE = ErrorCode.DIV0, ErrorCode.NA, ErrorCode.REF, ErrorCode.VALUE

FRUIT = [["apples"], ["oranges"], ["peaches"], ["apples"]]
COUNTS = [[32], [54], [75], [86]]
PROPERTY = [[100000], [200000], [300000], [400000]]
COMMISSION = [[7000], [14000], [21000], [28000]]
QUANTITY = [[5], [4], [15], [3], [22], [12], [10], [33]]
PRODUCT = [["Apples"], ["Apples"], ["Artichokes"], ["Artichokes"], ["Bananas"], ["Bananas"], ["Carrots"], ["Carrots"]]
SELLER = [["Tom"], ["Sarah"]] * 4
GRADES = [[89], [93], [96], [85], [91], [88]]
WEIGHTS = [[1], [2], [2], [3], [1], [1]]

TABLE = [
    ("COUNTIF", (FRUIT, "apples"), 2),
    ("COUNTIF", (COUNTS, ">55"), 2),
    ("COUNTIF", (COUNTS, "<>75"), 3),
    ("COUNTIF", (FRUIT, "*"), 4),
    ("COUNTIF", (FRUIT, "?????es"), 2),
    ("COUNTIF", ([[NA, 1], [DIV0, NA]], NA), 2),
    ("COUNTIF", ([[None, "", 0]], ""), 2),
    ("COUNTIF", (REF, 1), REF),
    ("COUNTIF", (5, 5), 1),
    ("COUNTIFS", (COUNTS, ">=32", COUNTS, "<=75"), 3),
    ("COUNTIFS", (FRUIT, "apples", COUNTS, ">50"), 1),
    ("COUNTIFS", (FRUIT, "apples", [[1, 2]], ">50"), VALUE),
    ("COUNTIFS", (FRUIT, "apples", REF, ">50"), REF),
    ("SUMIF", (PROPERTY, ">160000", COMMISSION), 63000),
    ("SUMIF", (PROPERTY, ">160000"), 900000),
    ("SUMIF", (PROPERTY, 300000, COMMISSION), 21000),
    ("SUMIF", ([["a"], ["b"], ["a"]], "a", [[1], [DIV0], [True]]), 1),
    ("SUMIF", ([["a"], ["b"]], "b", [[1], [DIV0]]), DIV0),
    ("SUMIF", ([["a"], ["b"]], "z", [[1], [DIV0]]), 0),
    ("SUMIF", ([["a"], ["b"]], "a", [[1, 5], [2, 5], [3, 5]]), 1),
    ("SUMIF", ([["a"], ["b"]], "b", [[1]]), 0),
    ("SUMIF", ([["a"], ["b"]], "z", REF), REF),
    ("SUMIF", ([["a"], ["b"]], "a", 7), 7),
    ("SUMIFS", (QUANTITY, PRODUCT, "=A*", SELLER, "Tom"), 20),
    ("SUMIFS", (QUANTITY, PRODUCT, "<>Bananas", SELLER, "Tom"), 30),
    ("SUMIFS", (QUANTITY, PRODUCT, "A*", [[1]], "Tom"), VALUE),
    ("AVERAGEIF", (COMMISSION, "<23000"), 14000),
    ("AVERAGEIF", (PROPERTY, "<95000"), DIV0),
    ("AVERAGEIF", (PROPERTY, ">250000", COMMISSION), 24500),
    ("AVERAGEIF", ([[True], [None]], "<>", [["x"], [3]]), DIV0),
    ("AVERAGEIFS", (GRADES, GRADES, ">70", GRADES, "<90"), (89 + 85 + 88) / 3),
    ("AVERAGEIFS", (GRADES, GRADES, ">95", WEIGHTS, 1), DIV0),
    ("MAXIFS", (GRADES, WEIGHTS, 1), 91),
    ("MAXIFS", (GRADES, WEIGHTS, 4), 0),
    ("MAXIFS", (GRADES, WEIGHTS, ">1", GRADES, "<96"), 93),
    ("MINIFS", (GRADES, WEIGHTS, 1), 88),
    ("MINIFS", (GRADES, WEIGHTS, "a"), 0),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected)


def test_criteria_in_an_array_give_an_array(evaluate):
    assert evaluate("SUMIFS", QUANTITY, PRODUCT, [["Apples", "Carrots"]], SELLER, "Tom") == [[5, 10]]
    assert evaluate("COUNTIFS", FRUIT, [["apples"], ["peaches"]], COUNTS, [[">80", "<80"]]) == [[1, 1], [0, 1]]
    assert evaluate("SUMIF", FRUIT, [["apples", "pears"]], COUNTS) == [[118, 0]]
    assert evaluate("SUMIF", FRUIT, [["apples", "pears"]], REF) == [[REF, REF]]


def test_a_criterion_without_its_range_is_refused(evaluate):
    assert evaluate("COUNTIFS", FRUIT, "apples", COUNTS) == VALUE


def test_criteria_and_cells_of_their_own_in_many_trials():
    n, k = 36_000, 64
    rng = np.random.default_rng(1)
    x, y = rng.integers(0, 9, (n, k)) * 1.0, rng.random((1, k))
    bounds = rng.integers(0, 9, n) * 1.0
    criterion = np.array([f">={bound:g}" for bound in bounds], object)
    cells = Value(x[:, None, :], np.zeros((1, 1, 1), np.uint8))
    function = function_named("SUMIFS")
    result = function([Value(y[:, None, :], np.zeros((1, 1, 1), np.uint8)), cells, from_objects(criterion)])
    expected = np.where(x >= bounds[:, None], y, 0.0).cumsum(axis=1)[:, -1]
    assert result.shape == (n,)
    assert np.array_equal(result.numbers, expected)
    assert (result.kinds == NUMBER).all()


def test_many_trials_come_in_portions_and_in_their_order():
    x = np.arange(3_000_000, dtype=float).reshape(-1, 1, 3)
    result = function_named("COUNTIF")([Value(x, np.zeros((1, 1, 1), np.uint8)), constant("<7")])
    assert result.shape == (1_000_000,)
    assert result.numbers[:4].tolist() == [3, 3, 1, 0]
    assert not result.numbers[4:].any()


few = st.sampled_from([0.0, 1.0, 2.0, "a", "B", "2", "", True, None, DIV0])
wanted = st.sampled_from([1.0, "a", ">0", "<>a", "*", "", "=", None, True, DIV0])


@pytest.mark.parametrize("name", ["SUMIFS", "COUNTIFS", "AVERAGEIFS", "MAXIFS", "SUMIF"])
@settings(max_examples=60)
@given(data=st.data())
def test_trials_together_are_the_trials_alone(name, data):
    def drawn(strategy, *shape):
        box = np.empty((data.draw(st.sampled_from([1, 3])), *shape), object)
        box.ravel()[:] = data.draw(st.lists(strategy, min_size=box.size, max_size=box.size))
        return from_objects(box)

    pairs = [drawn(few, 3, 1), drawn(wanted, *data.draw(st.sampled_from([(), (1, 2)])))]
    more = [drawn(few, 3, 1), drawn(wanted)]
    arguments = {"COUNTIFS": pairs + more, "SUMIF": [*pairs, drawn(few, 2, 2)]}.get(name, [drawn(few, 3, 1), *pairs])
    function = function_named(name)
    together = function(arguments).objects()
    for i in range(3):
        alone = function([argument.take(np.array([i])) for argument in arguments]).objects()[0]
        assert np.array_equal(together[i if len(together) == 3 else 0], alone)
