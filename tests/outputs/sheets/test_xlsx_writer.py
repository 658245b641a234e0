"""Blocks on a sheet: where each cell stands, which are merged, and what becomes a number."""

from __future__ import annotations

import io

import openpyxl
import pytest
from xlsxwriter import Workbook

from xlmc.montecarlo.statistics import Estimate
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.measured import Measured
from xlmc.outputs.document.parts import (
    Bar,
    Bars,
    Bullets,
    Chart,
    Code,
    Drawing,
    Figure,
    Heading,
    Line,
    Lines,
    Paragraph,
    Shape,
    Table,
)
from xlmc.outputs.sheets.exact_book import ExactSheet
from xlmc.outputs.sheets.page import Page
from xlmc.outputs.sheets.styles import Styles
from xlmc.outputs.sheets.xlsx_writer import Charting, row_cells, sheet_widths, write_blocks

LONG = "a sentence of more than sixty letters, which no column of a sheet can hold"
WRAPPED = Table("", ("Name", "Meaning"), (("a", LONG), ("b", "short")))
MEASURED = Measured(Estimate(2.5, 0.1, (2.3, 2.7)), interval=True)
PLAIN = Measured(Estimate(1.5, 0.2))


@pytest.fixture
def written():
    """The sheets that blocks are written to, as openpyxl reads them."""

    def write(blocks, charted=False, **more):
        packed = io.BytesIO()
        with Workbook(packed, {"in_memory": True}) as book:
            styles = Styles(book)
            page = Page(book.add_worksheet("P", ExactSheet), styles, sheet_widths(blocks))
            numbers = Page(book.add_worksheet("N", ExactSheet), styles, ()) if charted else None
            write_blocks(page, blocks, Charting(book, lambda: numbers) if charted else None, **more)
            row = page.row
        result = openpyxl.load_workbook(packed)
        return result["P"], row

    return write


def _cells(sheet):
    return {cell.coordinate: cell.value for row in sheet for cell in row if cell.value is not None}


def _merged(sheet):
    return {each.coord for each in sheet.merged_cells.ranges}


def test_blocks_stand_below_each_other_with_a_row_after_a_table(written):
    table = Table("", ("Name", "Value"), (("a", "1.5"),), right=(1,))
    blocks = (Paragraph("one"), Bullets(("two", "three")), Code("four"), table, Paragraph("five"), table, table)
    sheet, row = written(blocks)
    assert {at: value for at, value in _cells(sheet).items() if at.startswith("A")} == {
        "A1": "one",
        "A2": "• two",
        "A3": "• three",
        "A4": "four",
        "A5": "Name",
        "A6": "a",
        "A8": "five",
        "A9": "Name",
        "A10": "a",
        "A12": "Name",
        "A13": "a",
    }
    assert sheet["B6"].value == 1.5
    assert _merged(sheet) == {"A1:F1", "A2:F2", "A3:F3", "A4:F4", "A8:F8"}
    assert row == 13


def test_a_heading_and_a_title_have_their_own_space(written):
    table = Table("Found", (), (("a", "b"),), caption="All of it.")
    caption = Table("", (), (("a", "b"),), caption="All of it.")
    sheet, row = written((table, Heading("Next"), Paragraph("one"), table, caption), last=3)
    assert _cells(sheet) == {
        "A2": "Found", "A3": "All of it.", "A4": "a", "B4": "b",
        "A6": "Next", "A7": "one",
        "A9": "Found", "A10": "All of it.", "A11": "a", "B11": "b",
        "A13": "All of it", "A14": "a", "B14": "b",
    }  # fmt: skip
    assert _merged(sheet) == {"A3:D3", "A7:D7", "A10:D10"}
    assert row == 14


def test_texts_at_the_right_that_are_numbers_become_numbers(written):
    table = Table("", ("Name", "Count", "Note"), (("1", "2", "3"), ("x", "many", "y")), right=(1,))
    sheet, _ = written((table,))
    assert [[cell.value for cell in row] for row in sheet["A2:C3"]] == [["1", 2, "3"], ["x", "many", "y"]]
    assert sheet["B3"].alignment.horizontal == "right"
    assert sheet["C3"].alignment.horizontal != "right"
    assert sheet["B1"].alignment.horizontal != sheet["A1"].alignment.horizontal == sheet["C1"].alignment.horizontal
    assert [shown.value for shown in row_cells(("1", Shown(2.0), "3"))] == ["1", 2.0, "3"]


