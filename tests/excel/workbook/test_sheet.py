import pytest

from xlmc.errors import ErrorCode, WorkbookError
from xlmc.excel.address import Area, Cell
from xlmc.excel.workbook.sheet import CellContext, parse_sheet
from xlmc.excel.workbook.structure import SheetEntry
from xlmc.excel.workbook.workbook import CellContent, DataTable, Formula

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
STRICT = "http://purl.oclc.org/ooxml/spreadsheetml/main"
CONTEXT = CellContext(strings=("speed", "mass"), dynamic_marks=frozenset({"1"}))
ENTRY = SheetEntry("My sheet", "xl/worksheets/sheet1.xml", "worksheet", visible=True)


def parsed(content, namespace=MAIN):
    return parse_sheet(f'<worksheet xmlns="{namespace}">{content}</worksheet>'.encode(), ENTRY, CONTEXT)


def cells(rows):
    return dict(parsed(f"<sheetData>{rows}</sheetData>").cells)


VALUES = {
    '<c r="B7"><v>1.5</v></c>': 1.5,
    '<c r="B7" t="n"><v> 1.5 </v></c>': 1.5,
    '<c r="B7" s="3" t="s"><v>1</v></c>': "mass",
    '<c r="B7" t="b"><v>1</v></c>': True,
    '<c r="B7" t="e"><v>#NUM!</v></c>': ErrorCode.NUM,
    '<c r="B7" t="str"><v></v></c>': "",
    '<c r="B7" t="d"><v>2001-03-11</v></c>': 36961.0,
    '<c r="B7" t="inlineStr"><is><t>Ford</t></is></c>': "Ford",
    '<c r="B7" t="inlineStr"><is><t> F </t></is></c>': "F",
    '<c r="B7" t="inlineStr"><is><t xml:space="preserve"> F_x000a_</t></is></c>': " F\n",
    '<c r="B7" t="inlineStr"><is><r><t>Fo</t></r><r><t>rd</t></r><rPh><t>no</t></rPh></is></c>': "Ford",
    '<c r="B7" t="inlineStr"><is/></c>': "",
    '<c r="B7" t="inlineStr"><is><t>Ford</t></is><v>5</v></c>': "Ford",
    '<c r="B7"><v>1</v><extLst><ext><f xmlns="urn:other">A1</f></ext></extLst></c>': 1.0,
}


@pytest.mark.parametrize(("cell", "value"), VALUES.items())
def test_values(cell, value):
    result = cells(f'<row r="7">{cell}</row>')
    assert result == {(7, 2): CellContent(value)}
    assert type(result[7, 2].value) is type(value)


@pytest.mark.parametrize(
    "cell", ['<c r="B7" s="3"/>', '<c r="B7" t="s"/>', '<c r="B7"><f></f></c>', '<c r="B7" t="inlineStr"><v>5</v></c>']
)
def test_blank_cells_are_left_out(cell):
    assert cells(f'<row r="7">{cell}</row>') == {}


@pytest.mark.parametrize(
    ("rows", "places"),
    [
        ("<row><c><v>1</v></c><c><v>2</v></c></row><row><c><v>3</v></c></row>", [(1, 1), (1, 2), (2, 1)]),
        ('<row r="5"><c r="D5"><v>1</v></c><c><v>2</v></c></row><row><c><v>3</v></c></row>', [(5, 4), (5, 5), (6, 1)]),
        ('<row r="5"><c/><c><v>2</v></c></row>', [(5, 2)]),
        ('<row><c r="XFD1048576"><v>1</v></c></row>', [(1_048_576, 16_384)]),
    ],
)
def test_cells_without_address_follow_one_another(rows, places):
    assert list(cells(rows)) == places


FORMULAS = {
    "<f>SUM(A1:A3)*2</f>": "SUM(A1:A3)*2",
    '<f>IF(A1&lt;&gt;"a&amp;b",1,2)</f>': 'IF(A1<>"a&b",1,2)',
    "<f>=A1</f>": "A1",
    '<f xml:space="preserve">A1 +\n  A2</f>': "A1 +\n  A2",
    '<f ca="1">RAND()</f>': "RAND()",
    '<f t="normal">A1</f>': "A1",
    "<f>Speed_x000a_1</f>": "Speed\n1",
}


