from __future__ import annotations

import re

import pytest

from xlmc.excel.workbook.injection.splice import parse_spans
from xlmc.excel.workbook.injection.styles_merge import merge_styles

MAIN = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
MC = 'xmlns:mc="http://schemas.openxmlformats.org/markup-compatibility/2006"'
ORDER = [
    "numFmts",
    "fonts",
    "fills",
    "borders",
    "cellStyleXfs",
    "cellXfs",
    "cellStyles",
    "dxfs",
    "tableStyles",
    "colors",
]
ARIAL = (
    f'<styleSheet {MAIN}><numFmts count="2"><numFmt numFmtId="164" formatCode="0.0"/>'
    '<numFmt numFmtId="170" formatCode="0.000"/></numFmts>'
    '<fonts count="1"><font><sz val="10"/><name val="Arial"/></font></fonts>'
    '<fills count="2"><fill><patternFill patternType="none"/></fill><fill><patternFill patternType="gray125"/></fill>'
    '</fills><borders count="1"><border><left/><right/><top/><bottom/><diagonal/></border></borders>'
    '<cellStyleXfs count="2"><xf numFmtId="9" fontId="0" fillId="0" borderId="0"/>'
    '<xf numFmtId="0" fontId="0" fillId="0" borderId="0"/></cellStyleXfs>'
    '<cellXfs count="1"><xf numFmtId="0" fontId="0" fillId="0" borderId="0" xfId="1"/></cellXfs>'
    '<cellStyles count="2"><cellStyle name="Prozent" xfId="0" builtinId="5"/>'
    '<cellStyle name="Standard" xfId="1" builtinId="0"/></cellStyles><colors/></styleSheet>'
)


@pytest.fixture(scope="module")
def built(results):
    return results["xl/styles.xml"]


def entries(styles, name):
    return parse_spans(styles, "styles").find(name).children


def counts(styles):
    root = parse_spans(styles, "styles")
    return {child.local: (child.attributes["count"], len(child.children)) for child in root.children if child.children}


def looks(styles, place):
    """What a cell with this style looks like, whatever the numbers in between."""
    root = parse_spans(styles, "styles")
    xf = root.find("cellXfs").children[place]
    formats = {e.attributes["numFmtId"]: e.attributes["formatCode"] for e in root.find("numFmts").children}
    number = xf.attributes["numFmtId"]
    parts = (("fonts", "fontId"), ("fills", "fillId"), ("borders", "borderId"))
    shape = [root.find(name).children[int(xf.attributes[key])].canonical() for name, key in parts]
    return formats.get(number, number), *shape, [child.canonical() for child in xf.children]


def without(*names):
    styles = ARIAL
    for name in names:
        styles = re.sub(rf"<{name}\b.*?</{name}>", "", styles)
    return styles


HOSTS = {
    "whole": ARIAL,
    "no numFmts": without("numFmts"),
    "no named styles": without("cellStyleXfs", "cellStyles"),
    "hardly any": without("numFmts", "fonts", "fills", "borders", "cellStyleXfs", "cellStyles", "cellXfs"),
    "nothing": f"<styleSheet {MAIN}/>",
    "empty lists": f'<styleSheet {MAIN}><fonts count="0"/><cellXfs count="0"/><dxfs count="0"/></styleSheet>',
    "a prefix": re.sub(r"<(/?)(\w)", r"<\1x:\2", ARIAL).replace("xmlns=", "xmlns:x="),
}


@pytest.mark.parametrize("host", HOSTS.values(), ids=list(HOSTS))
def test_every_built_style_looks_the_same_in_its_new_place(host, built):
    merged, places = merge_styles(host.encode(), "styles", built)
    for old, new in enumerate(places.cells):
        assert looks(merged, new) == looks(built, old)
    assert all(int(count) == size for count, size in counts(merged).values())


@pytest.mark.parametrize("host", HOSTS.values(), ids=list(HOSTS))
def test_lists_stand_in_the_order_of_the_schema(host, built):
    merged, _ = merge_styles(host.encode(), "styles", built)
    names = [child.local for child in parse_spans(merged, "styles").children]
    assert names == sorted(names, key=ORDER.index)


@pytest.mark.parametrize("host", HOSTS.values(), ids=list(HOSTS))
def test_a_second_merge_adds_nothing(host, built):
    once, places = merge_styles(host.encode(), "styles", built)
    assert merge_styles(once, "styles", built) == (once, places)