def test_a_number_with_its_error_takes_cells_of_their_own(written):
    table = Table("", ("Name", "Speed", "Other", "Note"), (("a", MEASURED, PLAIN, "n"), ("b", PLAIN, "none", "m")))
    sheet, _ = written((table,))
    assert [[cell.value for cell in row] for row in sheet["A1:H3"]] == [
        ["Name", "Speed", "±", "95 % from", "to", "Other", "±", "Note"],
        ["a", 2.5, 0.1, 2.3, 2.7, 1.5, 0.2, "n"],
        ["b", 1.5, 0.2, None, None, "none", None, "m"],
    ]


def test_headings_over_several_cells_stand_in_a_row_of_their_own(written):
    sheet, _ = written((Table("", ("Name", "Speed", "Other"), (("a", MEASURED, PLAIN),), over="Run"),))
    assert [cell.value for cell in sheet[1]] == ["Run", "Speed", None, None, None, "Other", None]
    assert [cell.value for cell in sheet[2]] == ["Name", "Value", "±", "95 % from", "to", "Value", "±"]
    assert _merged(sheet) == {"B1:E1", "F1:G1"}


def test_texts_span_as_many_columns_as_are_asked_for(written):
    sheet, _ = written((Table("", ("Name", "Why", "N"), (("a", "because", "1"),), right=(2,), spans=(1, 3, 2)),))
    assert _cells(sheet) == {"A1": "Name", "B1": "Why", "E1": "N", "A2": "a", "B2": "because", "E2": 1}
    assert _merged(sheet) == {"B1:D1", "E1:F1", "B2:D2", "E2:F2"}


def test_a_name_and_a_long_text_reach_over_the_other_columns(written):
    sheet, row = written((WRAPPED,))
    assert _cells(sheet) == {"A1": "Name", "B1": "Meaning", "A2": "a", "B2": LONG, "A3": "b", "B3": "short"}
    assert _merged(sheet) == {"B1:F1", "B2:F2", "B3:F3"}
    assert row == 3


@pytest.mark.parametrize(
    ("blocks", "widths"),
    [
        ((), {}),
        ((Paragraph(LONG), WRAPPED), {}),
        ((Table("", ("A", "B"), (("x" * 50, "y" * 20),)),), {0: 50, 1: 20}),
        ((Table("", ("A", "B", "C"), (("x", "y" * 80, "z" * 80),), right=(2,)),), {1: 60, 2: 26}),
        ((Table("", ("A", "B"), (("x" * 40, "y" * 60),)),), {1: 60}),
        ((Table("", tuple("ABCDEFGHIJ"), ((*"abcdefghi", "j" * 30),)),), {8: 17, 9: 30}),
        ((Table("", ("A", "B", "C"), (("x", MEASURED, "z" * 40),)),), {5: 40}),
    ],
)
def test_columns_are_as_wide_as_their_longest_text_up_to_a_limit(blocks, widths):
    result = dict(enumerate(sheet_widths(blocks)))
    usual = dict(enumerate([44.0, *[17.0] * 7]))
    assert result == usual | widths


@pytest.mark.parametrize(
    ("data", "charts"),
    [
        (Lines((Line("p", ((0.0, 0.0), (1.0, 1.0))),), "y"), 1),
        (Bars((Bar("b", ((0.0, 1.0, "dark"),)),)), 1),
        (Shape((0.0, 1.0), (1.0,), (1.0,)), 0),
    ],
)
def test_lines_and_bars_are_charts_of_excels_own(written, data, charts):
    blocks = (Figure(Chart("", "x", data, "a picture"), "It shows."), Paragraph("after"))
    sheet, row = written(blocks, charted=True)
    assert len(sheet._charts) == charts
    message = _cells(sheet)
    if charts:
        [chart] = sheet._charts
        bottom = chart.anchor.to.row  # the row that the chart ends in, from 0
        assert list(message.values()) == ["It shows.", "after"]
        assert row - 2 - bottom in (0, 1)
        assert f"A{row}" in message
    else:
        assert message == {"A1": "a picture.", "A2": "It shows.", "A3": "after"}


def test_pictures_are_described_in_words_where_there_are_no_charts(written):
    lines = Chart("", "x", Lines((Line("p", ((0.0, 0.0), (1.0, 1.0))),), "y"), "a chart")
    sheet, _ = written((Figure(lines, ""), Figure(Drawing("<svg/>", "a drawing", 90.0), "Its caption.")))
    assert _cells(sheet) == {"A1": "a chart.", "A2": "a drawing.", "A3": "Its caption."}
    table = Table("", ("Name", "Picture"), (("a", Drawing("<svg/>", "a drawing", 90.0)),))
    assert written((table,))[0]["B2"].value == "a drawing"