@pytest.mark.parametrize(("formula", "text"), FORMULAS.items())
def test_plain_formulas(formula, text):
    result = cells(f'<row r="2"><c r="C2">{formula}<v>3</v></c></row>')
    assert result == {(2, 3): CellContent(3.0, Formula(text, 2, 3))}


def test_a_formula_without_cached_value():
    assert cells('<row r="1"><c r="A1"><f>B1</f></c></row>') == {(1, 1): CellContent(None, Formula("B1", 1, 1))}


def test_children_of_a_shared_formula_carry_their_master():
    result = cells(
        '<row r="1"><c r="B1"><f t="shared" ref="B1:B3" si="0">A1*2</f><v>2</v></c></row>'
        '<row r="2"><c r="B2"><f t="shared" si="0"/><v>4</v></c></row>'
        '<row r="3"><c r="B3"><f t="shared" si="0">IGNORED()</f><v>6</v></c></row>'
    )
    assert {content.formula for content in result.values()} == {Formula("A1*2", 1, 2)}
    assert [content.value for content in result.values()] == [2.0, 4.0, 6.0]


def test_shared_formulas_keep_apart_and_a_new_master_takes_over():
    result = cells(
        '<row r="1"><c r="A1"><f t="shared" ref="A1:A2" si="0">X1</f></c>'
        '<c r="B1"><f t="shared" ref="B1:B2" si="1">Y1</f></c></row>'
        '<row r="2"><c r="A2"><f t="shared" si="0"/></c><c r="B2"><f t="shared" si="1"/></c></row>'
        '<row r="3"><c r="A3"><f t="shared" ref="A3:A4" si="0">Z3</f></c></row>'
        '<row r="4"><c r="A4"><f t="shared" si="0"/></c></row>'
    )
    texts = {place: content.formula.text for place, content in result.items() if content.formula}
    assert texts == {(1, 1): "X1", (1, 2): "Y1", (2, 1): "X1", (2, 2): "Y1", (3, 1): "Z3", (4, 1): "Z3"}


@pytest.mark.parametrize(("mark", "dynamic"), [("", False), ('cm="1"', True), ('cm="2"', False)])
def test_array_formulas(mark, dynamic):
    result = cells(
        f'<row r="1"><c r="A1" {mark}><f t="array" ref="A1:A2">B1:B2*2</f><v>2</v></c></row>'
        '<row r="2"><c r="A2"><v>4</v></c></row>'
    )
    array = Formula("B1:B2*2", 1, 1, array=Area("My sheet", 1, 1, 2, 1), dynamic=dynamic)
    assert result == {(1, 1): CellContent(2.0, array), (2, 1): CellContent(4.0)}


def test_data_tables_are_values():
    sheet = parsed(
        '<sheetData><row r="4"><c r="C4"><f t="dataTable" ref="C4:C5" dt2D="0" dtr="0" r1="B1"/><v>1</v></c></row>'
        '<row r="5"><c r="C5"><v>2</v></c></row></sheetData>'
    )
    assert sheet.cells == {(4, 3): CellContent(1.0), (5, 3): CellContent(2.0)}
    assert sheet.data_tables == (DataTable(Area("My sheet", 4, 3, 5, 3), (Cell("My sheet", 1, 2),)),)
    assert [cell.a1 for cell in sheet.data_tables[0].margins()] == ["C3", "B4", "B5"]


def test_a_data_table_of_two_inputs():
    sheet = parsed(
        '<sheetData><row r="4"><c r="C4"><f t="dataTable" ref="C4:C4" dt2D="1" dtr="1" r1="B1" r2="B2"/><v>1</v></c>'
        "</row></sheetData>"
    )
    (table,) = sheet.data_tables
    assert [cell.a1 for cell in table.inputs] == ["B1", "B2"]
    assert [cell.a1 for cell in table.margins()] == ["B3", "C3", "B4"]


def test_a_data_table_whose_input_was_deleted():
    sheet = parsed(
        '<sheetData><row r="4"><c r="C4"><f t="dataTable" ref="C4:C5" r1="#REF!" del1="1"/><v>1</v></c></row>'
        "</sheetData>"
    )
    assert sheet.data_tables[0].inputs == ()


def test_merged_areas():
    sheet = parsed('<sheetData/><mergeCells count="2"><mergeCell ref="A1:B2"/><mergeCell ref="D4"/></mergeCells>')
    assert sheet.merged == (Area("My sheet", 1, 1, 2, 2), Area("My sheet", 4, 4, 4, 4))


