from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value, constant, from_objects

DIV0, NA, NUM, VALUE = ErrorCode.DIV0, ErrorCode.NA, ErrorCode.NUM, ErrorCode.VALUE

ORCHARD = [
    ["Tree", "Height", "Age", "Yield", "Profit"],
    ["Apple", 18, 20, 14, 105],
    ["Pear", 12, 12, 10, 96],
    ["Cherry", 13, 14, 9, 105],
    ["Apple", 14, 15, 10, 75],
    ["Pear", 9, 8, 8, 77],
    ["Apple", 8, 9, 6, 45],
]
APPLES = [["Tree"], ["=Apple"]]
TALL_APPLES = [["Tree", "Height"], ["=Apple", ">10"]]
TALL_APPLES_OR_PEARS = [["Tree", "Height"], ["=Apple", ">10"], ["=Pear", None]]
BETWEEN = [["Tree", "Height", "Height"], ["=Apple", ">10", "<16"]]
ODD = [["a", "b"], ["x", 1], ["y", "text"], ["x", None], ["z", NA], ["xy", True]]

TABLE = [
    ("DSUM", (ORCHARD, "Profit", APPLES), 225),
    ("DSUM", (ORCHARD, "profit", BETWEEN), 75),
    ("DSUM", (ORCHARD, 5, APPLES), 225),
    ("DSUM", (ORCHARD, 5.9, APPLES), 225),
    ("DSUM", (ORCHARD, "Price", APPLES), VALUE),
    ("DSUM", (ORCHARD, 6, APPLES), VALUE),
    ("DSUM", (ORCHARD, 0, APPLES), VALUE),
    ("DSUM", (ORCHARD, None, APPLES), VALUE),
    ("DSUM", (ORCHARD, NUM, APPLES), NUM),
    ("DSUM", (NA, "Profit", APPLES), NA),
    ("DSUM", (ORCHARD, "Profit", [["Tree"]]), VALUE),
    ("DSUM", ([["Tree", "Profit"]], "Profit", APPLES), VALUE),
    ("DSUM", (ODD, "b", [["a"], ["x"]]), 1),
    ("DSUM", (ODD, "b", [["a"], ["z"]]), NA),
    ("DSUM", (ODD, "b", [["a"], [None]]), NA),
    ("DSUM", (ORCHARD, "Yield", [["Tree"], ["P"]]), 18),
    ("DSUM", (ORCHARD, "Yield", [["Tree", None], ["P", None]]), 18),
    ("DCOUNT", (ORCHARD, "Age", [["Tree", "Height"], ["=Apple", ">10"]]), 2),
    ("DCOUNT", (ODD, "b", [["a"], ["x"]]), 1),
    ("DCOUNT", (ODD, None, [["a"], ["x"]]), 3),
    ("DCOUNTA", (ODD, "b", [["a"], ["x"]]), 2),
    ("DCOUNTA", (ODD, None, [["a"], ["x"]]), 3),
    ("DCOUNTA", (ODD, "b", [["a"], [None]]), 4),
    ("DMAX", (ORCHARD, "Profit", TALL_APPLES_OR_PEARS), 105),
    ("DMIN", (ORCHARD, "Profit", TALL_APPLES_OR_PEARS), 75),
    ("DMIN", (ORCHARD, "Profit", [["Tree"], ["Plum"]]), 0),
    ("DPRODUCT", (ORCHARD, "Yield", [["Tree", "Height"], ["=Apple", ">10"], ["=Pear", None]]), 14 * 10 * 10 * 8),
    ("DAVERAGE", (ORCHARD, "Yield", TALL_APPLES), 12),
    ("DAVERAGE", (ORCHARD, 3, [["Tree"], ["Plum"]]), DIV0),
    ("DGET", (ORCHARD, "Yield", [["Tree"], ["=Cherry"]]), 9),
    ("DGET", (ORCHARD, "Tree", [["Yield"], [9]]), "Cherry"),
    ("DGET", (ORCHARD, "Yield", APPLES), NUM),
    ("DGET", (ORCHARD, "Yield", [["Tree"], ["=Plum"]]), VALUE),
    ("DVAR", (ORCHARD, "Yield", [["Tree"], ["=Apple"], ["=Pear"]]), 8.8),
    ("DVARP", (ORCHARD, "Yield", [["Tree"], ["=Apple"], ["=Pear"]]), 7.04),
    ("DSTDEV", (ORCHARD, "Yield", [["Tree"], ["=Apple"], ["=Pear"]]), 2.96647939483827),
    ("DSTDEVP", (ORCHARD, "Yield", [["Tree"], ["=Apple"], ["=Pear"]]), 2.65329983228432),
    ("DSTDEV", (ORCHARD, "Yield", [["Tree"], ["=Cherry"]]), DIV0),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-14)


def test_fields_in_an_array_give_an_array(evaluate):
    assert evaluate("DSUM", ORCHARD, [["Yield", "x", NA]], APPLES) == [[30, VALUE, NA]]


def test_a_computed_criterion_is_refused(evaluate):
    with pytest.raises(FormulaError, match="heading that is not a field"):
        evaluate("DSUM", ORCHARD, "Yield", [["Tall"], [True]])


def test_database_and_criteria_of_their_own_in_each_trial(value):
    profit = np.array([[1.0, 2.0, 4.0], [1.0, 2.0, 4.0], [8.0, 16.0, 32.0]])
    numbers = np.concatenate([np.zeros((3, 1)), profit], axis=1)[:, :, None]
    texts = np.full((1, 4, 1), "", object)
    texts[0, 0, 0] = "Profit"
    kinds = np.array([2, 0, 0, 0], np.uint8).reshape(1, 4, 1)
    criteria = np.full((3, 2, 1), "Profit", object)
    criteria[:, 1, 0] = [">1", "<>2", "<20"]
    database = Value(numbers, kinds, texts)
    wanted = Value(np.zeros((1, 1, 1)), np.full((1, 1, 1), 2, np.uint8), criteria)
    result = function_named("DSUM")([database, constant("Profit"), Value(np.zeros((3, 2, 1)), wanted.kinds, criteria)])
    assert result.objects().tolist() == [6, 5, 24]


cells = st.sampled_from([0.0, 1.0, 2.0, "a", "ab", "2", True, None, DIV0])
wanted = st.sampled_from([None, "", 1.0, "a", "=a", ">0", "<>a", "=", "<>", True])


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_trials_together_are_the_trials_alone(data):
    def drawn(strategy, headings, rows):
        box = np.empty((data.draw(st.sampled_from([1, 3])), rows + 1, 2), object)
        box[:, 0] = headings
        below = box[:, 1:]
        below[...] = np.array(data.draw(st.lists(strategy, min_size=below.size, max_size=below.size)), object).reshape(
            below.shape
        )
        return from_objects(box)

    field = np.array(data.draw(st.lists(st.sampled_from(["x", "Y", 1.0, 3.0, None]), min_size=3, max_size=3)), object)
    arguments = [drawn(cells, ["X", "y"], 3), from_objects(field), drawn(wanted, ["x", "Y"], 2)]
    for name in ("DSUM", "DGET", "DCOUNT", "DCOUNTA", "DAVERAGE"):
        function = function_named(name)
        together = function(arguments).objects().tolist()
        alone = [function([v.take(np.array([i])) for v in arguments]).objects()[0] for i in range(3)]
        assert together == alone, name
