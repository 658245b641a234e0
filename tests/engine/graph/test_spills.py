"""`A1#`: the range that a dynamic array fills. It is `#REF!` where nothing spills."""

from __future__ import annotations

import pytest

from xlmc.analysis.studies.verify import verify
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Area
from xlmc.excel.workbook.workbook import CellContent, Formula

CELLS = {"A1": 1.0, "A2": 2.0, "A3": 3.0}


def spilling(text, area, *values, dynamic=True):
    """Cells that an array formula in H1 fills, with the values that Excel saved."""
    cells = {f"H{1 + i}": CellContent(value) for i, value in enumerate(values)}
    return cells | {"H1": CellContent(values[0], Formula(text, 1, 8, array=Area("S", *area), dynamic=dynamic))}


@pytest.fixture
def got(workbook):
    def compute(cells, *formulas):
        book = workbook({**CELLS, **cells, **{f"Z{50 + i}": f"={text}" for i, text in enumerate(formulas)}})
        result = {str(check.cell): check.got for check in verify(book).cells}
        return [result[f"S!Z{50 + i}"] for i in range(len(formulas))]

    return compute


def test_a_spill_is_a_reference(got):
    cells = spilling("A1:A3*2", (1, 8, 3, 8), 2.0, 4.0, 6.0)
    formulas = ["SUM(H1#)", "ROWS(H1#)", "ROW(H1#)", 'SUMIF(H1#,">2",A1:A3)', "INDEX(H1#,2)", "SUM(OFFSET(H1#,1,0))"]
    assert got(cells, *formulas) == [12.0, 3.0, 1.0, 5.0, 4.0, 10.0]


def test_the_declared_range_is_taken_where_saved_values_stand_in(got):
    cells = spilling("_xlfn.RANDARRAY(3,1)", (1, 8, 3, 8), 0.25, 0.5, 0.125)
    assert got(cells, "SUM(H1#)", "ROWS(H1#)", "MAX(H1#)") == [0.875, 3.0, 0.5]


@pytest.mark.parametrize(
    "cells",
    [
        {"H1": 5.0},
        {"H1": "=A1*2"},
        {},
        spilling("A1:A3*2", (1, 8, 3, 8), 2.0, 4.0, 6.0, dynamic=False),
    ],
    ids=["a value", "a plain formula", "an empty cell", "an array formula of fixed size"],
)
def test_where_nothing_spills_it_is_an_error(got, cells):
    assert got(cells, "SUM(H1#)", "H1#", "IFERROR(SUM(H1#),7)") == [ErrorCode.REF, ErrorCode.REF, 7.0]


def test_a_cell_that_the_spill_fills_spills_nothing(got):
    cells = spilling("A1:A3*2", (1, 8, 3, 8), 2.0, 4.0, 6.0)
    assert got(cells, "SUM(H2#)") == [ErrorCode.REF]


def test_a_spill_of_drawn_values(book):
    cells = {**CELLS, **spilling("A1:A3*2", (1, 8, 3, 8), 2.0, 4.0, 6.0), "J1": "=SUM(H1#)", "J2": "=ROWS(H1#)"}
    model = book(cells, {"a": {"cell": "A1", "low": 0, "high": 9}}, {"sum": "J1", "rows": "J2"})
    result = model.function({"a": [1.0, 5.0]})
    assert result["sum"].tolist() == [12.0, 20.0]
    assert result["rows"].tolist() == [3.0, 3.0]


@pytest.mark.parametrize("dynamic", [True, False])
@pytest.mark.parametrize(
    "formula",
    [
        "SUM(OFFSET(H1,0,0,3,1))",
        "SUM(OFFSET(H1,1,0,2,1))+H1",
        'INDIRECT("H2")+INDIRECT("H3")+H1',
        "SUM(H1:INDEX(H1:H9,3))",
    ],
)
def test_references_into_the_cells_that_an_array_formula_fills(book, formula, dynamic):
    filled = spilling("A1:A3*2", (1, 8, 3, 8), 2.0, 4.0, 6.0, dynamic=dynamic)
    cells = {**CELLS, **filled, "J1": f"={formula}", "J2": '=CELL("contents",H3)'}
    inputs = {name: {"cell": name.upper(), "low": 0, "high": 9} for name in ("a1", "a2", "a3")}
    model = book(cells, inputs, {"sum": "J1", "third": "J2"})
    result = model.function({"a1": [1.0, 5.0], "a2": [2.0, 3.0], "a3": [4.0, 0.5]})
    assert result["sum"].tolist() == [14.0, 17.0]
    assert result["third"].tolist() == [8.0, 1.0]


@pytest.mark.parametrize("saved", [(2.0, 4.0, 6.0), (0.0, 0.0, 0.0)])
def test_every_cell_of_a_spill_varies(book, saved):
    cells = {**CELLS, **spilling("A1:A3*A1", (1, 8, 3, 8), *saved), "J1": "=SUM(H1#)", "J2": "=INDEX(H1#,3)"}
    model = book(cells, {"a": {"cell": "A1", "low": 0, "high": 9}}, {"sum": "J1", "third": "J2"})
    result = model.function({"a": [1.0, 5.0]})
    assert result["sum"].tolist() == [6.0, 50.0]
    assert result["third"].tolist() == [3.0, 15.0]


def test_a_spill_whose_size_varies_is_what_each_trial_gives(book):
    cells = {**CELLS, **spilling("_xlfn._xlws.FILTER(A1:A3,A1:A3>1)", (1, 8, 2, 8), 2.0, 3.0), "J1": "=SUM(H1#)"}
    model = book(cells, {"a": {"cell": "A1", "low": 0, "high": 9}}, {"sum": "J1"})
    assert model.function({"a": [1.0, 5.0]})["sum"].tolist() == [5.0, 10.0]