def test_the_sheet_is_told_of_its_tab():
    sheet = parsed("<sheetData/>")
    assert (sheet.name, sheet.part, sheet.visible, sheet.cells) == (ENTRY.name, ENTRY.part, True, {})


SHEET = '<sheetData><row r="1"><c r="A1"><f>1+1</f><v>2</v></c></row></sheetData>'
EXPECTED = {(1, 1): CellContent(2.0, Formula("1+1", 1, 1))}


def test_strict_files():
    assert parsed(SHEET, STRICT).cells == EXPECTED


def test_prefixed_files():
    prefixed = SHEET.replace("</", "</x:").replace("<", "<x:").replace("<x:/x:", "</x:")
    xml = f'<x:worksheet xmlns:x="{MAIN}">{prefixed}</x:worksheet>'
    assert parse_sheet(xml.encode(), ENTRY, CONTEXT).cells == EXPECTED


def test_elements_of_other_namespaces_are_not_cells():
    other = '<extLst xmlns:x="urn:other"><x:c r="A2"><x:f>Sheet1!A1</x:f><x:v>9</x:v></x:c></extLst>'
    assert parsed(SHEET + other).cells == EXPECTED


@pytest.mark.parametrize(
    ("cell", "message"),
    [
        ('<c r="B7"><v>fast</v></c>', "The cell holds 'fast' where a number should be"),
        ('<c r="B7" t="s"><v>2</v></c>', "The cell holds a text that the workbook does not"),
        ('<c r="B7" t="q"><v>2</v></c>', "The cell is of the unknown type 'q'"),
        ('<c r="B7"><f t="shared" si="4"/><v>2</v></c>', "The cell shares formula 4, which no earlier cell holds"),
        ('<c r="B7"><f t="shared"/><v>2</v></c>', "shares a formula without a number, which no earlier cell holds"),
        ('<c r="B7"><v>1</v></c><c r="B7"><v>2</v></c>', "The cell stands in the file twice"),
    ],
)
def test_complaints_name_the_cell(cell, message):
    with pytest.raises(WorkbookError, match=message) as caught:
        cells(f'<row r="7">{cell}</row>')
    assert caught.value.where == "'My sheet'!B7"


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ('<row r="1"><c r="1A"/></row>', "A cell of sheet 'My sheet' has the address '1A'"),
        ('<row r="1"><c r="$A$1"/></row>', "has the address"),
        ('<row r="1"><c r="XFE1"/></row>', "lies outside the sheet"),
        ('<row r="1"><c r="A1048577"/></row>', "lies outside the sheet"),
        ('<row r="1048577"><c/></row>', "lies outside the sheet"),
        ("<c/>", "lies outside the sheet"),
        ('<row r="0"/>', "A row of sheet 'My sheet' has the number '0'"),
        ('<row r="-1"/>', "has the number '-1'"),
        (
            '<row r="1"><c r="A1"><f t="array">B1</f></c></row>',
            "An array formula of sheet 'My sheet' has no valid range",
        ),
        ('<row r="1"><c r="A1"><f t="dataTable"/></c></row>', "A data table of sheet 'My sheet' has no valid range"),
        ('<mergeCell ref="A1:ZZZ9"/>', "A merged cell of sheet 'My sheet' has no valid range"),
        ("<row>", "is not well-formed XML"),
    ],
)
def test_other_complaints_name_the_sheet_or_part(content, message):
    with pytest.raises(WorkbookError, match=message) as caught:
        cells(content)
    assert caught.value.where is None  # the reader, which knows the file, fills it in
    assert caught.value.hint


def test_a_document_type_is_refused():
    with pytest.raises(WorkbookError, match="A document type or entities are declared"):
        parse_sheet(b"<!DOCTYPE worksheet><worksheet/>", ENTRY, CONTEXT)


@pytest.mark.parametrize(
    ("namespace", "sentence"),
    [("", "'My sheet' is in no XML namespace"), ("urn:other", "'My sheet' is in the XML namespace 'urn:")],
)
def test_a_worksheet_in_a_foreign_namespace_is_refused_and_not_blank(namespace, sentence):
    with pytest.raises(WorkbookError, match=sentence):
        parsed("<sheetData/>", namespace)
