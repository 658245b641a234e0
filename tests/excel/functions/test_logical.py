from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value, from_objects

DIV0, NUM, VALUE, NA, REF = ErrorCode.DIV0, ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA, ErrorCode.REF

TABLE = [
    ("IF", (True, 1, 2), 1),
    ("IF", (False, 1, 2), 2),
    ("IF", (0.1, "yes", "no"), "yes"),
    ("IF", (None, "yes", "no"), "no"),
    ("IF", ("true", "yes", "no"), "yes"),
    ("IF", ("maybe", "yes", "no"), VALUE),
    ("IF", (False, 1), False),
    ("IF", (True, None, 1), 0),
    ("IF", (False, 1, None), 0),
    ("IF", (True, 1, DIV0), 1),
    ("IF", (False, DIV0, "b"), "b"),
    ("IF", (True, NA, 1), NA),
    ("IF", (NUM, NA, 1), NUM),
    ("IFERROR", (1, 2), 1),
    ("IFERROR", (DIV0, 2), 2),
    ("IFERROR", (1, DIV0), 1),
    ("IFERROR", (DIV0, NA), NA),
    ("IFERROR", (None, 2), 0),
    ("IFERROR", (DIV0, None), 0),
    ("IFERROR", ("a", 2), "a"),
    ("IFERROR", (NA, "b"), "b"),
    ("IFNA", (NA, 2), 2),
    ("IFNA", (DIV0, 2), DIV0),
    ("IFNA", (1, NA), 1),
    ("NOT", (True,), False),
    ("NOT", (0,), True),
    ("NOT", (None,), True),
    ("NOT", ("FALSE",), True),
    ("NOT", ("x",), VALUE),
    ("NOT", (NA,), NA),
    ("AND", (True, 1, "TRUE"), True),
    ("AND", (True, 0), False),
    ("AND", (5,), True),
    ("AND", ([[1, "x", None]],), True),
    ("AND", ([["x", None]],), VALUE),
    ("AND", ([["x", None]], False), False),
    ("AND", ("x", True), VALUE),
    ("AND", (False, NA), NA),
    ("AND", (True, None), False),
    ("OR", (False, 0), False),
    ("OR", (False, 2), True),
    ("OR", ([[0, "TRUE", False]],), False),
    ("OR", ([["x"]],), VALUE),
    ("OR", (True, DIV0, NA), DIV0),
    ("XOR", (True, True), False),
    ("XOR", (True, False, 0), True),
    ("XOR", ([[1, 1, 1]],), True),
    ("XOR", ([[None]],), VALUE),
    ("TRUE", (), True),
    ("FALSE", (), False),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected)


KINDS = {
    "ISERROR": (False, False, False, False, True, True),
    "ISERR": (False, False, False, False, True, False),
    "ISNA": (False, False, False, False, False, True),
    "ISNUMBER": (True, False, False, False, False, False),
    "ISLOGICAL": (False, True, False, False, False, False),
    "ISTEXT": (False, False, True, False, False, False),
    "ISNONTEXT": (True, True, False, True, True, True),
    "ISBLANK": (False, False, False, True, False, False),
}


@pytest.mark.parametrize("name", KINDS)
def test_what_a_value_is(evaluate, name):
    assert tuple(evaluate(name, item) for item in (0, False, "", None, DIV0, NA)) == KINDS[name]


@pytest.mark.parametrize("name", KINDS)
def test_what_the_values_of_trials_are(name):
    trials = from_objects(np.array([0, False, "", None, DIV0, NA], object))
    assert tuple(function_named(name)([trials]).objects()) == KINDS[name]


def _of(*items: object) -> Value:
    return from_objects(np.array(items, object))


def test_if_takes_each_trial_from_its_branch():
    condition = _of(True, False, "x", NUM)
    yes, no = _of(1.0, DIV0, 3.0, 4.0), _of(NA, "no", 7.0, 8.0)
    assert function_named("IF")([condition, yes, no]).objects().tolist() == [1.0, "no", VALUE, NUM]


def test_iferror_takes_each_trial_from_its_branch():
    value, instead = _of(1.0, DIV0, "a", NA), _of(NA, 2.0, DIV0, "b")
    assert function_named("IFERROR")([value, instead]).objects().tolist() == [1.0, 2.0, "a", "b"]
    assert function_named("IFNA")([value, instead]).objects().tolist() == [1.0, DIV0, "a", "b"]


def test_a_constant_condition_over_trials():
    assert function_named("IF")([_of(True), _of(1.0, "a"), _of(0.0)]).objects().tolist() == [1.0, "a"]


def test_ranges_of_conditions(evaluate):
    assert evaluate("IF", [[True, "x", NA]], 1, "no") == [[1.0, VALUE, NA]]
    assert evaluate("IFERROR", [[1, NA]], 0) == [[1.0, 0.0]]


def test_a_condition_of_trials_over_ranges():
    condition = _of(True, False, REF)
    yes = from_objects(np.array([[[1.0, 2.0, 3.0]]], object))
    result = function_named("IF")([condition, yes, _of("no")]).objects()[:, 0].tolist()
    assert result == [[1.0, 2.0, 3.0], ["no"] * 3, [REF] * 3]
