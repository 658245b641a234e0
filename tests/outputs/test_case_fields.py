from __future__ import annotations

from datetime import date

import pytest

from xlmc.errors import DefinitionError, SimulationError
from xlmc.excel.address import Area
from xlmc.excel.workbook.workbook import CellContent, Sheet, Table, Workbook
from xlmc.montecarlo.definitions.definitions_reader import read_definitions
from xlmc.outputs.case_fields import case_of, fields_from


def book(*rows, tables=1, columns=("Field", "Text"), from_1904=False):
    cells = {(1, number): CellContent(head) for number, head in enumerate(columns, 1)}
    for row, values in enumerate(rows, 2):
        cells |= {(row, number): CellContent(value) for number, value in enumerate(values, 1)}
    area = Area("S", 1, 1, len(rows) + 1, len(columns))
    listed = tuple(Table(f"xlmc_case{number or ''}", area, columns) for number in range(tables))
    return Workbook("book.xlsx", {"S": Sheet("S", "part", cells)}, tables=listed, date1904=from_1904)


def test_fields_come_from_the_table_in_the_order_of_the_report_and_others_after_them():
    rows = ("Client", "A. B."), ("case NUMBER", 17.0), ("Organization", " Doe & Sons "), ("Title", "Main St")
    result = case_of(book(*rows), {})
    assert list(result.fields.items()) == [
        ("Title", "Main St"),
        ("Case number", "17"),
        ("Organisation", "Doe & Sons"),
        ("Client", "A. B."),
    ]
    assert result.dated is None
    assert result["Analyst"] == ""


def test_what_is_given_wins_and_an_empty_text_leaves_a_field_out():
    result = case_of(book(("Title", "Main St"), ("Client", "A. B.")), {"title": "Elm St", "Client": ""})
    assert dict(result.fields) == {"Title": "Elm St"}


@pytest.mark.parametrize(
    ("value", "from_1904", "dated", "printed"),
    [
        (46349.0, False, date(2026, 11, 23), "23 November 2026"),
        (44887.25, True, date(2026, 11, 23), "23 November 2026"),
        ("2026-11-23", False, date(2026, 11, 23), "23 November 2026"),
        ("last autumn", False, None, "last autumn"),
        (-5.0, False, None, "-5"),
    ],
)
def test_a_date_may_be_a_number_of_excel_or_a_text(value, from_1904, dated, printed):
    result = case_of(book(("Date", value), from_1904=from_1904), {})
    assert (result.dated, result["Date"]) == (dated, printed)


def test_no_table_gives_no_fields():
    result = case_of(book(tables=0), {})
    assert dict(result.fields) == {}


@pytest.mark.parametrize(
    ("workbook", "sentence"),
    [
        (book(("Date", 1.0), ("date", 2.0)), "Date occurs twice in xlmc_case"),
        (book(tables=2), "both say whose case this is"),
        (book(("Date", 1.0, 2.0), columns=("a", "b", "c")), "must have two columns"),
    ],
)
def test_a_table_that_says_two_things_is_refused_with_its_cell(workbook, sentence):
    with pytest.raises(DefinitionError, match=sentence) as refused:
        case_of(workbook, {})
    assert "S!" in str(refused.value)


@pytest.mark.parametrize("text", ["Case number", "=17", "  = x"])
def test_a_field_that_is_typed_without_a_name_or_a_text_is_refused(text):
    with pytest.raises(SimulationError, match="A field of the case is not"):
        fields_from([text])


def test_a_text_may_hold_an_equals_sign():
    assert fields_from(["Client=a=b"]) == {"Client": "a=b"}


def test_a_run_reads_no_case_and_says_nothing_of_it():
    result = read_definitions(book(("Title", "Main St")), ["numpy"])
    assert [each.message for each in result.notices if "xlmc_case" in each.message] == []
    assert [each.message for each in result.problems if "xlmc_case" in each.message] == []
