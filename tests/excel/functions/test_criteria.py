"""Criteria against a model that takes one cell and one criterion at a time."""

from __future__ import annotations

import operator
import re
from fnmatch import fnmatchcase

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.criteria import is_pattern, pattern_of, which_meet
from xlmc.excel.functions.ordering import order_key
from xlmc.excel.functions.values import constant, from_objects

DIV0, NA = ErrorCode.DIV0, ErrorCode.NA
CELLS = [5.0, "5", " 5.0 ", "abc", "ABC", "abd", "a*c", "", None, True, False, "TRUE", NA, DIV0, 0.0, -1.0, "50%", "b?"]

TABLE = [
    (5.0, [5.0, "5", " 5.0 "]),
    ("5", [5.0, "5", " 5.0 "]),
    ("=5", [5.0, "5", " 5.0 "]),
    ("=5.0", [5.0, "5", " 5.0 "]),
    (">=5", [5.0]),
    (">4", [5.0]),
    ("<=0", [0.0, -1.0]),
    ("< 0", [-1.0]),
    (0.0, [0.0]),
    (None, [0.0]),
    (0.5, ["50%"]),
    ("abc", ["abc", "ABC"]),
    ("=ABC", ["abc", "ABC"]),
    ("ab?", ["abc", "ABC", "abd"]),
    ("a*", ["abc", "ABC", "abd", "a*c"]),
    ("a~*c", ["a*c"]),
    ("*~?", ["b?"]),
    ("*", [item for item in CELLS if isinstance(item, str)]),
    ("?*", [item for item in CELLS if isinstance(item, str) and item]),
    (">abc", ["abd", "TRUE", "b?"]),
    ("<abc", ["5", " 5.0 ", "a*c", "", "50%"]),
    ("<=a*c", ["5", " 5.0 ", "a*c", "", "50%"]),
    (True, [True]),
    ("true", [True]),
    ("<>TRUE", [item for item in CELLS if item is not True]),
    (">FALSE", [True]),
    (NA, [NA]),
    ("#N/A", [NA]),
    ("#div/0!", [DIV0]),
    ("=", [None]),
    ("", ["", None]),
    ("<>", [item for item in CELLS if item is not None]),
    (">", []),
    (">=", []),
    ("<", []),
    ("<=", []),
    ("<>abc", [item for item in CELLS if not isinstance(item, str) or item.casefold() != "abc"]),
    ("<>a*", [item for item in CELLS if not isinstance(item, str) or not item.casefold().startswith("a")]),
    ("<>5", [item for item in CELLS if item != 5.0]),
    ("=>5", []),
]


def _range(items):
    box = np.empty((1, len(items), 1), object)
    box[0, :, 0] = items
    return from_objects(box)


def _named(items):
    return [(type(item), item) for item in items]


@pytest.mark.parametrize(("criterion", "expected"), TABLE)
def test_table(criterion, expected):
    held = which_meet(constant(criterion), _range(CELLS))[0]
    assert _named([item for item, holds in zip(CELLS, held, strict=True) if holds]) == _named(expected)


@pytest.mark.parametrize(
    ("criterion", "expected"),
    [
        ("ab", ["abc", "ABC", "abd"]),
        ("=ab", []),
        ("=abc", ["abc", "ABC"]),
        ("?b", ["abc", "ABC", "abd"]),
        ("<>abc", [item for item in CELLS if not isinstance(item, str) or item.casefold() != "abc"]),
        (5.0, [5.0, "5", " 5.0 "]),
    ],
)
def test_database_functions_ask_for_the_beginning_of_a_text(criterion, expected):
    held = which_meet(constant(criterion), _range(CELLS), begins=True)[0]
    assert _named([item for item, holds in zip(CELLS, held, strict=True) if holds]) == _named(expected)


@pytest.mark.parametrize(("date1904", "expected"), [(False, [False, True, True]), (True, [True, False, True])])
def test_dates_are_numbers(date1904, expected):
    cells = _range([42369.0, 43831.0, "1/1/2020"])
    assert which_meet(constant("1/1/2020"), cells, date1904=date1904)[0].tolist() == expected
    assert which_meet(constant(">=1/1/2020"), _range([43830.0, 43831.0])).tolist() == [[False, True]]


ORDERS = {"<=": operator.le, ">=": operator.ge, "<": operator.lt, ">": operator.gt}


def _number(text):
    try:
        return float(text)
    except ValueError:
        return None


def _operand(text):
    folded = text.casefold()
    if folded in ("true", "false"):
        return folded == "true"
    number = _number(text)
    return text if number is None else number


def _kind(item):
    return float if type(item) is int else type(item)


