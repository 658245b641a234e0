from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.workbook.cell_values import CellContext, convert, decode, run_text, shared_strings

CONTEXT = CellContext(strings=("zero", "one"))

VALUES = [
    ("n", "42", 42.0),
    ("n", "-1.5E-3", -0.0015),
    ("n", "0.1", 0.1),
    ("n", "", None),
    ("b", "1", True),
    ("b", "0", False),
    ("b", "true", True),
    ("s", "1", "one"),
    ("str", "", ""),
    ("str", "a_x000a_b", "a\nb"),
    ("inlineStr", "a_x000a_b", "a_x000a_b"),
    ("e", "#DIV/0!", ErrorCode.DIV0),
    ("e", "#N/A", ErrorCode.NA),
    ("e", "#SPILL!", ErrorCode.SPILL),
    ("e", "#CALC!", ErrorCode.CALC),
    *(
        ("e", text, ErrorCode.VALUE)
        for text in ("#FIELD!", "#BUSY!", "#CONNECT!", "#BLOCKED!", "#UNKNOWN!", "#PYTHON!")
    ),
]


@pytest.mark.parametrize(("kind", "raw", "value"), VALUES)
def test_value(kind, raw, value):
    found = convert(kind, raw, CONTEXT)
    assert found == value
    assert type(found) is type(value)


@pytest.mark.parametrize(
    ("raw", "serial", "serial1904"),
    [
        ("2001-03-11", 36961.0, 35499.0),
        ("2001-03-11T12:00:00", 36961.5, 35499.5),
        ("2001-03-11T18:00:00.000Z", 36961.75, 35499.75),
        ("1900-01-01", 1.0, None),
        ("1900-03-01", 61.0, None),  # Excel counts a 29 February 1900
        ("1904-01-01", 1462.0, 0.0),
        ("06:00:00", 0.25, 0.25),
    ],
)
def test_iso_dates_are_serial_numbers(raw, serial, serial1904):
    assert convert("d", raw, CONTEXT) == serial
    if serial1904 is not None:
        assert convert("d", raw, CellContext(date1904=True)) == serial1904


@pytest.mark.parametrize(
    ("kind", "raw", "message"),
    [
        ("n", "12 m", "holds '12 m' where a number should be"),
        ("n", "NaN", "holds 'NaN' where a number should be"),
        ("n", "1e999", "holds '1e999' where a number should be"),
        ("b", "2", r"where TRUE \(1\) or FALSE \(0\) should be"),
        ("b", "", r"where TRUE \(1\) or FALSE \(0\) should be"),
        ("s", "2", "number '2' of 2"),
        ("s", "-1", "number '-1' of 2"),
        ("s", "9" * 5000, "holds a text that the workbook does not"),
        ("s", "x", "number 'x' of 2"),
        ("d", "yesterday", "holds 'yesterday' where a date should be"),
        ("d", "2001-13-40", "where a date should be"),
        ("z", "1", "is of the unknown type 'z'"),
    ],
)
def test_refused(kind, raw, message):
    with pytest.raises(ValueError, match=message):
        convert(kind, raw, CONTEXT)


MAIN = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'


@pytest.mark.parametrize(
    ("text", "decoded"),
    [
        ("plain", "plain"),
        ("Low_x000a_km/h", "Low\nkm/h"),
        ("Low_x000A_km/h", "Low\nkm/h"),
        ("_x005F_x000a_", "_x000a_"),
        ("_x00e_", "_x00e_"),
        ("_X0041_", "_X0041_"),
        ("_xlfn.STDEV.S", "_xlfn.STDEV.S"),
        ("_xD83D__xDE97_", "\N{AUTOMOBILE}"),
        ("_xD83D_", "�"),
    ],
)
def test_decode(text, decoded):
    assert decode(text) == decoded


def encode(text):
    """What Excel writes: an underscore that would start an escape is escaped itself, and so are control characters."""
    guarded = re.sub("_(?=x[0-9A-Fa-f]{4}[_\0-\x1f])", "_x005F_", text)
    return re.sub("[\0-\x1f]", lambda found: f"_x{ord(found[0]):04X}_", guarded)


@given(st.lists(st.sampled_from(["_", "x", "0041", "_x000a_", "_x005F_", "\n", "\x01", "é", "km/h"])).map("".join))
def test_decode_undoes_what_excel_writes(text):
    assert decode(encode(text)) == text


@pytest.mark.parametrize(("keep", "read"), [(True, " \n5 m "), (False, "5 m")])
def test_white_space_at_the_ends(keep, read):
    assert run_text(" \n5 m ", keep) == read


def test_escaped_white_space_stays():
    assert run_text("_x000a_5 m", keep_space=False) == "\n5 m"


ITEMS = {
    "<t>plain</t>": "plain",
    "<t/>": "",
    "": "",
    "<t> a </t>": "a",
    '<t xml:space="preserve"> a </t>': " a ",
    '<r><t>rich</t></r><r><rPr><b/></rPr><t xml:space="preserve"> text</t></r>': "rich text",
    '<t>東京</t><rPh sb="0" eb="2"><t>トウキョウ</t></rPh><phoneticPr fontId="1"/>': "東京",
    "<t>a&amp;b&lt;c</t>": "a&b<c",
}


def test_shared_strings():
    xml = f"<sst {MAIN}>{''.join(f'<si>{item}</si>' for item in ITEMS)}<extLst><ext/></extLst></sst>"
    assert shared_strings(xml.encode(), "p") == list(ITEMS.values())


def test_shared_strings_with_a_prefix():
    xml = f"<x:sst {MAIN.replace('xmlns', 'xmlns:x')}><x:si><x:r><x:t>a</x:t></x:r></x:si></x:sst>"
    assert shared_strings(xml.encode(), "p") == ["a"]
