from __future__ import annotations

import io
import re

import openpyxl
import pytest

from xlmc.excel.address import Cell
from xlmc.excel.workbook.inject import inject, original_hash
from xlmc.excel.workbook.injection.content_types import roles
from xlmc.excel.workbook.injection.host import remove_result_sheets, result_sheets
from xlmc.excel.workbook.injection.splice import as_utf8, parse_spans
from xlmc.excel.workbook.injection.strict import strict_part
from xlmc.excel.workbook.package_check import checked_bytes, faults
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.writer import package_bytes

# openpyxl says what it would lose; it only looks here.
pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported:UserWarning")

FIVE = {
    "[Content_Types].xml",
    "xl/workbook.xml",
    "xl/_rels/workbook.xml.rels",
    "xl/styles.xml",
    "docProps/app.xml",
}


@pytest.fixture(scope="module")
def once(rich, results):
    return inject(rich, results)


def text_of(parts, name):
    return parse_spans(as_utf8(parts[name], name), name).canonical()


def load(parts):
    book = openpyxl.load_workbook(io.BytesIO(package_bytes(parts)), keep_vba=True)
    book.vba_archive.close()  # left open, it would complain whenever it is found to be garbage
    return book


def test_of_the_users_parts_only_the_five_change(rich, once):
    assert {name for name in rich if once.get(name) != rich[name]} == FIVE


@pytest.mark.parametrize(
    "kind",
    [
        "drawing",
        "chart",
        "media",
        "comments",
        "vmlDrawing",
        "vbaProject",
        "printerSettings",
        "threadedComment",
        "item1",
    ],
)
def test_the_rich_workbook_is_rich(rich, kind):
    assert any(kind in name for name in rich)


def test_new_parts_take_free_numbers(rich, once):
    assert sorted(name for name in once if name not in rich and "_rels" not in name) == [
        "xl/charts/chart2.xml",
        "xl/charts/chart3.xml",
        "xl/drawings/drawing2.xml",
        "xl/drawings/drawing3.xml",
        "xl/media/image2.png",
        "xl/tables/table2.xml",
        "xl/worksheets/sheet4.xml",
        "xl/worksheets/sheet5.xml",
        "xl/worksheets/sheet6.xml",
    ]


def test_every_pointer_of_a_new_part_leads_somewhere(rich, once):
    for name in once.keys() - rich.keys():
        if name.endswith(".rels") and "Target=" in once[name].decode():
            for target in re.findall(r'Target="(\.\./[^"]*)"', once[name].decode()):
                assert f"xl/{target.removeprefix('../')}" in once


def test_sheets_come_behind_the_users_own_and_theirs_stays_in_front(once):
    book = load(once)
    assert book.sheetnames == ["Scene", "Results", "Notes", "Results (2)", "Chevy's chart", "Trials"]
    assert book.active.title == "Notes"
    assert not any(b"tabSelected" in once[f"xl/worksheets/sheet{n}.xml"] for n in (4, 5, 6))


def test_cells_say_what_they_said(once):
    sheet = load(once)["Results (2)"]
    assert [cell.value for cell in sheet[1]][:3] == ["Forecast", "Mean", "Median"]
    assert [sheet[f"A{row}"].value for row in (2, 3, 4)] == ["Chevy ΔV < 40 & rising", "Ford ΔV (km/h) ", "  indented"]
    assert (sheet["B2"].value, sheet["C4"].value, sheet["C3"].value) == (31.5, True, "=AVERAGE(Trials!B2:B4)")


def test_rich_text_keeps_its_runs(once):
    assert b'<is><r><t xml:space="preserve">Ford </t></r><r><rPr><b/>' in once["xl/worksheets/sheet4.xml"]


def test_cells_look_as_they_looked(once):
    sheet = load(once)["Results (2)"]
    assert sheet["B2"].number_format == "0.000"
    assert sheet["B3"].number_format == '0.0 "km/h"'
    head = sheet["A1"]
    assert (head.font.bold, head.fill.fgColor.rgb, head.border.left.style) == (True, "FFDDEBF7", "thin")
    assert sheet.column_dimensions["C"].width > 12
    (rule,) = [rule for rules in sheet.conditional_formatting for rule in rules.rules if rule.type == "cellIs"]
    assert rule.dxf.font.color.rgb == "FF9C0006"
    assert rule.dxf.numFmt.formatCode == "0.0000"


def test_the_users_cells_look_as_they_looked(rich, once):
    before, after = load(rich)["Scene"], load(once)["Scene"]
    for cell in ("A1", "A2", "C2"):
        assert before[cell].number_format == after[cell].number_format
        assert repr(before[cell].fill) == repr(after[cell].fill)


