"""Which cells are proposed as inputs and answers, from workbooks without files."""

from __future__ import annotations

import pytest

from xlmc.errors import DefinitionError
from xlmc.excel.address import Area, Cell
from xlmc.montecarlo.definitions.proposals import MOST_FORECASTS, proposals

BEAM = {
    "S!A1": "Load (kN)", "S!B1": 12, "S!A2": "Span", "S!B2": 4, "S!C2": "m", "S!A3": "Note", "S!B3": "as built",
    "S!A4": "Moment", "S!B4": ("=B1*B2/4", 12.0), "S!A5": "Twice", "S!B5": ("=B4*2", 24.0), "S!A6": "Idle", "S!B6": 7,
}  # fmt: skip


def places(result):
    return [str(each.cell) for each in result]


def area(row, column, bottom=None, right=None):
    return Area("S", row, column, bottom or row, right or column)


def test_numbers_that_formulas_use_and_formulas_that_none_uses(make_book):
    result = proposals(make_book(BEAM))
    assert [(str(each.cell), each.name, each.units, each.value) for each in result.assumptions] == [
        ("S!B1", "Load", "kN", 12.0),
        ("S!B2", "Span", "m", 4.0),
    ]
    assert [(str(each.cell), each.name, each.value) for each in result.forecasts] == [("S!B5", "Twice", 24.0)]
    assert (result.further, result.passed_over) == (0, ())


def test_what_a_table_has_already_is_left_out(make_book):
    result = proposals(make_book(BEAM), known=[Cell("S", 1, 2), Cell("S", 5, 2)])
    assert (places(result.assumptions), places(result.forecasts)) == (["S!B2"], [])


@pytest.mark.parametrize(("rows", "count"), [(24, 24), (25, 0)])
def test_a_long_range_is_a_table_to_look_something_up_in(make_book, rows, count):
    """Cells of ranges of up to 24 cells may be inputs one by one."""
    cells = {f"S!A{row}": row for row in range(1, rows + 1)} | {"S!B1": (f"=SUM(A1:A{rows})", 1.0)}
    assert len(proposals(make_book(cells)).assumptions) == count


def test_a_block_is_as_long_as_it_has_cells(make_book):
    cells = {f"S!{column}{row}": 1 for column in "ABCD" for row in range(1, 8)} | {"S!F1": ("=SUM(A1:D6)", 1.0)}
    assert len(proposals(make_book(cells)).assumptions) == 24
    assert proposals(make_book(cells | {"S!F1": ("=SUM(A1:D7)", 1.0)})).assumptions == ()


def test_no_more_answers_than_a_report_can_have_and_the_others_are_counted(make_book):
    cells = {"S!A1": 1, **{f"S!B{row}": (f"=A1+{row}", 1.0) for row in range(1, MOST_FORECASTS + 4)}}
    result = proposals(make_book(cells))
    assert MOST_FORECASTS == 24
    assert places(result.forecasts) == [f"S!B{row}" for row in range(1, 25)]
    assert result.further == 3
    every = proposals(make_book(cells), forecasts=[area(1, 2, 27)])
    assert len(every.forecasts) == 27
    assert every.further == 0


def test_an_answer_that_cannot_be_computed_is_passed_over_and_told(make_book):
    result = proposals(make_book({"S!A1": 1, "S!B1": ("=A1*2", 2.0), "S!B2": ("=NOSUCH(A1)", 3.0)}))
    assert places(result.forecasts) == ["S!B1"]
    ((cell, why),) = result.passed_over
    assert cell == Cell("S", 2, 2)
    assert why.startswith("cannot be computed (")
    assert result.further == 0


@pytest.mark.parametrize(
    ("value", "proposed"),
    [(("=A1*2", 2.0), True), (("=A1*2", None), True), (('=A1&"m"', "1m"), False), (("=A1>0", True), False)],
)
def test_answers_are_numbers(make_book, value, proposed):
    assert places(proposals(make_book({"S!A1": 1, "S!B1": value})).forecasts) == (["S!B1"] if proposed else [])


def test_an_answer_depends_on_an_input(make_book):
    result = proposals(make_book({"S!A1": 1, "S!B1": ("=A1*2", 2.0), "S!B2": ("=3*2", 6.0)}))
    assert places(result.forecasts) == ["S!B1"]
    result = proposals(make_book(BEAM | {"S!D1": ("=B6*2", 14.0)}), assumptions=[area(6, 2)])
    assert places(result.forecasts) == ["S!D1"]


def test_names_that_are_taken_have_their_cell_behind(make_book):
    cells = {"S!A1": "x", "S!B1": 1, "S!A2": "X ", "S!B2": 2, "S!D1": ("=B1+B2", 3.0)}
    result = proposals(make_book(cells))
    assert [each.name for each in result.assumptions] == ["x", "X (B2)"]
    result = proposals(make_book(cells | {"T!A1": 5}))
    assert [each.name for each in result.assumptions] == ["x", "X (S!B2)"]


@pytest.mark.parametrize(
    ("asked", "places_", "passed"),
    [
        ([area(1, 2, 3)], ["S!B1", "S!B2"], [("S!B3", "holds no number")]),
        ([area(2, 2), area(1, 2), area(2, 2)], ["S!B2", "S!B1"], []),
        ([area(6, 2, 9)], ["S!B6"], []),  # blank cells are not told
        ([area(4, 2, 6)], ["S!B6"], [("S!B4", "holds a formula"), ("S!B5", "holds a formula")]),
    ],
)
def test_inputs_that_are_asked_for(make_book, asked, places_, passed):
    result = proposals(make_book(BEAM), assumptions=asked)
    assert places(result.assumptions) == places_
    assert [(str(cell), why) for cell, why in result.passed_over] == passed


@pytest.mark.parametrize(
    ("asked", "message", "hint"),
    [
        ({"assumptions": [area(4, 2)]}, "The cell holds a formula, so that it is no assumption", "--forecast"),
        ({"assumptions": [area(3, 2)]}, "The cell holds no number, so that it is no assumption", "holds the number"),
        ({"assumptions": [area(9, 9)]}, "The cell is blank, so that it is no assumption", "usual value"),
        ({"forecasts": [area(1, 2)]}, "The cell holds no formula, so that it is no forecast", "--assumption"),
        ({"forecasts": [area(9, 9)]}, "The cell is blank, so that it is no forecast", "with the formula"),
    ],
)
def test_what_cannot_be_meant(make_book, asked, message, hint):
    with pytest.raises(DefinitionError) as caught:
        proposals(make_book(BEAM), **asked)
    assert message in str(caught.value)
    assert hint in caught.value.hint


def test_a_book_without_formulas(make_book):
    with pytest.raises(DefinitionError, match="The workbook has no formula"):
        proposals(make_book({"S!A1": 1.0}))
    with pytest.raises(DefinitionError, match="The workbook has no formula"):
        proposals(make_book(BEAM), left_out=["S"])


def test_formulas_of_tables_of_definitions_are_no_answers(make_book):
    cells = BEAM | {"S!H1": "Name", "S!I1": "Cell", "S!H2": "Load", "S!I2": ("=B1*1", 12.0)}
    assert "S!I2" in places(proposals(make_book(cells)).forecasts)
    result = proposals(make_book(cells, [("xlmc_assumptions", "S!H1:I2")]))
    assert places(result.forecasts) == ["S!B5"]
