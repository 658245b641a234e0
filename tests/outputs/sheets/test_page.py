from __future__ import annotations

import io
import math

import openpyxl
import pytest
from xlsxwriter import Workbook

from xlmc.outputs.document.cells import Shown
from xlmc.outputs.sheets.exact_book import ExactSheet
from xlmc.outputs.sheets.page import LONGEST_TEXT, ROW, Page, cut
from xlmc.outputs.sheets.styles import Styles


@pytest.fixture
def written():
    """What openpyxl reads of a sheet that a function wrote with a page of three columns."""

    def write(act):
        packed = io.BytesIO()
        with Workbook(packed, {"in_memory": True}) as book:
            act(Page(book.add_worksheet("P", ExactSheet), Styles(book), (10, 20, 30)))
        return openpyxl.load_workbook(packed)["P"]

    return write


@pytest.mark.parametrize("text", ["=1+1", "=cmd|' /C calc'!A0", "+1", "@SUM(A1)", "{=1}", "http://x.org", "12", " a "])
def test_texts_stay_texts(written, text):
    cell = written(lambda page: page.put(0, 0, Shown(text, look="text")))["A1"]
    assert (cell.value, cell.data_type) == (text, "s")


@pytest.mark.parametrize("text", ["=1+1", "{=1}"])
def test_texts_in_merged_cells_stay_texts(written, text):
    cell = written(lambda page: page.wide(text, "paragraph", 2))["A1"]
    assert (cell.value, cell.data_type) == (text, "s")


@pytest.mark.parametrize(("number", "text"), [(math.nan, "–"), (math.inf, "∞"), (-math.inf, "−∞")])
def test_what_is_no_number_is_written_in_words(written, number, text):
    cell = written(lambda page: page.put(0, 0, Shown(number, "0.00")))["A1"]
    assert (cell.value, cell.data_type) == (text, "s")


@pytest.mark.parametrize("number", [0.1 + 0.2, 1 / 3, -1e-300, 1.7976931348623157e308, 2.0**53, 200_000])
def test_numbers_keep_every_bit_and_show_what_the_format_says(written, number):
    cell = written(lambda page: page.put(0, 0, Shown(number, "0.00")))["A1"]
    assert (cell.value, cell.number_format) == (number, "0.00")


@pytest.mark.parametrize("value", [True, False])
def test_true_and_false_are_logical_values(written, value):
    cell = written(lambda page: page.put(0, 0, Shown(value)))["A1"]
    assert (cell.value, cell.data_type) == (value, "b")


def test_an_empty_cell_has_its_look(written):
    cell = written(lambda page: page.put(0, 0, Shown(None, look="moved")))["A1"]
    assert cell.value is None
    assert cell.fill.fgColor.rgb == "FFFCE4B6"


def test_a_text_too_long_for_a_cell_is_cut_with_a_mark(written):
    text = "x" * (LONGEST_TEXT + 1)
    value = written(lambda page: page.put(0, 0, Shown(text, look="text")))["A1"].value
    assert len(value) == LONGEST_TEXT
    assert value.endswith(" [cut]")
    assert cut("x" * LONGEST_TEXT) == "x" * LONGEST_TEXT


def test_rows_are_as_high_as_their_longest_text(written):
    def act(page):
        page.line([Shown("short", look="text"), Shown("word " * 20, look="text")])
        page.line([Shown("short", look="text")])

    sheet = written(act)
    assert sheet.row_dimensions[1].height > 4 * 15
    assert sheet.row_dimensions[2].height == ROW


def test_spread_merges_up_to_the_next_start(written):
    sheet = written(lambda page: page.line([Shown("a", look="text"), Shown(1.0)], [0, 2], 2))
    assert [str(area) for area in sheet.merged_cells.ranges] == ["A1:B1"]
    assert sheet["C1"].value == 1.0


def test_a_sheet_prints_on_one_page_or_in_whole_sections(written):
    def short(page):
        page.line([Shown("text", look="text")])
        page.set_up_printing("a & b.xlsx", repeat=0)

    one = written(short)
    assert one.sheet_properties.pageSetUpPr.fitToPage
    assert (one.page_setup.fitToWidth or 1, one.page_setup.fitToHeight or 1) == (1, 1)
    assert one.print_title_rows == "$1:$1"
    assert one.oddFooter.left.text == "a && b.xlsx"

    def long(page):
        for number in range(6):
            page.heading(f"Section {number}")
            for _ in range(30):
                page.line([Shown("x", look="text"), Shown("word " * 30, look="text")], [0, 1], 12)
        page.set_up_printing("b.xlsx")

    several = written(long)
    assert several.page_setup.fitToHeight == 0
    begins = [brk.id + 1 for brk in several.row_breaks.brk]
    assert begins
    assert all(str(several.cell(row, 1).value).startswith("Section") for row in begins)


def test_what_is_not_printed_begins_a_page_of_its_own(written):
    def act(page):
        page.line([Shown("printed", look="text")])
        last = page.row
        page.line([Shown("not printed", look="text")])
        page.set_up_printing("b.xlsx", printed=last, columns=(0, 3))

    sheet = written(act)
    assert sheet.print_area.endswith("$A$1:$D$1")
    assert sheet.page_setup.fitToHeight == 0
    assert [brk.id for brk in sheet.row_breaks.brk] == [1]


def test_a_logical_has_a_format_that_says_true(written):
    cell = written(lambda page: page.put(0, 0, Shown(True, look="text")))["A1"]
    assert cell.value is True
    assert cell.number_format == '"TRUE";"TRUE";"FALSE"'