def test_a_sheet_whose_name_is_taken_is_renamed_wherever_it_is_named(once):
    chart = once["xl/charts/chart2.xml"].decode()
    assert "<c:f>'Results (2)'!$A$2</c:f>" in chart
    assert "<c:f>Trials!$B$2:$B$4</c:f>" in chart
    assert "textlink=\"'Results (2)'!$B$2\"" in once["xl/drawings/drawing3.xml"].decode()
    assert "location=\"'Chevy''s chart'!A1\"" in once["xl/worksheets/sheet4.xml"].decode()
    assert "Target=\"#'Results (2)'!B2\"" in once["xl/drawings/_rels/drawing2.xml.rels"].decode()
    assert "localSheetId=\"3\">'Results (2)'!$1:$1<" in once["xl/workbook.xml"].decode()
    book = load(once)
    assert book["Results (2)"].print_title_rows == "$1:$1"
    assert book["Results (2)"].print_area == "'Results (2)'!$A$1:$F$9"
    assert book["Results"].print_title_rows == "$1:$1"


def test_the_users_names_stay_on_their_sheets(once):
    book = load(once)
    assert book["Scene"].defined_names["friction"].attr_text == "Scene!$A$2"
    assert book["Notes"].defined_names["friction"].attr_text == "Scene!$B$2"
    assert book.defined_names["zero"].attr_text == "0"


def test_tables_get_ids_and_names_of_their_own(once):
    tables = load(once)["Trials"].tables
    assert list(tables) == ["Trials_2"]
    assert tables["Trials_2"].id == 2
    assert b"<f>SUM(Trials_2[Trial])</f>" in once["xl/worksheets/sheet6.xml"]


def test_table_columns_keep_their_format(once):
    book = load(once)
    column = book["Trials"].tables["Trials_2"].tableColumns[1]
    assert book._differential_styles[column.dataDxfId].numFmt.formatCode == "0.000"


def test_category_axes_have_a_number_format(once):
    axes = re.findall(r"<c:catAx>.*?</c:catAx>", once["xl/charts/chart2.xml"].decode())
    assert axes
    assert all('<c:numFmt formatCode="General" sourceLinked="1"/>' in axis for axis in axes)


def test_the_workbook_stays_a_macro_workbook_with_all_its_markup(once):
    assert "vnd.ms-excel.sheet.macroEnabled.main+xml" in once["[Content_Types].xml"].decode()
    workbook = once["xl/workbook.xml"].decode()
    for markup in ('mc:Ignorable="x15"', "<x15ac:absPath", 'lockStructure="1"', "chartTrackingRefBase", "codeName="):
        assert markup in workbook


def test_the_list_of_sheets_grows(once):
    properties = once["docProps/app.xml"].decode()
    assert "<vt:i4>6</vt:i4>" in properties
    assert "<vt:lpstr>Notes</vt:lpstr><vt:lpstr>Results (2)</vt:lpstr><vt:lpstr>Chevy's chart</vt:lpstr>" in properties


def test_the_same_run_again_changes_nothing(once, results):
    assert package_bytes(inject(once, results)) == package_bytes(once)


def test_another_run_replaces_the_sheets_and_nothing_else(once, other_results):
    again = inject(once, other_results)
    assert again.keys() == once.keys()
    assert {name for name in once if again[name] != once[name]} == {"xl/worksheets/sheet4.xml"}
    assert load(again)["Results (2)"]["B2"].value == 32.5


def test_styles_do_not_grow_with_every_run(once, results, other_results):
    again = inject(inject(inject(once, other_results), results), other_results)
    assert again["xl/styles.xml"] == once["xl/styles.xml"]


def test_earlier_sheets_may_be_kept(once, results):
    both = load(inject(once, results, replace=False))
    assert both.sheetnames[3:] == [
        "Results (2)",
        "Chevy's chart",
        "Trials",
        "Results (3)",
        "Chevy's chart (2)",
        "Trials (2)",
    ]


def test_taken_out_again_the_users_workbook_is_left(rich, once):
    back = remove_result_sheets(once)
    assert back.keys() == rich.keys()
    assert {name for name in rich if back[name] != rich[name]} <= FIVE
    for name in FIVE - {"xl/styles.xml"}:
        assert text_of(back, name) == text_of(rich, name)


def test_the_fingerprint_is_that_of_the_users_workbook(rich, once, other_results):
    assert original_hash(once) == original_hash(inject(once, other_results)) == original_hash(rich)


