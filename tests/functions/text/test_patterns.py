from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.functions.criteria import is_pattern, pattern_of

TABLE = [
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
    ("a~b", "a~b", True),
    ("*b*d*", "abcde", True),
    ("*d*b*", "abcde", False),
    ("a*", "a\nb", True),
    (".+", "xx", False),
    ("", "", True),
    ("", "a", False),
]


@pytest.mark.parametrize(("pattern", "text", "expected"), TABLE)
def test_table(pattern, text, expected):
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