def _equals(cell, operand, *, texts_read):
    if isinstance(operand, str):
        if not operand and cell is None:
            return True
        return isinstance(cell, str) and fnmatchcase(cell.casefold(), operand.casefold())
    if type(operand) is float and isinstance(cell, str):
        return texts_read and _number(cell) == operand
    return _kind(cell) is _kind(operand) and cell == operand


def _meets(cell, criterion):
    """One cell and one criterion."""
    if criterion is None:
        criterion = 0.0
    if not isinstance(criterion, str):
        return _equals(cell, criterion, texts_read=True)
    sign = next((sign for sign in ("<=", ">=", "<>", "<", ">", "=") if criterion.startswith(sign)), "")
    rest = criterion.removeprefix(sign)
    if not rest and sign in ("=", "<>"):
        return (cell is None) == (sign == "=")
    operand = _operand(rest)
    if sign in ORDERS:
        if not rest or _kind(cell) is not _kind(operand):
            return False
        cell, operand = (order_key(item) if isinstance(item, str) else item for item in (cell, operand))
        return ORDERS[sign](cell, operand)
    return _equals(cell, operand, texts_read=sign != "<>") != (sign == "<>")


cells = st.sampled_from([0.0, 1.0, 2.0, 2.5, "1", "2.5", "ab", "AB", "b", "bc", "", None, True, False, NA, DIV0])
criteria = st.sampled_from([0.0, 1.0, 2.5, True, None, NA]) | st.tuples(
    st.sampled_from(["", "=", "<>", "<", ">", "<=", ">="]),
    st.sampled_from(["", "1", "2", "2.5", "ab", "b", "b*", "?b", "*", "TRUE", "false"]),
).map("".join)


@given(st.lists(st.tuples(criteria, cells, cells, cells), min_size=1, max_size=6), st.booleans())
def test_as_the_model_has_it_in_every_trial(trials, constant_range):
    rows = [trials[0][1:] if constant_range else trial[1:] for trial in trials]
    wanted = np.empty(len(trials), object)
    wanted[:] = [trial[0] for trial in trials]
    box = np.empty((1 if constant_range else len(trials), 1, 3), object)
    for place, row in enumerate(rows[: len(box)]):
        box[place, 0] = row
    result = np.broadcast_to(which_meet(from_objects(wanted), from_objects(box)), (len(trials), 3))
    expected = [[_meets(cell, trial[0]) for cell in row] for trial, row in zip(trials, rows, strict=True)]
    assert result.tolist() == expected


TABLE_OF_PATTERNS = [
    ("abc", "ABC", True),
    ("abc", "abcd", False),
    ("a*", "a", True),
    ("a*", "abc", True),
    ("*c", "abc", True),
    ("*c", "abcd", False),
    ("a*c", "ac", True),
    ("a*c", "acbc", True),
    ("aa*a", "aa", False),
    ("a?c", "abc", True),
    ("a?c", "ac", False),
    ("??", "ab", True),
    ("*", "", True),
    ("?*", "", False),
    ("~*", "*", True),
    ("~*", "a", False),
    ("a~?", "a?", True),
    ("a~?", "ab", False),
    ("~~", "~", True),
    ("a~b", "ab", True),
    ("a~b", "a~b", False),
    ("a~~b", "a~b", True),
    ("a~", "a", True),
    ("a~", "a~", False),
    ("*b*d*", "abcde", True),
    ("*d*b*", "abcde", False),
    ("a*", "a\nb", True),
    (".+", "xx", False),
    ("", "", True),
    ("", "a", False),
]


@pytest.mark.parametrize(("pattern", "text", "expected"), TABLE_OF_PATTERNS)
def test_table_patterns(pattern, text, expected):
    assert pattern_of(pattern).fits(text) is expected


def test_a_pattern_that_only_begins_the_text():
    assert pattern_of("ab", begins=True).fits("ABC")
    assert not pattern_of("b", begins=True).fits("abc")


@pytest.mark.parametrize(("text", "expected"), [("a", False), ("a*", True), ("?", True), ("~", True)])
def test_is_pattern(text, expected):
    assert is_pattern(text) is expected


@given(st.text("ab*?", max_size=8), st.text("abc", max_size=8))
def test_as_a_regular_expression_has_it(pattern, text):
    expression = "".join({"*": ".*", "?": "."}.get(mark, mark) for mark in pattern)
    assert pattern_of(pattern).fits(text) is (re.fullmatch(expression, text) is not None)


def test_a_chain_of_stars_comes_to_an_end():
    assert not pattern_of("*a" * 40 + "b").fits("a" * 20_000)