@pytest.mark.parametrize("formula", ["TAKE(D1:D3,A1)", "IF(A1>1,TAKE(D1:D3,A1),TAKE(D1:D3,1))"])
def test_cells_of_a_spill_of_a_drawn_size_show_0_for_empty_ones(run, formula):
    cells = spilling(formula, (1, 8, 1, 8), None) | {"Z1": "=SUM(LEN(H1#))", "Z2": '=SUM(--(H1#=""))'}
    assert run(cells, {"A1": [1.0, 2.0, 3.0]}, ["Z1", "Z2"]).forecasts == [[1.0, 2.0, 3.0], [0.0, 0.0, 0.0]]


GROWING = "_xlfn._xlws.FILTER(A1:A3,A1:A3>1)"
"""Two cells when it was saved, three where A1 is above 1."""


@pytest.mark.parametrize("formula", ["SUM(H1:H3)", "COUNT(H:H)", "H2+H3", "SUM(Above)", "A1+H3", "COUNTA(H3:H9)+A1"])
def test_cells_that_a_spill_may_fill_beyond_the_saved_ones_are_refused(book, formula):
    cells = {**CELLS, **spilling(GROWING, (1, 8, 2, 8), 2.0, 3.0), "J1": f"={formula}"}
    with pytest.raises(FormulaError, match=r"S!J1: The formula names cells .* S!H1 may fill, .* by H1#"):
        book(cells, {"a": {"cell": "A1", "low": 0, "high": 9}}, {"sum": "J1"}, names={"Above": "S!$H$2:$H$4"})


@pytest.mark.parametrize("formula", ["SUM(OFFSET(H1,0,0,4,1))", 'AVERAGE(INDIRECT("H1:H3"))'])
def test_so_are_those_that_offset_and_indirect_read(book, formula):
    cells = {**CELLS, **spilling(GROWING, (1, 8, 2, 8), 2.0, 3.0), "J1": f"={formula}"}
    with pytest.raises(FormulaError, match=r"S!H1: This dynamic array may fill more than the H1:H2 .* H1:H[34] by "):
        book(cells, {"a": {"cell": "A1", "low": 0, "high": 9}}, {"sum": "J1"})


@pytest.mark.parametrize("formula", ["SUM(H1:H2)", "SUM(H1:H2,H5:H9)", "SUM(G1:G9)", "SUM(I1:I9)", "SUM(H1#)"])
def test_other_cells_about_a_spill_are_not(book, formula):
    cells = {**CELLS, **spilling(GROWING, (1, 8, 2, 8), 2.0, 3.0), "H4": "end", "J1": f"={formula}"}
    book(cells, {"a": {"cell": "A1", "low": 0, "high": 9}}, {"sum": "J1"})


def test_a_spill_that_nothing_needs_and_that_cannot_be_computed_is_told_of(book):
    cells = {**CELLS, **spilling("_xlfn._xlws.FILTER(A1:A3,NOSUCH(A1))", (1, 8, 2, 8), 2.0, 3.0), "J1": "=A1+H3"}
    (notice,) = book(cells, {"a": {"cell": "A1", "low": 0, "high": 9}}, {"sum": "J1"}).notices
    assert "H1" in str(notice.where)
    assert "read them as the file holds them" in notice.message


def test_a_spill_for_which_the_file_saves_too_few_cells(book):
    """As a program writes it that does not calculate."""
    cells = {**CELLS, **spilling("A1:A3*2", (1, 8, 1, 8), 0.0), "J1": "=SUM(H1:H3)"}
    with pytest.raises(FormulaError, match="beyond the H1:H1 that it filled"):
        book(cells, {"a": {"cell": "A1", "low": 0, "high": 9}}, {"sum": "J1"})


def test_what_a_smaller_spill_does_not_fill_is_blank(book):
    """Neither is its only cell repeated, nor are the others #N/A, as in an array formula of fixed size."""
    filled = spilling("_xlfn._xlws.FILTER(A1:A3,A1:A3>2.5)", (1, 8, 2, 8), 5.0, 3.0)
    cells = {**CELLS, **filled, "J1": "=SUM(H1:H2)", "J2": "=COUNT(H1:H2)", "J3": "=ISBLANK(H2)+0", "J4": "=H2"}
    forecasts = {"sum": "J1", "count": "J2", "blank": "J3", "second": "J4"}
    result = book(cells, {"a": {"cell": "A1", "low": 0, "high": 9}}, forecasts).function({"a": [5.0, 1.0]})
    assert {name: values.tolist() for name, values in result.items()} == {
        "sum": [8.0, 3.0],
        "count": [2.0, 1.0],
        "blank": [0.0, 1.0],
        "second": [3.0, 0.0],
    }


def test_a_spill_that_is_an_error_fills_its_own_cell_alone(book):
    filled = spilling("_xlfn._xlws.FILTER(A1:A3,A1:A3>2.5)/(A1>2)", (1, 8, 2, 8), 5.0, 3.0)
    cells = {**CELLS, **filled, "J1": "=COUNTA(H1:H2)", "J2": "=COUNT(H1:H2)"}
    result = book(cells, {"a": {"cell": "A1", "low": 0, "high": 9}}, {"a": "J1", "n": "J2"}).function({"a": [5.0, 1.0]})
    assert (result["a"].tolist(), result["n"].tolist()) == ([2.0, 1.0], [2.0, 0.0])