def test_the_users_own_styles_keep_their_places(built):
    merged, _ = merge_styles(ARIAL.encode(), "styles", built)
    for name in ("numFmts", "fonts", "fills", "borders", "cellStyleXfs", "cellXfs", "cellStyles"):
        own = [entry.canonical() for entry in entries(ARIAL.encode(), name)]
        assert [entry.canonical() for entry in entries(merged, name)][: len(own)] == own


def test_a_number_format_is_found_by_its_code_or_gets_a_free_number(built):
    merged, _ = merge_styles(ARIAL.encode(), "styles", built)
    formats = [(e.attributes["numFmtId"], e.attributes["formatCode"]) for e in entries(merged, "numFmts")]
    assert formats == [("164", "0.0"), ("170", "0.000"), ("171", '0.0 "km/h"'), ("172", "0.0000")]


def test_a_number_that_styles_use_without_a_definition_is_not_free(built):
    host = without("numFmts").replace('<xf numFmtId="0"', '<xf numFmtId="200"')
    merged, _ = merge_styles(host.encode(), "styles", built)
    assert min(int(e.attributes["numFmtId"]) for e in entries(merged, "numFmts")) == 201


@pytest.mark.parametrize(
    ("defined", "number"),
    [
        ('<numFmt numFmtId="0" formatCode="[h]:mm:ss"/>', "171"),
        ('<numFmt numFmtId="0" formatCode="General"/>', "0"),
        ('<numFmt numFmtId="0" formatCode="General"/><numFmt numFmtId="0" formatCode="0%"/>', "171"),
        ('<numFmt numFmtId="9" formatCode="0.0%"/><numFmt formatCode="0%"/>', "0"),
        (f"<mc:AlternateContent {MC}><mc:Fallback><numFmt numFmtId='0' formatCode='@'/></mc:Fallback>"
         "</mc:AlternateContent>", "171"),
    ],
)  # fmt: skip
def test_a_built_in_format_that_the_workbook_defines_anew_gets_a_number_of_its_own(built, defined, number):
    host = re.sub("(<numFmts[^>]*>)", rf"\1{defined}", ARIAL)
    merged, places = merge_styles(host.encode(), "styles", built)
    assert entries(built, "cellXfs")[0].attributes["numFmtId"] == "0"
    assert entries(merged, "cellXfs")[places.cells[0]].attributes["numFmtId"] == number
    shown = [e.attributes["formatCode"] for e in entries(merged, "numFmts") if e.attributes.get("numFmtId") == "171"]
    assert (shown == ["General"]) == (number == "171")
    assert merge_styles(merged, "styles", built) == (merged, places)


def test_a_number_with_two_codes_is_not_used_again(built):
    host = ARIAL.replace("</numFmts>", '<numFmt numFmtId="170" formatCode="@"/></numFmts>')
    merged, _ = merge_styles(host.encode(), "styles", built)
    formats = [(e.attributes["numFmtId"], e.attributes["formatCode"]) for e in entries(merged, "numFmts")]
    assert formats[3:] == [("171", "0.000"), ("172", '0.0 "km/h"'), ("173", "0.0000")]


def test_new_styles_rest_on_the_users_normal_style_and_say_where_they_differ(built):
    merged, places = merge_styles(ARIAL.encode(), "styles", built)
    plain = entries(merged, "cellXfs")[places.cells[0]].attributes
    assert plain["xfId"] == "1"
    assert plain["applyFont"] == "1"
    assert "applyFill" not in plain


def test_without_named_styles_none_is_pointed_to(built):
    merged, places = merge_styles(HOSTS["no named styles"].encode(), "styles", built)
    assert all("xfId" not in entries(merged, "cellXfs")[place].attributes for place in places.cells)


def test_conditional_styles_take_the_new_number_formats(built):
    merged, places = merge_styles(ARIAL.encode(), "styles", built)
    codes = {e.attributes["numFmtId"]: e.attributes["formatCode"] for e in entries(merged, "numFmts")}
    formats = [d.find("numFmt") for d in entries(merged, "dxfs") if d.find("numFmt")]
    assert len(places.differential) == len(entries(merged, "dxfs"))
    assert formats
    assert all(codes[f.attributes["numFmtId"]] == f.attributes["formatCode"] for f in formats)


def test_an_extension_in_a_style_is_refused(build):
    def fill(book):
        book.add_worksheet().insert_checkbox("A1", True)

    with pytest.raises(ValueError, match="carry over"):
        merge_styles(ARIAL.encode(), "styles", build(fill)["xl/styles.xml"])
