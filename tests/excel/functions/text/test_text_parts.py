from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.text.text_parts import from_units, in_units, to_units

VALUE = ErrorCode.VALUE

TABLE = [
    ("LEN", ("Phoenix, AZ",), 11),
    ("LEN", ("",), 0),
    ("LEN", (None,), 0),
    ("LEN", (True,), 4),
    ("LEN", (1 / 3,), 17),
    ("LEN", ("a😀",), 3),
    ("LEN", (ErrorCode.NA,), ErrorCode.NA),
    ("LEFT", ("Sale Price", 4), "Sale"),
    ("LEFT", ("Sweden",), "S"),
    ("LEFT", ("abc", 0), ""),
    ("LEFT", ("abc", 1.9), "a"),
    ("LEFT", ("abc", 1e300), "abc"),
    ("LEFT", ("abc", -1), VALUE),
    ("LEFT", ("abc", "2"), "ab"),
    ("LEFT", (True, 2), "TR"),
    ("LEFT", (12.5, 2), "12"),
    ("LEFT", ("😀b", 2), "😀"),
    ("LEFT", ("😀b", 1), "\ufffd"),
    ("RIGHT", ("Sale Price", 5), "Price"),
    ("RIGHT", ("abc",), "c"),
    ("RIGHT", ("abc", 0), ""),
    ("RIGHT", ("abc", 10), "abc"),
    ("RIGHT", ("abc", -1), VALUE),
    ("MID", ("Fluid Flow", 1, 5), "Fluid"),
    ("MID", ("Fluid Flow", 7, 20), "Flow"),
    ("MID", ("Fluid Flow", 20, 5), ""),
    ("MID", ("abc", 0, 1), VALUE),
    ("MID", ("abc", 0.9, 1), VALUE),
    ("MID", ("abc", 1, -1), VALUE),
    ("MID", ("abc", 2.9, 1.9), "b"),
    ("REPLACE", ("abcdefghijk", 6, 5, "*"), "abcde*k"),
    ("REPLACE", (2009, 3, 2, "10"), "2010"),
    ("REPLACE", ("123456", 1, 3, "@"), "@456"),
    ("REPLACE", ("abc", 2, 0, "x"), "axbc"),
    ("REPLACE", ("abc", 9, 1, "x"), "abcx"),
    ("REPLACE", ("abc", 0, 1, "x"), VALUE),
    ("REPLACE", ("abc", 1, -1, "x"), VALUE),
    ("REPT", ("*-", 3), "*-*-*-"),
    ("REPT", ("-", 10.9), "-" * 10),
    ("REPT", ("ab", 0), ""),
    ("REPT", ("", 1e300), ""),
    ("REPT", ("ab", -1), VALUE),
    ("REPT", ("a", 32767), "a" * 32767),
    ("REPT", ("a", 32768), VALUE),
    ("REPT", ("a", 1e300), VALUE),
    ("LEFTB", ("abc", 2), "ab"),
    ("LEN", ([["a", "bcd"]],), [[1.0, 3.0]]),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected)


VALUE_OF_TEXT_SEARCH = ErrorCode.VALUE

TABLE_OF_TEXT_SEARCH = [
    ("FIND", ("M", "Miriam McGovern"), 1),
    ("FIND", ("m", "Miriam McGovern"), 6),
    ("FIND", ("M", "Miriam McGovern", 3), 8),
    ("FIND", ("x", "abc"), VALUE_OF_TEXT_SEARCH),
    ("FIND", ("", "abc"), 1),
    ("FIND", ("", "abc", 4), 4),
    ("FIND", ("", "abc", 5), VALUE_OF_TEXT_SEARCH),
    ("FIND", ("", ""), 1),
    ("FIND", ("a", "abc", 0), VALUE_OF_TEXT_SEARCH),
    ("FIND", ("c", "abc", 2.9), 3),
    ("FIND", ("*", "a*b"), 2),
    ("FIND", (2, 123), 2),
    ("FIND", ("b", "😀b"), 3),
    ("SEARCH", ("e", "Statements", 6), 7),
    ("SEARCH", ("margin", "Profit Margin"), 8),
    ("SEARCH", ("?ar", "Profit Margin"), 8),
    ("SEARCH", ("p*m", "Profit Margin"), 1),
    ("SEARCH", ("*m", "Profit Margin"), 1),
    ("SEARCH", ("o*o", "Profit"), VALUE_OF_TEXT_SEARCH),
    ("SEARCH", ("a*b*a", "xaxbxaxbx"), 2),
    ("SEARCH", ("~?", "what?"), 5),
    ("SEARCH", ("~*", "a*b"), 2),
    ("SEARCH", ("a~b", "xab"), 2),
    ("SEARCH", ("a~b", "xa~b"), VALUE_OF_TEXT_SEARCH),
    ("SEARCH", ("a~~b", "xa~b"), 2),
    ("SEARCH", ("a.c", "abc"), VALUE_OF_TEXT_SEARCH),
    ("SEARCH", ("a?c", "a\nc"), 1),
    ("SEARCH", ("", "abc", 2), 2),
    ("SEARCH", ("n", "printer", 9), VALUE_OF_TEXT_SEARCH),
    ("SEARCH", ("*a" * 20 + "b", "a" * 2000), VALUE_OF_TEXT_SEARCH),
    ("SUBSTITUTE", ("Sales Data", "Sales", "Cost"), "Cost Data"),
    ("SUBSTITUTE", ("Quarter 1, 2008", "1", "2", 1), "Quarter 2, 2008"),
    ("SUBSTITUTE", ("Quarter 1, 2011", "1", "2", 3), "Quarter 1, 2012"),
    ("SUBSTITUTE", ("aaa", "a", "b", 4), "aaa"),
    ("SUBSTITUTE", ("aaa", "aa", "b"), "ba"),
    ("SUBSTITUTE", ("aAa", "a", "b"), "bAb"),
    ("SUBSTITUTE", ("abc", "", "x"), "abc"),
    ("SUBSTITUTE", ("abc", "b", ""), "ac"),
    ("SUBSTITUTE", ("a", "a", "b", 0.9), VALUE_OF_TEXT_SEARCH),
    ("SUBSTITUTE", ("a", "a", "b", 1.9), "b"),
    ("SUBSTITUTE", ("a" * 20000, "a", "ab"), VALUE_OF_TEXT_SEARCH),
    ("SUBSTITUTE", (ErrorCode.REF, "a", "b"), ErrorCode.REF),
    ("EXACT", ("word", "word"), True),
    ("EXACT", ("Word", "word"), False),
    ("EXACT", (123, "123"), True),
    ("EXACT", (True, "TRUE"), True),
    ("EXACT", (None, ""), True),
    ("EXACT", ([["a", "b"]], "b"), [[False, True]]),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE_OF_TEXT_SEARCH)
def test_values_text_search(check, name, arguments, expected):
    check(name, arguments, expected)


@given(st.text())
def test_units_join_again(text):
    assert from_units(to_units(text)) == text
    assert len(to_units(text)) == len(text.encode("utf-16-le")) // 2


@pytest.mark.parametrize(("text", "shown"), [("\ud83d", "\ufffd"), ("a\ude00b", "a\ufffdb"), ("é", "é"), ("", "")])
def test_half_a_pair_is_unknown(text, shown):
    assert from_units(text) == shown


def test_functions_count_in_units():
    assert in_units(lambda text, place: text[place:])("😀b", 2) == "b"
    assert in_units(len)("😀b") == 3