def test_a_utf16_workbook_part_is_understood(rich, results):
    text = rich["xl/workbook.xml"].decode().replace('encoding="UTF-8"', 'encoding="UTF-16"')
    host = {**rich, "xl/workbook.xml": text.encode("utf-16")}
    assert load(inject(host, results)).sheetnames[-1] == "Trials"
    assert original_hash(inject(host, results)) == original_hash(host) == original_hash(rich)


def test_a_strict_workbook_gets_strict_sheets(build, results):
    """Every part and every relationship type is in the strict namespaces, as Excel saves them."""
    host = build(lambda book: book.add_worksheet("Only").write("A1", 1.5, book.add_format({"num_format": "0.00"})))
    host = {name: strict_part(part) if name.endswith((".xml", ".rels")) else part for name, part in host.items()}
    done = inject(host, results)
    added = {name: part for name, part in done.items() if host.get(name) != part and name.endswith((".xml", ".rels"))}
    assert len(added) > 10
    added.pop("docProps/app.xml")  # its namespace was not translated above
    old = re.compile(rb"schemas.openxmlformats.org/(?:spreadsheetml|officeDocument|drawingml)/2006")
    assert [name for name, part in added.items() if old.search(part)] == []
    assert read_workbook(package_bytes(done), "strict").content(Cell("Results", 2, 2)).value == 31.5
    assert inject(done, results) == done
    assert faults(done, done) == []


@pytest.mark.parametrize(
    "leftover",
    ["xl/worksheets/sheet4.xml", "xl/charts/chart2.xml", "xl/tables/table2.xml", "xl/drawings/drawing2.xml"],
)
@pytest.mark.parametrize("kind", ["content type", "pointer"])
def test_a_name_that_something_else_speaks_of_is_taken(rich, results, leftover, kind):
    """A content type or a pointer of a part that is not there: no new part takes its name."""
    assert leftover not in rich
    if kind == "content type":
        line = f'<Override PartName="/{leftover}" ContentType="application/xml"/></Types>'.encode()
        host = {**rich, "[Content_Types].xml": rich["[Content_Types].xml"].replace(b"</Types>", line)}
    else:
        line = f'<Relationship Id="rIdOld" Type="http://x/old" Target="/{leftover}"/></Relationships>'.encode()
        host = {
            **rich,
            "xl/_rels/workbook.xml.rels": rich["xl/_rels/workbook.xml.rels"].replace(b"</Relationships>", line),
        }
    done = inject(host, results)
    assert leftover not in done
    assert [fault for fault in faults(done, done) if fault not in faults(host, host)] == []


@pytest.mark.parametrize("name", ["cellXfs", "fonts", "fills", "borders"])
def test_an_entry_in_several_forms_is_one_style(rich, results, name):
    """As Hancom Office writes them: `mc:AlternateContent` in a list of styles counts once."""
    kind = {"cellXfs": "xf", "fonts": "font", "fills": "fill", "borders": "border"}[name]
    inner = f"<{kind}/>"
    entry = (
        '<mc:AlternateContent xmlns:mc="http://schemas.openxmlformats.org/markup-compatibility/2006">'
        f'<mc:Choice Requires="x">{inner}</mc:Choice><mc:Fallback>{inner}</mc:Fallback></mc:AlternateContent>'
    )
    styles = rich["xl/styles.xml"].decode()
    host = {**rich, "xl/styles.xml": styles.replace(f"</{name}>", f"{entry}</{name}>").encode()}
    before, after = (parse_spans(inject(each, results)["xl/styles.xml"], "styles") for each in (rich, host))
    shown = [_formats(root, inject(each, results)) for root, each in ((before, rich), (after, host))]
    assert shown[0] == shown[1]


def _formats(styles, parts):
    """What each styled cell of the result sheets shows: number format, font and fill, by what they say."""
    lists = {name: styles.find(name).children for name in ("cellXfs", "fonts", "fills", "borders")}
    codes = {each.attributes["numFmtId"]: each.attributes["formatCode"] for each in styles.find("numFmts").children}
    result = []
    for part in result_sheets(parts):
        for number in re.findall(rb'<c r="[A-Z]+[0-9]+" s="([0-9]+)"', parts[part]):
            style = lists["cellXfs"][int(number)].attributes
            places = (("fontId", "fonts"), ("fillId", "fills"), ("borderId", "borders"))
            text_of = [lists[where][int(style[what])].canonical() for what, where in places]
            result.append((codes.get(style["numFmtId"], style["numFmtId"]), text_of))
    return result


PLAIN_STYLE = {"numFmtId": "0", "fontId": "0", "fillId": "0", "borderId": "0"}


