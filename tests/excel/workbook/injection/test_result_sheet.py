from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from xlmc.excel.workbook.injection.part_numbers import free_part_names
from xlmc.excel.workbook.injection.result_sheet import (
    Renames,
    at_home,
    rename_in_xml,
    shared_items,
    with_differential,
)
from xlmc.excel.workbook.injection.styles_merge import StyleMap
from xlmc.excel.workbook.package import relative_target

STRINGS = [b"<t>zero</t>", b'<t xml:space="preserve"> &lt;c r="A1" t="s">&lt;v>0&lt;/v> </t>']
STYLES = StyleMap(cells=(5, 7), differential=(3, 4))
SAME = StyleMap(cells=(0, 1), differential=(0,))


def sheet(cells, head="", tail=""):
    return f"<worksheet>{head}<sheetData>{cells}</sheetData>{tail}</worksheet>".encode()


@pytest.mark.parametrize(
    ("built", "home"),
    [
        ('<c r="A1"><v>1</v></c>', '<c r="A1" s="5"><v>1</v></c>'),
        ('<c r="A1" s="1"/>', '<c r="A1" s="7"/>'),
        ('<c r="A1" t="b"><v>1</v></c>', '<c r="A1" s="5" t="b"><v>1</v></c>'),
        ('<c r="A1" s="1" t="str"><f>A2</f><v>x</v></c>', '<c r="A1" s="7" t="str"><f>A2</f><v>x</v></c>'),
        ('<c r="A1" t="s"><v>0</v></c>', '<c r="A1" s="5" t="inlineStr"><is><t>zero</t></is></c>'),
        ('<c r="A1" t="inlineStr"><is><t>x</t></is></c>', '<c r="A1" s="5" t="inlineStr"><is><t>x</t></is></c>'),
        ('<row r="1" s="1" customFormat="1"></row>', '<row r="1" s="7" customFormat="1"></row>'),
        ('<row r="1" spans="1:2"></row>', '<row r="1" spans="1:2"></row>'),
    ],
)
def test_cells_and_rows(built, home):
    assert at_home(sheet(built), STRINGS, STYLES) == sheet(home)


CELL = st.tuples(
    st.sampled_from(["", ' s="1"', ' s="2"']),
    st.sampled_from(
        [
            "/>",
            "><v>-1.5E-07</v></c>",
            ' t="s"><v>0</v></c>',
            ' t="s"><v>1</v></c>',
            ' t="b"><v>1</v></c>',
            ' t="e"><v>#N/A</v></c>',
        ]
    ),
)
CAREFULLY = {
    "a formula": '<c r="Z9" t="str"><f>A1&" s="1" "</f><v>x</v></c>',
    "an inline text": '<c r="Z9" t="inlineStr"><is><t> s="1"</t></is></c>',
}


@given(st.lists(CELL), st.sampled_from(sorted(CAREFULLY)))
@example([(' s="1"', ' t="s"><v>1</v></c>'), ("", "/>")], "a formula")
@example([], "an inline text")
def test_rows_of_plain_cells_become_what_they_become_beside_cells_that_need_care(cells, kind):
    """Without a formula, an inline text or a row's style, all styles are renumbered in one cut."""
    styles, careful = StyleMap(cells=(0, 7, 12), differential=()), CAREFULLY[kind]
    row = "".join(f'<c r="A{number}"{style}{rest}' for number, (style, rest) in enumerate(cells, 1))
    beside = at_home(sheet(row + careful), STRINGS, styles)
    assert beside.count(careful.encode()) == 1
    assert at_home(sheet(row), STRINGS, styles) == beside.replace(careful.encode(), b"")


def test_text_that_looks_like_markup_stays_text():
    done = at_home(sheet('<c r="A1" s="1" t="s"><v>1</v></c>'), STRINGS, STYLES)
    assert done == sheet(f'<c r="A1" s="7" t="inlineStr"><is>{STRINGS[1].decode()}</is></c>')


def test_columns_tab_and_conditional_formats():
    head = '<sheetView{} workbookViewId="0"/><cols><col min="1" max="2" style="{}"/><col min="3" max="3"/></cols>'
    tail = '<cfRule type="cellIs" dxfId="{}"/><cfRule type="dataBar"/>'
    built = sheet("", head.format(' tabSelected="1"', 1), tail.format(1))
    assert at_home(built, STRINGS, STYLES) == sheet("", head.format("", 7), tail.format(4))


