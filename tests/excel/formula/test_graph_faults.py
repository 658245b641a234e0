"""Not strict: every cell that cannot be read, or needs itself, is told, and the others are worked out."""

from __future__ import annotations

import pytest

from xlmc.errors import FormulaError
from xlmc.excel.address import Cell, parse_address
from xlmc.excel.formula import Resolver, build_graph, ir
from xlmc.excel.workbook.workbook import Workbook


@pytest.fixture
def tolerant(workbook):
    """`tolerant(cells, targets, inputs)`: the graph with its faults."""

    def build(cells, targets, inputs=(), **of_workbook):
        resolver = Resolver(workbook(cells, **of_workbook))
        places = [parse_address(address, "S") for address in targets]
        return build_graph(resolver, places, frozenset(parse_address(cell, "S") for cell in inputs), strict=False)

    return build


CELLS = {
    "A1": 1.0,
    "B1": "=A1*2",
    "B2": "=A1+",
    "B3": "=Nothing!A1",
    "C1": "=B1+B2",
    "C2": "=B3&B1",
    "C3": "=Rte",
    "C4": "=[1]Other!A1",
}


def test_faults_are_collected_and_the_rest_is_worked_out(tolerant):
    graph = tolerant(CELLS, ["C1", "C2", "C3", "C4", "B1"], inputs=["A1"], names={"Rate": "S!$A$1"})
    faults = {cell.a1: error.message for cell, error in graph.faults.items()}
    assert faults == {
        "B2": "the formula cannot be read from the marked character on",
        "B3": "there is no sheet 'Nothing'",
        "C3": "there is no name 'Rte'",
        "C4": "the formula refers to another workbook",
    }
    assert [cell.a1 for cell in graph.formulas] == ["B1", "B2", "C1", "B3", "C2", "C3", "C4"]
    assert {graph.formulas[cell] for cell in graph.faults} == {ir.Missing()}
    assert {cell.a1 for cell in graph.varying} == {"A1", "B1", "C1", "C2"}
    assert {error.where for error in graph.faults.values()} == {"S!B2", "S!B3", "S!C3", "S!C4"}


def test_without_faults_it_is_the_same_graph(tolerant, workbook):
    cells = {"A1": 1.0, "B1": "=A1", "C1": "=SUM(A1:B1)"}
    strict = build_graph(Resolver(workbook(cells)), [Cell("S", 1, 3)], frozenset([Cell("S", 1, 1)]))
    graph = tolerant(cells, ["C1"], inputs=["A1"])
    assert graph.faults == strict.faults == {}
    assert (graph.formulas, graph.needs, graph.varying) == (strict.formulas, strict.needs, strict.varying)


@pytest.mark.parametrize(
    ("cells", "circles"),
    [
        ({"A1": "=A1+1"}, {"A1": "S!A1 → S!A1"}),
        ({"A1": "=B1", "B1": "=SUM(B1:C1)"}, {"B1": "S!B1 → S!B1"}),
        ({"A1": "=B1+C1", "B1": "=C1", "C1": "=B1"}, {"B1": "S!B1 → S!C1 → S!B1", "C1": "S!B1 → S!C1 → S!B1"}),
        (
            {"A1": "=B1+B2", "B1": "=B1", "B2": "=D2", "D2": "=B2", "C9": "=D2"},
            {"B1": "S!B1 → S!B1", "B2": "S!B2 → S!D2 → S!B2", "D2": "S!B2 → S!D2 → S!B2"},
        ),
    ],
)
def test_the_cells_of_a_circle_are_listed_and_those_that_need_them_are_not(tolerant, cells, circles):
    graph = tolerant(cells, ["A1"])
    expected = {
        cell.a1: error.message.removeprefix("the cells need each other in a circle: ")
        for cell, error in graph.circles.items()
    }
    assert expected == circles
    assert not graph.faults
    assert {error.hint for error in graph.circles.values()} == {
        "break the circle, or turn on iterative calculation in Excel's options, if it is meant"
    }
    assert Cell("S", 1, 1) in graph.formulas


def test_cells_are_worked_out_before_those_that_need_them_circles_or_not(tolerant):
    cells = {"A1": "=B1+E1", "B1": "=C1", "C1": "=B1+D1", "D1": "=2", "E1": "=C1*D1"}
    order = [cell.a1 for cell in tolerant(cells, ["A1"]).formulas]
    assert sorted(order) == ["A1", "B1", "C1", "D1", "E1"]
    assert order[-1] == "A1"
    assert order.index("D1") < order.index("C1") < order.index("E1")


def test_a_long_circle_is_put_into_words_once(tolerant):
    n = 3000
    graph = tolerant({f"A{row}": f"=A{row % n + 1}" for row in range(1, n + 1)}, ["A1"])
    assert len(graph.circles) == n
    assert len({id(error.message) for error in graph.circles.values()}) == 1
    message = next(iter(graph.circles.values())).message
    assert message.endswith("S!A2999 → S!A3000 → S!A1")


def test_a_strict_walk_stops_at_the_first_fault(workbook):
    cells = {"A1": "=B1+C1", "B1": "=1+", "C1": "=2*"}
    with pytest.raises(FormulaError) as caught:
        build_graph(Resolver(workbook(cells)), [Cell("S", 1, 1)], frozenset())
    assert (caught.value.where, caught.value.text, caught.value.span) == ("S!B1", "1+", (1, 2))


def test_needs_that_no_formula_names(workbook):
    """`OFFSET` and `INDIRECT` tell only when they are worked out which cells they read."""
    book = workbook({"A1": 1.0, "B1": "=A1", "B2": "=A1+1", "C1": "=1"})
    b1, b2, c1, a1 = (parse_address(address, "S") for address in ("B1", "B2", "C1", "A1"))
    graph = build_graph(Resolver(book), [c1], frozenset([a1]), more={c1: [b2], b2: [b1]})
    assert isinstance(graph.workbook, Workbook)
    assert list(graph.formulas) == [b1, b2, c1]
    assert (graph.needs[c1], graph.needs[b2]) == ((b2,), (a1, b1))
    assert graph.varying == {a1, b1, b2, c1}
    assert set(build_graph(Resolver(book), [c1], frozenset([a1]), more={c1: [b1], b1: [c1]}).circles) == {b1, c1}
