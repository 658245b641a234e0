"""How much is done for a large workbook: counted, not timed."""

from __future__ import annotations

from collections import Counter

import pytest

from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver, build_graph, ir
from xlmc.excel.formula import graph as module
from xlmc.excel.formula.graph import Spills
from xlmc.excel.workbook.workbook import Workbook


@pytest.fixture
def work(monkeypatch, workbook):
    """`work(cells, target, inputs)`: the graph, and how often each of these was called on the way."""
    counts = Counter()

    def counted(owner, name):
        original = getattr(owner, name)

        def call(*args, **kwargs):
            counts[name] += 1
            return original(*args, **kwargs)

        monkeypatch.setattr(owner, name, call)

    counted(Resolver, "tree_or_stencil")
    counted(Resolver, "_resolve")
    counted(Workbook, "content")
    counted(Spills, "anchor")
    counted(module, "references")
    counted(module, "_filled_cells")

    def measure(cells, target, inputs=(), **of_workbook):
        counts.clear()
        graph = build_graph(Resolver(workbook(cells, **of_workbook)), [target], frozenset(inputs))
        return graph, dict(counts)

    return measure


def chain(n):
    """`A1` is drawn, and each cell below adds 1 to the one above."""
    return {"A1": 1.0} | {f"A{row}": f"=A{row - 1}+1" for row in range(2, n + 2)}


def ladder(n):
    """Each cell needs both cells of the row above: 2ⁿ ways through it."""
    cells = {"A1": 1.0, "B1": "=A1"}
    for row in range(2, n + 2):
        cells |= {f"A{row}": f"=A{row - 1}+B{row - 1}", f"B{row}": f"=A{row - 1}-B{row - 1}"}
    return cells


@pytest.mark.parametrize("cells", [chain, ladder])
def test_the_work_grows_with_the_cells(work, cells):
    _, once = work(cells(500), Cell("S", 501, 1), [Cell("S", 1, 1)])
    graph, twice = work(cells(1000), Cell("S", 1001, 1), [Cell("S", 1, 1)])
    assert twice["tree_or_stencil"] == len(graph.formulas)
    for name in once:
        assert twice[name] <= 2 * once[name] + 10, name


def test_each_cell_is_read_once_however_many_need_it(work):
    cells = {"A1": 1.0} | {f"B{row}": "=SUM(A$1:A$9)" for row in range(1, 200)} | {"C1": "=SUM(B1:B199)*SUM(B1:B199)"}
    graph, counts = work(cells, Cell("S", 1, 3))
    assert counts["tree_or_stencil"] == len(graph.formulas) == 200


def test_an_area_far_larger_than_the_sheet_is_not_walked_cell_by_cell(work):
    cells = {"A1": 1.0, "A1048576": "=A1+1", "B1": "=SUM(A1:A1048576)", "C1": "=SUM(A:XFD)-B1", "XFD9": 1.0}
    graph, counts = work(cells | {"D1": "=SUM($A:$A)"}, Cell("S", 1, 4), [Cell("S", 1, 1)])
    assert list(graph.formulas) == [Cell("S", 1_048_576, 1), Cell("S", 1, 4)]
    assert sum(counts.values()) < 100


def test_what_no_target_needs_is_not_read(work):
    needed = {"A1": 1.0, "B1": "=A1"}
    beside = {f"C{row}": f"=Missing{row}+" for row in range(1, 100)}
    graph, counts = work(needed | beside, Cell("S", 1, 2))
    assert counts["tree_or_stencil"] == len(graph.formulas) == 1


def test_a_held_cell_is_not_read(workbook):
    read = []

    class Listening(Resolver):
        def tree_or_stencil(self, cell, formula):
            read.append(cell.a1)
            return super().tree_or_stencil(cell, formula)

    cells = {"A1": 1.0, "B1": "=Missing+", "B2": "=A1", "C1": "=B1+B2"}
    held = frozenset([Cell("S", 1, 2)])
    graph = build_graph(Listening(workbook(cells)), [Cell("S", 1, 3)], frozenset([Cell("S", 1, 1)]), held)
    assert read == ["C1", "B2"]
    assert graph.reached == {Cell("S", 1, 1), Cell("S", 1, 2)}
    assert graph.varying == {Cell("S", 1, 1), Cell("S", 2, 2), Cell("S", 1, 3)}  # the held cell does not


def test_cells_that_spill_need_their_anchor_and_not_each_other(work, array):
    n = 500
    cells = {"A1": 1.0, "B1": array(f"=A1+SEQUENCE({n})", f"S!B1:B{n}", 2.0)}
    cells |= {f"B{row}": float(row) for row in range(2, n + 1)} | {"C1": f"=SUM(B1:B{n})"}
    graph, counts = work(cells, Cell("S", 1, 3), [Cell("S", 1, 1)])
    anchor = Cell("S", 1, 2)
    assert [graph.formulas[Cell("S", row, 2)] for row in range(2, n + 1)] == [anchor] * (n - 1)
    assert {graph.needs[Cell("S", row, 2)] for row in range(2, n + 1)} == {(anchor,)}
    assert next(iter(graph.formulas)) == anchor
    assert isinstance(graph.formulas[anchor], ir.Binary)
    assert counts["tree_or_stencil"] == 2
    assert counts["anchor"] < 3 * n


def test_the_anchor_of_a_spill_that_needs_its_own_cells_is_a_circle(work, array):
    cells = {"B1": array("=B3+{1;2;3}", "S!B1:B3", 1.0), "B2": 2.0, "B3": 3.0}
    graph, _ = work(cells, Cell("S", 1, 2))
    assert {error.message.partition("circle: ")[2] for error in graph.circles.values()} == {"S!B1 → S!B3 → S!B1"}
