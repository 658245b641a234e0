from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.reserved_tables import definition_tables
from xlmc.montecarlo.definitions.tables.table_rows import as_text, rows_of

HEADINGS = ["Name", " CELL ", "At_Least", "Comment"]


def names_of(book, tables, known=("Name", "Cell", "At least")):
    findings = Findings()
    result = definition_tables(book, findings)[tables]
    return [row.content("name").value for row in rows_of(book, result, ("Name",), known, findings)], findings


@pytest.mark.parametrize(
    "name",
    ["xlmc_filters", "XLMC_Filters", "xlmc_filters3", "xlmc_filters_2", "xlmc_filters_chevy"],
)
def test_names_that_are_read(make_book, blocks, name):
    book = make_book(blocks("S!B2", [HEADINGS, ["a"], ["b"]]), [(name, "S!B2:E4")])
    names, findings = names_of(book, "xlmc_filters")
    assert names == ["a", "b"]
    assert findings.notices == findings.problems == []


@pytest.mark.parametrize("name", ["Table1", "my_xlmc_filters_of_old", "xlmc", "filters"])
def test_names_that_are_not_read(make_book, blocks, name):
    book = make_book(blocks("S!B2", [HEADINGS, ["a"]]), [(name, "S!B2:E3")])
    findings = Findings()
    assert not any(definition_tables(book, findings).values())
    assert findings.problems == []


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("xlmc_filter", "xlmc_filters"),
        ("xlmc_fliters", "xlmc_filters"),
        ("xlmc_filter_chevy", "xlmc_filters"),
        ("xlmcfilters", "xlmc_filters"),
        ("xmlc_filters", "xlmc_filters"),
        ("XLMC_Assumption", "xlmc_assumptions"),
        ("xlmc_assumption3", "xlmc_assumptions"),
        ("xlmc_forecast", "xlmc_forecasts"),
        ("xlmc_corelations", "xlmc_correlations"),
        ("xlmc_setting", "xlmc_settings"),
    ],
)
def test_a_table_whose_name_is_misspelt_is_refused(make_book, blocks, name, meant):
    """A table of filters that is not read would let every trial pass."""
    book = make_book(blocks("S!B2", [HEADINGS, ["a"]]), [(name, "S!B2:E3")])
    _, findings = names_of(book, "xlmc_filters")
    (problem,) = findings.problems
    assert problem.where == "S!B2"
    assert problem.message == f"The table {name} is not read: did you mean {meant}?"
    assert problem.hint.startswith(f"Rename it {meant}")


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("xlmc_notes", "xlmc reads xlmc_assumptions, xlmc_forecasts"),
        ("xlmc_results", "xlmc reads xlmc_assumptions, xlmc_forecasts"),
        ("Assumptions", "did you mean xlmc_assumptions?"),
    ],
)
def test_another_name_that_may_be_meant_for_xlmc_gets_a_notice(make_book, blocks, name, expected):
    book = make_book(blocks("S!B2", [HEADINGS, ["a"]]), [(name, "S!B2:E3")])
    _, findings = names_of(book, "xlmc_filters")
    assert findings.problems == []
    (notice,) = findings.notices
    assert str(notice).startswith(f"S!B2: The table {name} is not read: {expected}")


def test_totals_and_blank_rows_are_left_out(make_book, blocks):
    rows = [HEADINGS, ["a"], [None], ["  "], [None, None, None, "x"], ["b"], ["Total"]]
    book = make_book(blocks("S!B2", rows), [("xlmc_filters", "S!B2:E8", 1)])
    assert names_of(book, "xlmc_filters")[0] == ["a", None, "b"]


def test_a_row_with_an_uncalculated_formula_is_not_blank(make_book, blocks):
    rows = [HEADINGS, [None, "=S!A1"], [None, ("=A1&A2", "")]]
    book = make_book(blocks("S!B2", rows), [("xlmc_filters", "S!B2:E4")])
    assert len(names_of(book, "xlmc_filters")[0]) == 1


@pytest.mark.parametrize("heading", ["at least", "AT LEAST", " At-Least ", "at_least", "AtLeast"])
def test_any_spelling_of_a_heading(make_book, blocks, heading):
    book = make_book(blocks("S!B2", [HEADINGS, ["a", None, 5]]), [("xlmc_filters", "S!B2:E3")])
    findings = Findings()
    tables = definition_tables(book, findings)["xlmc_filters"]
    (row,) = rows_of(book, tables, (), ("Name",), findings)
    assert row.content(heading).value == 5
    assert str(row.cell(heading)) == "S!D3"
    assert row.heading(heading) == "At_Least"


