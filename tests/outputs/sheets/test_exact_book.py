"""What is overridden of XlsxWriter's inside writes what XlsxWriter writes by itself, but for digits."""

from __future__ import annotations

import datetime
import inspect
import io
import random

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from xlsxwriter import Workbook
from xlsxwriter.chart import Chart
from xlsxwriter.format import Format
from xlsxwriter.packager import Packager
from xlsxwriter.worksheet import CellNumberTuple, CellStringTuple, Worksheet

from xlmc.excel.workbook.package import read_parts
from xlmc.outputs.sheets.exact_book import ExactBook

INSIDE = {
    Worksheet: {
        "_write_rows": "self",
        "_write_row": "self row spans row_info empty_row",
        "_write_empty_row": "self row spans row_info",
        "_write_cell": "self row col cell",
        "_xml_number_element": "self number attributes",
        "_get_range_data": "self row_start col_start row_end col_end",
        "_check_dimensions": "self row col ignore_row ignore_col",
        "_size_row": "self row anchor",
        "_size_col": "self col anchor",
    },
    Workbook: {"_get_packager": "self"},
    Packager: {"_create_package": "self"},
    Chart: {"_write_num_cache": "self data", "_write_c_smooth": "self smooth", "_xml_empty_tag": "self tag attributes"},
    Format: {"_get_xf_index": "self"},
}
"""What xlmc overrides or calls of XlsxWriter's inside, with its parameters."""


def test_xlsxwriter_has_the_inner_methods_that_are_overridden_and_called():
    """Where this fails with a newer XlsxWriter, look at each of them before its bound in pyproject.toml is moved."""
    for kind, methods in INSIDE.items():
        result = {name: " ".join(inspect.signature(getattr(kind, name)).parameters) for name in methods}
        assert result == methods, kind
    assert CellNumberTuple._fields == ("number", "format")
    assert CellStringTuple._fields == ("string", "format")
    sheet = Workbook(io.BytesIO()).add_worksheet()
    sheet.set_row(1, 20)
    assert vars(sheet.row_info[1]).keys() == {"height", "row_format", "hidden", "level", "collapsed"}
    assert {"table", "row_spans", "dim_rowmin", "dim_rowmax", "fh"} <= vars(sheet).keys()


def fill(book, numbers):
    """Cells of all kinds, with and without styles of their own, of their row and of their column."""
    bold, red = book.add_format({"bold": True}), book.add_format({"font_color": "red", "num_format": "0.00"})
    sheet = book.add_worksheet("Model")
    sheet.set_default_row(17.25)
    sheet.set_column(2, 3, 11, red)
    sheet.set_row(4, 30, bold)
    sheet.freeze_panes(1, 1)
    for row in range(40):
        for column in numbers.sample(range(60), 7):
            kind = numbers.randrange(6)
            style = numbers.choice([None, bold, red])
            if kind == 0:
                sheet.write_string(row, column, numbers.choice(["a", "<&>", "ΔV", "  b"]), style)
            elif kind == 1:
                sheet.write_blank(row, column, None, style or bold)
            elif kind == 2:
                sheet.write_formula(row, column, "=1+1", style, 2)
            elif kind == 3:
                sheet.write_boolean(row, column, True, style)
            elif row != 20:  # a row without cells
                sheet.write_number(row, column, numbers.choice([0, 1, -2.5, 0.125, 0.1, 12345678]), style)
    sheet.merge_range(50, 0, 50, 5, "wide", bold)
    empty = book.add_worksheet("Empty")
    empty.write_url(0, 0, "internal:Model!A1")
    chart = book.add_chart({"type": "line"})
    chart.add_series({"values": ["Model", 0, 1, 9, 1]})
    sheet.insert_chart("H2", chart)


OPTIONS = {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False}
CLOCK = "docProps/core.xml"
SHORT = st.integers(-(10**10), 10**10).map(lambda number: number / 64)
"""Numbers of at most 15 digits, of which XlsxWriter writes all."""
TEXT = st.text(st.sampled_from("a<&>\"' =#\n\t\x01\u00e9\u0394\U0001f600_x0041_"), max_size=12)
NUMBERLIKE = [" 1", "\n1", "\x1c1", "\x0b1", "\xa01", "\x851", "١", "1_0", "nan"]
"""Texts that Python reads as numbers."""
WRITES = st.one_of(
    st.tuples(st.just("write_number"), SHORT),
    st.tuples(st.just("write_string"), TEXT.filter(bool)),
    st.tuples(st.just("write_blank"), st.none()),
    st.tuples(st.just("write_boolean"), st.booleans()),
    st.tuples(st.just("write_datetime"), st.dates(datetime.date(1901, 1, 1), datetime.date(9999, 1, 1))),
    st.tuples(st.just("write_formula"), st.just('=1/0&" s=""2"""'), st.sampled_from(["#DIV/0!", "#N/A"])),
)
PLACE = st.tuples(st.integers(0, 40), st.integers(0, 6))
CELLS = st.lists(st.tuples(PLACE, WRITES, st.booleans()), max_size=12)
RUNS = st.lists(st.tuples(PLACE, st.lists(SHORT, min_size=1, max_size=25), st.booleans()), max_size=6)
HEIGHTS = st.dictionaries(st.integers(0, 70), st.sampled_from([15, 17.25, 30]), max_size=5)


