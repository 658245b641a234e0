from __future__ import annotations

from xlmc.report.page.flow import Flow
from xlmc.report.sheets import assumptions, results, statistics_sheet
from xlmc.report.sheets.cells import Shown, count, text


def test_headings_paragraphs_and_tables_follow_each_other():
    flow = Flow()
    flow.title("Title", "below")
    flow.heading("One & two")
    flow.wide("Said.", "remark", 9)
    flow.table(["Name", "Trials"], [[text("a", "name"), count(1234)]])
    assert flow.html.source == (
        "<h2>Title</h2>"
        '<p class="subtitle">below</p>'
        "<h3>One &amp; two</h3>"
        '<p class="remark">Said.</p>'
        '<div class="wide-table"><table><thead><tr><th scope="col">Name</th><th scope="col" class="number">Trials</th>'
        '</tr></thead><tbody><tr><th scope="row">a</th><td class="number"><data value="1234">1,234</data></td></tr>'
        "</tbody></table></div>"
    )


def test_rows_that_are_spread_become_one_table():
    flow = Flow()
    flow.spread([text("Filter", "header left"), text("Cell", "header left")], (0, 3), 8)
    flow.spread([text("f", "name"), text("S!A1")], (0, 3), 8)
    flow.wide("After.", "remark", 8)
    source = flow.html.source
    assert source.count("<table>") == 1
    assert source.count("<tr>") == 2
    assert source.endswith('<p class="remark">After.</p>')
    assert flow.html.source == source


def test_rows_of_another_length_begin_another_table():
    flow = Flow()
    flow.spread([text("a"), text("b")], (0, 1), 1)
    flow.spread([text("c")], (0,), 1)
    assert flow.html.source.count("<table>") == 2


def test_a_sheets_writer_can_write_on_it(run):
    for write in (results.write_results, statistics_sheet.write_statistics, assumptions.write_assumptions):
        flow = Flow()
        write(flow, run)
        assert flow.html.source.count("<table>") >= 1
        assert "area" in flow.html.source or "width" in flow.html.source


def test_a_single_cell_is_a_paragraph():
    flow = Flow()
    flow.put(3, 0, Shown("nothing to draw", look="alarm"))
    assert flow.html.source == '<p class="alarm">nothing to draw</p>'
