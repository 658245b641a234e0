from __future__ import annotations

import pytest

from xlmc.errors import FormulaError
from xlmc.excel.address import Cell, parse_address
from xlmc.excel.formula.graph import circular
from xlmc.excel.formula.precedents import references
from xlmc.excel.formula.strips import Needs

CELLS = {
    "A1": 1.0,
    "A2": 2.0,
    "B1": "=A1*2",
    "B2": "=A2+B1",
    "B3": "=A2+1",
    "C1": "=SUM(B1:B2)+D9",
    "C2": "=B3*B3",
    "C3": "=1+1",
    "D1": "=Nothing!A1",
}


def names(cells):
    return [cell.a1 for cell in cells]


def test_only_what_the_targets_need(graph_of):
    graph = graph_of(CELLS, ["C1"], inputs=["A1"])
    assert names(graph.formulas) == ["B1", "B2", "C1"]
    assert graph.text(parse_address("S!C1")) == "SUM(B1:B2)+D9"
    assert graph.text(parse_address("S!A1")) == ""


def test_precedents_that_count(graph_of):
    graph = graph_of(CELLS, ["C1", "C2"], inputs=["A1"])
    needs = {cell.a1: names(needed) for cell, needed in graph.needs.items()}
    assert needs == {"B1": ["A1"], "B2": ["B1"], "C1": ["B1", "B2"], "B3": [], "C2": ["B3"]}


def test_what_varies(graph_of):
    graph = graph_of(CELLS, ["C1", "C2", "C3"], inputs=["A1"])
    assert {cell.a1 for cell in graph.varying} == {"A1", "B1", "B2", "C1"}
    assert names(graph.reached) == ["A1"]


def test_an_input_that_nothing_needs_is_not_reached(graph_of):
    graph = graph_of(CELLS, ["C2"], inputs=["A1", "A2"])
    assert names(graph.reached) == ["A2"]


def test_a_target_may_be_an_input_or_a_number(graph_of):
    graph = graph_of(CELLS, ["A1", "A2"], inputs=["A1"])
    assert (names(graph.formulas), names(graph.reached)) == ([], ["A1"])


def test_a_held_cell_stops_the_walk(graph_of):
    graph = graph_of(CELLS, ["C1"], inputs=["A1"], held=["B1"])
    assert names(graph.formulas) == ["B2", "C1"]
    assert names(graph.reached) == ["B1"]
    assert graph.varying == frozenset()


def test_an_input_is_an_input_whatever_its_cell_holds(graph_of):
    graph = graph_of({"A1": "=Nothing!A1", "B1": "=A1"}, ["B1"], inputs=["A1"])
    assert names(graph.formulas) == ["B1"]


def test_a_blank_input_within_an_area_is_reached(graph_of):
    graph = graph_of({"A1": 1.0, "B1": "=SUM(A1:A3)", "AB1": "=SUM(A1:AA99)"}, ["AB1"], inputs=["A2", "C5"])
    assert {cell.a1 for cell in graph.reached} == {"A2", "C5"}
    assert {cell.a1 for cell in graph.varying} == {"A2", "C5", "B1", "AB1"}


def test_a_faulty_cell_that_is_needed(graph_of):
    with pytest.raises(FormulaError, match="There is no sheet 'Nothing'") as caught:
        graph_of(CELLS, ["D1"])
    assert caught.value.where == "S!D1"


@pytest.mark.parametrize(
    ("cells", "circle"),
    [
        ({"A1": "=A1+1"}, "S!A1 → S!A1"),
        ({"A1": "=B1", "B1": "=SUM(A1:A2)"}, "S!A1 → S!B1 → S!A1"),
        ({"A1": "=B1", "B1": "=C1", "C1": "=D1", "D1": "=C1*2"}, "S!C1 → S!D1 → S!C1"),
        ({"A1": "=Data!A1", "Data!A1": "=S!A1"}, "S!A1 → Data!A1 → S!A1"),
    ],
)
def test_a_circle_is_told_cell_by_cell(graph_of, cells, circle):
    result = set(graph_of(cells, ["A1"]).circles.values())
    assert [(error.message.endswith(circle), error.where) for error in result] == [(True, circle.split(" → ")[0])]


def test_a_circle_through_an_input_is_none(graph_of):
    graph = graph_of({"A1": "=B1", "B1": "=A1+1"}, ["B1"], inputs=["A1"])
    assert names(graph.formulas) == ["B1"]


def test_a_chain_of_5_000_cells(graph_of):
    cells = {"A1": 1.0} | {f"A{row}": f"=A{row - 1}+1" for row in range(2, 5_001)}
    graph = graph_of(cells, ["A5000"], inputs=["A1"])
    assert len(graph.formulas) == 4_999
    assert names(graph.formulas)[:2] == ["A2", "A3"]
    assert len(graph.varying) == 5_000


def test_cells_that_an_array_formula_fills_vary_with_it(graph_of, array):
    cells = {"A1": 1.0, "B1": array("=A1*{1;2;3}", "S!B1:B3"), "B2": 2.0, "C1": "=B2+1", "C2": "=SUM(B2:B3)"}
    graph = graph_of(cells, ["C1", "C2"], inputs=["A1"])
    assert names(graph.formulas) == ["B1", "B2", "C1", "B3", "C2"]
    assert {cell.a1 for cell in graph.varying} == {"A1", "B1", "B2", "B3", "C1", "C2"}
    assert graph.formulas[parse_address("S!B2")] == parse_address("S!B1")


def test_references_from_left_to_right(graph_of):
    graph = graph_of({"A1": '=IF(B1>C1,SUM(B2:C3,"x",TRUE),-D1%)+{1,2}*B1'}, ["A1"])
    (tree,) = graph.formulas.values()
    assert [str(place) for place in references(tree)] == ["S!B1", "S!C1", "S!B2:C3", "S!D1", "S!B1"]


def cells(letters):
    return [Cell("S", 1, ord(letter) - 64) for letter in letters]


def graph(**needs):
    result = Needs()
    result.parts = {cell: (tuple(cells(read)),) for cell, read in zip(cells(needs), needs.values(), strict=True)}
    return result


def test_who_needs_itself_is_told_a_circle_it_is_in_with_the_others():
    result = circular(graph(A="B", B="CD", C="A", D="", E="E", F="A"))
    assert list(result) == cells("ABCE")
    assert "S!A1 → S!B1 → S!C1 → S!A1" in result[cells("B")[0]].message
    assert "S!E1 → S!E1" in result[cells("E")[0]].message


def test_two_circles_apart_are_told_apart():
    result = circular(graph(A="B", B="A", C="D", D="CA"))
    assert result[cells("A")[0]] is result[cells("B")[0]]
    assert result[cells("C")[0]] is result[cells("D")[0]] is not result[cells("A")[0]]


def test_the_circle_may_begin_after_the_first_cell_of_its_group():
    result = circular(graph(A="B", B="C", C="BA"))
    assert list(result) == cells("ABC")
    assert "circle: S!B1 → S!C1 → S!B1" in result[cells("A")[0]].message


def test_without_circles_there_is_nothing():
    assert circular(graph(A="B", B="C", C="")) == {}