@pytest.mark.parametrize("quote", ['"', "'"])
@pytest.mark.parametrize(("encoding", "number"), [("utf-8", 5), ("utf-16", 5), ("utf-8", 70_000)])
@pytest.mark.parametrize("styles", ["with styles", "without"])
def test_a_cell_whose_style_is_not_there_gets_none_of_the_results(build, results, styles, encoding, number, quote):
    """Excel shows such a cell in the default style; a style of the result sheets must not take its number."""
    host = build(lambda book: book.add_worksheet("Only").write("A1", 45000.75))
    cell = f"<c r={quote}A1{quote} s={quote}{number}{quote}>"
    sheet = host["xl/worksheets/sheet1.xml"].decode().replace('<c r="A1">', cell).replace("UTF-8", encoding.upper())
    assert cell in sheet
    host["xl/worksheets/sheet1.xml"] = sheet.encode(encoding)
    if styles == "without":
        host.pop("xl/styles.xml")
        for name in ("[Content_Types].xml", "xl/_rels/workbook.xml.rels"):
            host[name] = re.sub(rb"<(?:Override|Relationship) [^>]*styles[^>]*>", b"", host[name])
    done = inject(host, results)
    xfs = parse_spans(done["xl/styles.xml"], "styles").find("cellXfs").children
    if number < len(xfs):
        assert {key: xfs[number].attributes.get(key) for key in PLAIN_STYLE} == PLAIN_STYLE
        assert not xfs[number].children
    else:
        assert number == 70_000  # more styles than Excel takes
    used = b"".join(done[part] for part in result_sheets(done))
    assert max(int(result) for result in re.findall(rb' s="([0-9]+)"', used)) < len(xfs)
    assert f' s="{number}"'.encode() not in used
    assert '0.0 "km/h"' in [code for code, _ in _formats(parse_spans(done["xl/styles.xml"], "styles"), done)]
    again = inject(done, results)
    assert again["xl/styles.xml"] == done["xl/styles.xml"]
    assert inject(again, results) == again
    assert checked_bytes(again, host)


def test_a_workbook_without_styles_takes_those_of_the_results(rich, results):
    bare = {name: part for name, part in rich.items() if name != "xl/styles.xml"}
    for name in ("[Content_Types].xml", "xl/_rels/workbook.xml.rels"):
        bare[name] = re.sub(rb"<(?:Override|Relationship) [^>]*styles[^>]*>", b"", bare[name])
    bare["xl/worksheets/sheet1.xml"] = re.sub(rb' (?:s|dxfId)="\d+"', b"", bare["xl/worksheets/sheet1.xml"])
    assert roles(bare).styles is None
    done = inject(bare, results)
    assert load(done)["Results (2)"]["B2"].number_format == "0.000"
    assert original_hash(done) == original_hash(bare)
    assert inject(inject(done, results), results) == inject(done, results)


def test_a_book_without_names_views_and_properties_gets_what_the_sheets_need(build, results):
    host = build(lambda book: book.add_worksheet("Only"))
    workbook = re.sub(rb"<bookViews>.*?</bookViews>", b"", host["xl/workbook.xml"])
    assert b"definedNames" not in workbook
    host = {name: part for name, part in host.items() if name != "docProps/app.xml"} | {"xl/workbook.xml": workbook}
    host["_rels/.rels"] = re.sub(rb"<Relationship [^>]*extended-properties[^>]*>", b"", host["_rels/.rels"])
    done = inject(host, results)
    order = re.findall(r"<(bookViews|sheets|definedNames|calcPr)\b", done["xl/workbook.xml"].decode())
    assert order == ["bookViews", "sheets", "definedNames", "calcPr"]
    assert "docProps/app.xml" not in done
    assert original_hash(done) == original_hash(host)


def test_names_for_the_whole_workbook_are_refused(rich, build):
    def fill(book):
        book.add_worksheet("Results")
        book.define_name("mean", "=Results!$A$1")

    with pytest.raises(ValueError, match="mean"):
        inject(rich, build(fill))


def test_dynamic_arrays_are_refused(rich, build):
    with pytest.raises(ValueError, match="dynamic array"):
        inject(rich, build(lambda book: book.add_worksheet().write_dynamic_array_formula("A1", "=SEQUENCE(3)")))


def test_hidden_result_sheets_stay_hidden(rich, build):
    def fill(book):
        book.add_worksheet("Results")
        book.add_worksheet("Record").hide()

    assert load(inject(rich, build(fill)))["Record"].sheet_state == "hidden"


def test_chart_sheets_are_refused(rich, build):
    def fill(book):
        chart = book.add_chart({"type": "line"})
        chart.add_series({"values": "=Results!$A$1:$A$2"})
        book.add_worksheet("Results")
        book.add_chartsheet("Picture").set_chart(chart)

    with pytest.raises(ValueError, match="Picture"):
        inject(rich, build(fill))
