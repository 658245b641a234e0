from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.excel.workbook.safe_xml import decode, run_text, shared_strings

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
    return re.sub("[\0-\x1f]", lambda result: f"_x{ord(result[0]):04X}_", guarded)


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


@pytest.mark.parametrize("depth", [1, 60_000])
def test_an_unknown_element_around_a_text_moves_no_text(depth):
    def inside(text):
        return "<a>" * depth + text + "</a>" * depth

    runs = "<r><rPr><b/></rPr><t>b</t></r>" + inside("<r><t>c</t></r><rPh><t>no</t></rPh>")
    items = f"<si>{inside('<t>a</t>')}</si><si>{runs}</si>{inside('<si><t>d</t></si>')}<si><t>e</t></si>"
    assert shared_strings(f"<sst {MAIN}>{items}</sst>".encode(), "p") == ["a", "bc", "d", "e"]


def test_shared_strings_with_a_prefix():
    xml = f"<x:sst {MAIN.replace('xmlns', 'xmlns:x')}><x:si><x:r><x:t>a</x:t></x:r></x:si></x:sst>"
    assert shared_strings(xml.encode(), "p") == ["a"]