def test_notes_are_the_columns_nobody_reads(make_book, blocks):
    headings = ["Name", "Comment", "Marked", "Error", "Empty"]
    cells = blocks("S!A1", [headings, ["a", 0.1, True, ErrorCode.NA, None]])
    book = make_book(cells, [("xlmc_filters", "S!A1:E2")])
    findings = Findings()
    (row,) = rows_of(book, definition_tables(book, findings)["xlmc_filters"], (), ("name",), findings)
    assert row.notes(("Name",)) == {"Comment": "0.1", "Marked": "TRUE", "Error": "#N/A"}


@pytest.mark.parametrize(
    ("value", "text"),
    [(None, ""), (True, "TRUE"), (12.0, "12"), (0.1, "0.1"), (" a ", "a"), (ErrorCode.DIV0, "#DIV/0!")],
)
def test_values_as_text(value, text):
    assert as_text(value) == text


def test_two_headings_that_are_one(only_problem):
    only_problem(
        "Inputs!P1",
        "The table xlmc_assumptions has two columns 'Std dev' and 'STD_DEV'",
        "Rename or delete one",
        {"Inputs!P1": "STD_DEV"},
    )


@pytest.mark.parametrize(
    ("changes", "where", "message", "hint"),
    [
        ({"Answers!A1": "Nmae"}, "Answers!A1", "xlmc_forecasts has no column Name", "Rename the column 'Nmae' to Name"),
        ({"Answers!A1": "Answer"}, "Answers!A1", "xlmc_forecasts has no column Name", "Add a column Name"),
        ({"Answers!A10": "Test"}, "Answers!A10", "xlmc_filters has no column Name", "Add a column Name"),
        ({"Answers!B20": "Other"}, "Answers!A20", "xlmc_correlations has no column Second", "Add a column Second"),
        ({"Answers!B30": "Valeu"}, "Answers!A30", "xlmc_settings has no column Value", "Rename the column 'Valeu'"),
    ],
)
def test_a_required_column_is_missing(read, changes, where, message, hint):
    problems = read(changes).problems
    assert [problem.where for problem in problems] == [where]
    assert message in problems[0].message
    assert hint in problems[0].hint


@pytest.mark.parametrize(
    ("changes", "where", "written", "meant"),
    [
        ({"Answers!C10": "At leest"}, "Answers!C10", "At leest", "At least"),
        ({"Answers!F10": "Belo"}, "Answers!F10", "Belo", "Below"),
        ({"Answers!E1": "Treshold", "Answers!E2": 40}, "Answers!E1", "Treshold", "Threshold"),
        ({"Inputs!I1": "Lower cutof"}, "Inputs!I1", "Lower cutof", "Lower cutoff"),
        ({"Inputs!M1": "Frozn"}, "Inputs!M1", "Frozn", "Frozen"),
    ],
)
def test_a_misspelt_heading_that_numbers_depend_on_is_refused(read, changes, where, written, meant):
    problems = [problem for problem in read(changes).problems if problem.where == where]
    assert [problem.message for problem in problems] == [f"The column {written!r} is not read: did you mean {meant}?"]
    assert problems[0].hint.startswith(f"Rename the column {meant}")


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"Answers!E10": "Abov"}, "Answers!E10: The column 'Abov' is kept as a note only: did you mean Above?"),
        ({"Answers!G10": "Becuase"}, "Answers!G10: The column 'Becuase' is kept as a note only: did you mean Because?"),
        ({"Inputs!P1": "Lows"}, "Inputs!P1: The column 'Lows' is kept as a note only: did you mean Low?"),
    ],
    ids=["nothing stands in it", "it is only shown", "the table has the column that it is like"],
)
def test_a_slip_in_another_heading_is_pointed_out(read, changes, expected):
    result = read(changes)
    assert result.problems == ()
    assert [str(notice) for notice in result.notices if "note only" in notice.message] == [expected]


@pytest.mark.parametrize(
    ("below", "tables", "sentence"),
    [
        (["b", 1], [], True),  # typed below the table, where no program takes it in
        (["b"], [], False),  # a remark
        ([None, 1], [], False),
        ([None], [], False),
        (["Name", "Cell"], [("other", "S!B4:E5")], False),  # another table
    ],
)
def test_a_row_right_below_a_table_is_pointed_out(make_book, blocks, below, tables, sentence):
    cells = blocks("S!B2", [HEADINGS, ["a", 1, 0], below, ["c", 3]])
    names, findings = names_of(make_book(cells, [("xlmc_filters", "S!B2:E3"), *tables]), "xlmc_filters")
    assert (names, findings.problems) == (["a"], [])
    assert [str(notice.where) for notice in findings.notices] == ["S!B4"] * sentence
    assert all("drag the table's corner over it" in notice.message for notice in findings.notices)