def one_after_another(sheet, row, column, values, style):
    for at, value in enumerate(values, row):
        sheet.write_number(at, column, value, style)


def written(book, write_run, cells, runs, later, heights):
    """Cells before and after runs of numbers, rows of some heights, and a chart that shows them."""
    styles = [book.add_format({"bold": True}), book.add_format({"num_format": "0.00"})]
    sheet = book.add_worksheet("Model")
    for row, height in heights.items():
        sheet.set_row(row, height)
    for place, (method, *rest), second in cells:
        getattr(sheet, method)(*place, *rest[:1], styles[second], *rest[1:])
    for place, values, second in runs:
        write_run(sheet, *place, values, styles[second])
    for place, (method, *rest), second in later:
        getattr(sheet, method)(*place, *rest[:1], styles[second], *rest[1:])
    chart = book.add_chart({"type": "line"})
    for column in range(4):
        chart.add_series({"values": ["Model", 2, column, 30, column]})
    sheet.insert_chart("K2", chart)


@given(CELLS, RUNS, CELLS, HEIGHTS)
@example([((row, 1), ("write_string", text), False) for row, text in enumerate(NUMBERLIKE, 3)], [], [], {})
def test_runs_of_numbers_among_cells_are_what_xlsxwriter_writes_cell_by_cell(cells, runs, later, heights):
    packed = io.BytesIO()
    with Workbook(packed, OPTIONS) as plain:
        written(plain, one_after_another, cells, runs, later, heights)
    with ExactBook() as exact:
        written(exact, lambda sheet, *run: sheet.write_numbers(*run), cells, runs, later, heights)
    theirs = read_parts(packed.getvalue())
    assert {**exact.parts, CLOCK: b""} == {**theirs, CLOCK: b""}


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=30))
def test_every_number_of_a_run_is_read_back_as_the_same_number(numbers):
    with ExactBook() as book:
        book.add_worksheet().write_numbers(0, 0, numbers, book.add_format({}))
    result = book.parts["xl/worksheets/sheet1.xml"].split(b"<v>")[1:]
    assert [float(each.partition(b"</v>")[0]).hex() for each in result] == [number.hex() for number in numbers]


@pytest.mark.parametrize("seed", range(5))
def test_parts_are_those_of_a_file_of_xlsxwriters(seed):
    packed = io.BytesIO()
    with Workbook(packed, OPTIONS) as plain:
        fill(plain, random.Random(seed))
    with ExactBook() as exact:
        fill(exact, random.Random(seed))
    theirs = read_parts(packed.getvalue())
    clock = "docProps/core.xml"
    assert list(exact.parts) == list(theirs)
    assert {**exact.parts, clock: b""} == {**theirs, clock: b""}


def test_a_column_of_numbers_is_one_number_after_another():
    def parts(write):
        with ExactBook() as book:
            write(book.add_worksheet(), book.add_format({"bold": True}))
        return {**book.parts, "docProps/core.xml": b""}

    values = [1.5, -2, 1 / 3, 0.0]
    at_once = parts(lambda sheet, style: sheet.write_numbers(3, 2, values, style))
    assert at_once == parts(
        lambda sheet, style: [sheet.write_number(3 + i, 2, value, style) for i, value in enumerate(values)]
    )


def test_a_column_that_a_sheet_has_no_room_for_is_refused():
    with ExactBook() as book, pytest.raises(ValueError, match="a sheet has no row 1048577"):
        book.add_worksheet().write_numbers(1_048_575, 0, [1.0, 2.0], book.add_format({}))


@pytest.mark.parametrize("number", [0.1 + 0.2, 1 / 3, 2.0**-1074, 1.7976931348623157e308, -0.1, 7, 123456789012345678])
@pytest.mark.parametrize("styled", [True, False])
def test_a_number_is_read_back_as_the_same_number(number, styled):
    with ExactBook() as book:
        book.add_worksheet().write_number(0, 0, number, book.add_format({"bold": True}) if styled else None)
    written = book.parts["xl/worksheets/sheet1.xml"].partition(b"<v>")[2].partition(b"</v>")[0]
    assert float(written) == float(number)


def test_a_chart_of_a_wide_sheet_looks_at_its_own_columns():
    book = ExactBook()
    sheet = book.add_worksheet()
    for column in range(300):
        sheet.write_number(1, column, column)
    sheet.write_numbers(0, 4, [0.5, 1.5], book.add_format())
    result = sheet._with_runs(0, 3, 1, 5)
    assert {row: {column: cell.number for column, cell in cells.items()} for row, cells in result.items()} == {
        0: {4: 0.5},
        1: {3: 3, 4: 1.5, 5: 5},
    }
