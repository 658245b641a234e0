"""Which tables and plain ranges are read, and what is said of those with nearly the name of one."""

from __future__ import annotations

import pytest

from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.reserved_tables import CONVERTED, KINDS, definition_tables, likely_table

PLAIN = {
    f"{sheet}!{cell}": value
    for sheet in (kind for kind in KINDS if kind != CONVERTED)
    for cell, value in {"B2": "Name", "C2": "Cell", "B3": "x", "C4": 1, "B6": "a note", "E2": "apart"}.items()
}
"""A sheet for each table, with the name of the table: headings in B2:C2, two rows, and notes beside and below."""


@pytest.fixture
def result(make_book):
    """The tables of a workbook with the places of each kind that has some, and what was found wrong."""

    def tables(*args, **kwargs):
        findings = Findings()
        every = definition_tables(make_book(*args, **kwargs), findings)
        assert tuple(every) == KINDS
        return {kind: [str(each.table.area) for each in them] for kind, them in every.items() if them}, findings

    return tables


def test_a_sheet_with_the_name_of_a_table_is_read_as_one(result):
    """But for the table that says what was converted, which only `xlmc convert` writes."""
    places, findings = result({**PLAIN, f"{CONVERTED}!A1": "Name", f"{CONVERTED}!A2": "x"})
    assert places == {kind: [f"{kind}!B2:C4"] for kind in KINDS if kind != CONVERTED}
    assert [str(notice.where) for notice in findings.notices] == [f"{kind}!B2" for kind in places]
    assert not findings.problems


@pytest.mark.parametrize(
    ("cells", "tables", "places"),
    [
        ({"A1": "Name", "A2": "x"}, (), ["xlmc_filters!A1:A2"]),
        ({"A1": "Name"}, (), []),  # headings alone
        ({}, (), []),
        ({"A1": "Name", "A2": "x"}, [("Other", "xlmc_filters!A1:A2")], []),  # a table, of another name
        ({"A1": "Name", "B2": "x", "C3": "y"}, (), []),  # B2 is below no heading
        ({"A1": "Name", "B1": "Cell", "B2": "x", "A3": "y"}, (), ["xlmc_filters!A1:B3"]),
    ],
)
def test_the_extent_of_a_plain_range(result, cells, tables, places):
    found_places, _ = result(
        {f"xlmc_filters!{at}": each for at, each in cells.items()}, tables, sheets=["xlmc_filters"]
    )
    assert found_places.get("xlmc_filters", []) == places


@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("S!$A$1:$B$2", ["S!A1:B2"]),
        ("s!A1:B3", ["S!A1:B3"]),
        ("S!$A$1:$B$1", []),  # no row
        ("S!$A$1", []),
        ("Nowhere!A1:B2", []),
        ("OFFSET(S!A1,0,0,2,2)", []),
    ],
)
def test_a_defined_name_is_read_as_a_table(result, text, places):
    found_places, _ = result({"S!A1": "Name", "S!B1": "Cell", "S!A2": "x"}, names=[("xlmc_forecasts", text, None)])
    assert found_places.get("xlmc_forecasts", []) == places


def test_headings_of_a_plain_range_are_found_in_their_columns(make_book):
    cells = {"xlmc_filters!B2": "Name", "xlmc_filters!C2": "At Least", "xlmc_filters!B3": "x"}
    (table,) = definition_tables(make_book(cells), Findings())["xlmc_filters"]
    assert table.columns == {"name": ("Name", 2), "atleast": ("At Least", 3)}
    assert (str(table.where), str(table.heading_cell(3))) == ("xlmc_filters!B2", "xlmc_filters!C2")


def test_no_range_is_read_beside_a_table_of_its_kind(result):
    cells = {"xlmc_filters!A1": "Name", "xlmc_filters!A2": "x", "S!A1": "Name", "S!A2": "x"}
    places, findings = result(cells, [("xlmc_filters2", "S!A1:A2")])
    assert places == {"xlmc_filters": ["S!A1:A2"]}
    assert not findings.notices


@pytest.mark.parametrize(
    ("name", "problem", "notice"),
    [
        ("xlmc_filter", "did you mean xlmc_filters?", ""),
        ("xlmc_filtres", "did you mean xlmc_filters?", ""),
        ("xlcm_filters", "did you mean xlmc_filters?", ""),
        ("xlmc_notes", "", "The table xlmc_notes is not read: xlmc reads"),
        ("filters_xlmc", "", ""),
        ("mc_filters", "", "did you mean xlmc_filters?"),
        ("Skids", "", ""),
        ("xlmc_case2", "", ""),
    ],
)
def test_other_names(result, name, problem, notice):
    places, findings = result({"S!A1": "Name", "S!A2": "x"}, [(name, "S!A1:A2")])
    assert places == {}
    for message, expected in ((findings.problems, problem), (findings.notices, notice)):
        assert len(message) == bool(expected)
        assert all(expected in str(each) for each in message)


def test_two_columns_of_one_heading(result):
    _, findings = result({"S!A1": "Std dev", "S!B1": "x", "S!C1": "std DEV", "S!A2": 1}, [("xlmc_filters", "S!A1:C2")])
    (problem,) = findings.problems
    assert problem.where == "S!C1"
    assert "two columns 'Std dev' and 'std DEV'" in problem.message


@pytest.mark.parametrize(
    ("name", "headings", "likely"),
    [
        ("Mine", ["Name", "Low", "High"], True),
        ("Mine", ["name", "LOW", "Other"], False),
        ("xlmc_mine", ["Name", "Low", "High"], False),
    ],
)
def test_a_table_with_the_headings_of_a_reserved_one(make_book, name, headings, likely):
    cells = {f"S!{'ABC'[k]}1": each for k, each in enumerate(headings)}
    table = likely_table(make_book({**cells, "S!A2": "x"}, [(name, "S!A1:C2")]), "xlmc_assumptions")
    assert (table is not None) == likely
    assert likely_table(make_book(cells, [(name, "S!A1:C1")]), "xlmc_scenarios") is None


def test_headings_of_a_plain_range_are_texts_as_excel_shows_them(make_book):
    """A number is no `7.0`: a column of a matrix may be headed by one, as the assumption is called."""
    cells = {"A1": "Name", "B1": 7.0, "C1": 0.25, "D1": True, "E1": " Cell ", "A2": "x"}
    book = make_book({f"xlmc_filters!{at}": each for at, each in cells.items()}, sheets=["xlmc_filters"])
    (table,) = definition_tables(book, Findings())["xlmc_filters"]
    assert table.table.columns == ("Name", "7", "0.25", "TRUE", "Cell")
