from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode

VALUE = ErrorCode.VALUE

TABLE = [
    ("FIND", ("M", "Miriam McGovern"), 1),
    ("FIND", ("m", "Miriam McGovern"), 6),
    ("FIND", ("M", "Miriam McGovern", 3), 8),
    ("FIND", ("x", "abc"), VALUE),
    ("FIND", ("", "abc"), 1),
    ("FIND", ("", "abc", 4), 4),
    ("FIND", ("", "abc", 5), VALUE),
    ("FIND", ("", ""), 1),
    ("FIND", ("a", "abc", 0), VALUE),
    ("FIND", ("c", "abc", 2.9), 3),
    ("FIND", ("*", "a*b"), 2),
    ("FIND", (2, 123), 2),
    ("FIND", ("b", "😀b"), 3),
    ("SEARCH", ("e", "Statements", 6), 7),
    ("SEARCH", ("margin", "Profit Margin"), 8),
    ("SEARCH", ("?ar", "Profit Margin"), 8),
    ("SEARCH", ("p*m", "Profit Margin"), 1),
    ("SEARCH", ("*m", "Profit Margin"), 1),
    ("SEARCH", ("o*o", "Profit"), VALUE),
    ("SEARCH", ("a*b*a", "xaxbxaxbx"), 2),
    ("SEARCH", ("~?", "what?"), 5),
    ("SEARCH", ("~*", "a*b"), 2),
    ("SEARCH", ("a~b", "xa~b"), 2),
    ("SEARCH", ("a.c", "abc"), VALUE),
    ("SEARCH", ("a?c", "a\nc"), 1),
    ("SEARCH", ("", "abc", 2), 2),
    ("SEARCH", ("n", "printer", 9), VALUE),
    ("SEARCH", ("*a" * 20 + "b", "a" * 2000), VALUE),
    ("SUBSTITUTE", ("Sales Data", "Sales", "Cost"), "Cost Data"),
    ("SUBSTITUTE", ("Quarter 1, 2008", "1", "2", 1), "Quarter 2, 2008"),
    ("SUBSTITUTE", ("Quarter 1, 2011", "1", "2", 3), "Quarter 1, 2012"),
    ("SUBSTITUTE", ("aaa", "a", "b", 4), "aaa"),
    ("SUBSTITUTE", ("aaa", "aa", "b"), "ba"),
    ("SUBSTITUTE", ("aAa", "a", "b"), "bAb"),
    ("SUBSTITUTE", ("abc", "", "x"), "abc"),
    ("SUBSTITUTE", ("abc", "b", ""), "ac"),
    ("SUBSTITUTE", ("a", "a", "b", 0.9), VALUE),
    ("SUBSTITUTE", ("a", "a", "b", 1.9), "b"),
    ("SUBSTITUTE", ("a" * 20000, "a", "ab"), VALUE),
    ("SUBSTITUTE", (ErrorCode.REF, "a", "b"), ErrorCode.REF),
    ("EXACT", ("word", "word"), True),
    ("EXACT", ("Word", "word"), False),
    ("EXACT", (123, "123"), True),
    ("EXACT", (True, "TRUE"), True),
    ("EXACT", (None, ""), True),
    ("EXACT", ([["a", "b"]], "b"), [[False, True]]),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected)
