from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.excel.functions.number_format import FormatError, UnknownFormat, parse_format

ACCOUNTING = '_($* #,##0_);_($* (#,##0);_($* "-"_);_(@_)'

BY_SIGN = [
    ("0;(0)", -5, "(5)"),
    ("0;(0)", 0, "0"),
    ("0;(0)", "text", "text"),
    ("0.0;-0.0", -0.01, "-0.0"),
    ('0;-0;"nil"', 0, "nil"),
    ("-0", -1, "--1"),
    (ACCOUNTING, 1, " $1 "),
    (ACCOUNTING, -1, " $(1)"),
    (ACCOUNTING, 0, " $- "),
    (ACCOUNTING, "text", " text "),
    ('"a";"b";"c";"d"', "text", "d"),
    ('"a";"b";@', 0, "a"),
    ('"a";"b";@', -1, "b"),
    ('"a";"b";@', "text", "text"),
    ("@@", "text", "texttext"),
    ('@ "x"', 1 / 3, "0.333333333333333"),
    ("0;0;0;General!", "text", "text!"),
    (";;;", 5, ""),
    (";;;", "text", ""),
    (";", -5, ""),
    ("", -5, "-"),
    ("r", -1, "-r"),
    ("[Red]0;[Color 5]0", -2, "2"),
]
CONDITIONS = [
    ("[<=9999999]###-####;(###) ###-####", 8675309, "867-5309"),
    ("[<=9999999]###-####;(###) ###-####", 2813308004, "(281) 330-8004"),
    ('[>=100]"A"0;[<=-100]"B"0;"C"0', -6.3, "-C6"),
    ('[>=100]"A"0;[<=-100]"B"0;"C"0', -100, "B100"),
    ('[>=100]"A"0;[<=0]"B"0;"C"0', -6.3, "-B6"),
    ('[>=100]"A"0;[<=-100]"B"0', 6.3, "#" * 255),
    ('[<=0]"B"0', 6.3, "6.3"),
    ("[=6.3]0", -6.3, "-6.3"),
    ("[<-6]0", -5, "5"),
    ("[>2]A0;[<0]B0;C0", -5, "refused"),
    (r"[>2]\A0;[<0]\B0;\C0", -5, "B5"),
    (r"[>2]\A0;[>4]\B0;\C0", -5, "-C5"),
    (r"[<>-5]\A0;\B0", -5, "B5"),
    (r"[=-6]\A0;\B0", -5, "-B5"),
    (r"\A0;[=0]\B0;\C0", 0, "B0"),
    (r"\A0;[<0.5]\B0;\C0", -10, "-B10"),
    ("[Red][<-25]General;[Blue][>25]General;[Green]General;[Yellow]General", -50.1, "50.1"),
]


@pytest.mark.parametrize(("code", "value", "text"), BY_SIGN + CONDITIONS)
def test_sections(written, code, value, text):
    assert written(code, value) == text


REFUSED = [
    "0;0;0;0;0",
    "0;0;[>5]0",
    "[>1][<2]0",
    "0;0;0;0",
    "@;@",
    "0@",
    "0.0 General",
    "[orange]0",
    "[>1.2.3]0",
    '"',
    "[",
    "\\",
    "_",
    "*",
    "n",
    "0" * 256,
]


@pytest.mark.parametrize("code", REFUSED)
def test_what_is_no_format(code):
    with pytest.raises(FormatError):
        parse_format(code)


PIECES = [*"0#?.,%/@;-() 18egbKhm", "E+", "e-", '"a"', r"\x", "_(", "*-", "General", "yyyy", "ddd", "ss", ".00"]
PIECES += ["AM/PM", "A/P", "[h]", "[mm]", "[>5]", "[<=-3]", "[Red]", "[$€-407]", "[$-409]"]


@given(st.lists(st.sampled_from(PIECES), max_size=8).map("".join), st.floats(allow_nan=False, allow_infinity=False))
def test_any_format_writes_or_is_refused(code, value):
    try:
        form = parse_format(code)
        assert isinstance(form.text("abc"), str)
        assert isinstance(form.number(value), str)
    except (FormatError, UnknownFormat):
        return


@given(st.floats(-1e15, 1e15), st.integers(0, 10))
def test_digits_are_those_of_the_rounded_number(value, places):
    text = parse_format(f"0.{'0' * places}").number(value)
    assert abs(float(text) - value) <= 0.5 * 10.0**-places + 1e-14 * abs(value)
