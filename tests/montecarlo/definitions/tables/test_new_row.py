"""Where a fitted distribution is written in `xlmc_assumptions`, and which of its cells."""

from __future__ import annotations

import pytest

from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.tables.new_row import row_edit

NORMAL = {"Mean": 2.0, "Std dev": 0.5}
EMPTY = [None] * 16


def edit(book, name="New", family="Normal", parameters=None):
    return row_edit(book, name, family, NORMAL if parameters is None else parameters, 2.25, "fitted")


def named(book, result):
    """Heading -> what is written into its column."""
    sheet = result.table.area.sheet
    assert {row for row, _ in result.contents} == {result.row}
    return {book.content(Cell(sheet, 1, column)).value: value for (_, column), value in result.contents.items()}


@pytest.mark.parametrize(("name", "row"), [("Weight", 2), (" reaction ", 4), ("GRAVITY", 6)])
def test_the_row_of_that_name_is_replaced(changed_book, name, row):
    book = changed_book()
    result = edit(book, name)
    assert (result.row, result.is_new, result.grows, result.where) == (row, False, False, Cell("Inputs", row, 1))
    assert named(book, result) == {
        "Distribution": "Normal",
        "Mean": 2.0,
        "Std dev": 0.5,
        "Source": "fitted",
        **dict.fromkeys(["Low", "High", "Likeliest", "Low likeliest", "High likeliest"]),
    }  # its name, its value and its cutoffs stay


def test_another_has_the_row_below(changed_book):
    book = changed_book()
    result = edit(book)
    assert (result.row, result.is_new, result.grows) == (7, True, True)
    assert named(book, result)["Name"] == "New"
    assert named(book, result)["Value"] == 2.25


@pytest.mark.parametrize("bottom", [7, 9])
def test_an_empty_row_of_the_table_is_filled_first(changed_book, bottom):
    result = edit(changed_book(tables={"xlmc_assumptions": f"Inputs!A1:P{bottom}"}))
    assert (result.row, result.is_new, result.grows) == (7, True, False)


def test_a_row_between_others_is_filled_first(changed_book, blocks):
    assert edit(changed_book(blocks("Inputs!A3", [EMPTY]))).row == 3
    assert edit(changed_book({**blocks("Inputs!A3", [EMPTY]), "Inputs!P3": "a note"})).row == 7


@pytest.mark.parametrize(
    ("changes", "tables", "where"),
    [
        ({"Inputs!C7": "a note"}, {}, "Inputs!C7"),
        ({"Inputs!P7": "a note"}, {}, "Inputs!P7"),
        ({"Inputs!K7": "Setting", "Inputs!L7": "Value"}, {"xlmc_settings": "Inputs!K7:L8"}, "Inputs!K7"),
        ({}, {"Notes": "Inputs!P7:Q9"}, "Inputs!P7"),
        ({"Inputs!A6": None}, {"xlmc_assumptions": ("Inputs!A1:P6", 1)}, "Inputs!A6"),
    ],
)
def test_what_lies_below_stays(changed_book, changes, tables, where):
    with pytest.raises(DefinitionError, match="There is no free row below the table xlmc_assumptions") as caught:
        edit(changed_book(changes, tables))
    assert str(caught.value.where) == where


def test_beside_the_table_there_is_room(changed_book):
    assert edit(changed_book({"Inputs!Q7": "a note", "Inputs!A8": "another"})).row == 7


def test_without_a_table_or_a_column_it_says_what_to_do(changed_book):
    with pytest.raises(DefinitionError, match=r"case.xlsx has no table xlmc_assumptions\. Make a table of that name"):
        edit(changed_book(tables={"xlmc_assumptions": None}))
    with pytest.raises(DefinitionError, match="has no column Scale") as caught:
        edit(changed_book(), "Weight", "Gamma", {"Location": 0.0, "Scale": 1.0, "Shape": 2.0})
    assert "Type Scale into the cell behind its last heading" in caught.value.hint


def test_a_parameter_at_its_usual_value_needs_no_column(changed_book):
    book = changed_book({"Inputs!P1": "Scale", "Inputs!O1": "Shape"})
    result = named(book, edit(book, "Weight", "Gamma", {"Location": 0.0, "Scale": 1.0, "Shape": 2.0}))
    assert (result["Scale"], result["Shape"]) == (1.0, 2.0)
    assert "Location" not in result
    with pytest.raises(DefinitionError, match="has no column Location"):
        edit(book, "Weight", "Gamma", {"Location": 5.0, "Scale": 1.0, "Shape": 2.0})