def test_a_first_style_that_is_the_users_first_is_not_spelt_out():
    cells = '<c r="A1"><v>1</v></c><c r="B1" s="1"/>'
    assert at_home(sheet(cells), STRINGS, SAME) == sheet(cells)


def test_every_kind_of_conditional_style_is_renumbered_and_text_is_not():
    xml = b'<a headerRowDxfId="0" dataDxfId="1" dxfId="1"/><t> dxfId="0"</t>'
    assert with_differential(xml, STYLES) == b'<a headerRowDxfId="3" dataDxfId="4" dxfId="4"/><t> dxfId="0"</t>'


@pytest.mark.parametrize("attribute", ["cm", "vm"])
def test_metadata_is_refused(attribute):
    with pytest.raises(ValueError, match="dynamic array"):
        at_home(sheet(f'<c r="A1" s="1" {attribute}="1"><v>1</v></c>'), STRINGS, STYLES)


def test_shared_items():
    assert shared_items(b"<sst><si><t>a</t></si><si><r><t>b</t></r>\n</si></sst>") == [
        b"<t>a</t>",
        b"<r><t>b</t></r>\n",
    ]
    assert shared_items(None) == []


@pytest.mark.parametrize(
    ("built", "home"),
    [
        ("<c:f>R!$A$1</c:f>", "<c:f>'R 2'!$A$1</c:f>"),
        ('<f t="array" ref="A1">R!A1&amp;"R!"</f>', '<f t="array" ref="A1">\'R 2\'!A1&amp;&quot;R!&quot;</f>'),
        ("<formula>R!A1&gt;1</formula>", "<formula>'R 2'!A1&gt;1</formula>"),
        ('<hyperlink ref="A1" location="R!A1"/>', '<hyperlink ref="A1" location="\'R 2\'!A1"/>'),
        ('<xdr:sp macro="" textlink="R!$A$1">', '<xdr:sp macro="" textlink="\'R 2\'!$A$1">'),
        (
            "<calculatedColumnFormula>T[x]</calculatedColumnFormula>",
            "<calculatedColumnFormula>U[x]</calculatedColumnFormula>",
        ),
        ("<t>R!A1</t><formatCode>R!A1</formatCode><v>R!A1</v>", "<t>R!A1</t><formatCode>R!A1</formatCode><v>R!A1</v>"),
    ],
)
def test_names_change_in_formulas_links_and_text_boxes_only(built, home):
    renames = Renames({"r": "R 2"}, {"t": "U"})
    assert rename_in_xml(built.encode(), renames) == home.encode()
    assert rename_in_xml(built.encode(), Renames()) == built.encode()


@pytest.mark.parametrize(
    ("wanted", "taken", "result"),
    [
        ("xl/charts/chart1.xml", [], "xl/charts/chart1.xml"),
        ("xl/charts/chart1.xml", ["xl/charts/chart1.xml", "xl/charts/chart12.xml"], "xl/charts/chart13.xml"),
        ("xl/worksheets/sheet1.xml", ["xl/Worksheets/Sheet3.xml"], "xl/worksheets/sheet4.xml"),
        ("xl/media/image1.png", ["xl/media/image1.jpeg"], "xl/media/image2.png"),
        ("xl/charts/chart1.xml", ["xl/charts/colors7.xml", "chart9"], "xl/charts/chart1.xml"),
    ],
)
def test_part_names_are_free(wanted, taken, result):
    assert free_part_names([wanted], taken) == {wanted: result}


@pytest.mark.parametrize(
    ("source", "target", "pointer"),
    [
        ("xl/workbook.xml", "xl/worksheets/sheet1.xml", "worksheets/sheet1.xml"),
        ("xl/worksheets/sheet1.xml", "xl/drawings/drawing1.xml", "../drawings/drawing1.xml"),
        ("workbook.xml", "xl/styles.xml", "xl/styles.xml"),
        ("Office/deep/book.xml", "xl/styles.xml", "../../xl/styles.xml"),
    ],
)
def test_pointers_are_relative(source, target, pointer):
    assert relative_target(source, target) == pointer
