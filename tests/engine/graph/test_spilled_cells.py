"""Cells that dynamic arrays fill: which hold what, and which formulas might read more than the file says."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.graph.graph import MANY, Dag
from xlmc.engine.graph.nodes import Apply, Range
from xlmc.engine.graph.spilled_cells import _growing, _names_more, _pick, spilled_cell
from xlmc.excel.address import MAX_COLUMN, MAX_ROW, Area, Cell
from xlmc.excel.formula import Resolver, build_graph
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.values import from_objects
from xlmc.excel.workbook.workbook import CellContent, Formula

B2 = Cell("S", 2, 2)


def test_the_cells_of_an_array_of_known_size():
    dag = Dag()
    a, b, c = (dag.input(name) for name in "abc")
    column = dag.add(Range(((a,), (b,), (c,))))
    assert [spilled_cell(dag, column, row, 0) for row in range(4)] == [a, b, c, None]
    assert spilled_cell(dag, column, 0, 1) is None
    assert spilled_cell(dag, a, 0, 0) == a
    assert (spilled_cell(dag, a, 1, 0), spilled_cell(dag, a, 0, 1)) == (None, None)


def test_the_cells_of_an_array_whose_size_varies():
    dag = Dag()
    many = dag.add(Apply(REGISTRY["SEQUENCE"], (dag.input("a"),)))
    assert dag.sizes[many] == MANY
    node = dag.nodes[spilled_cell(dag, many, 2, 1)]
    cells = np.empty((1, 3, 2), object)
    cells[0] = [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]
    assert node.function([from_objects(cells)]).objects().tolist() == [6.0]


@pytest.mark.parametrize(
    ("rows", "row", "column", "expected"),
    [
        ([[1.0, None]], 0, 0, 1.0), ([[1.0, None]], 0, 1, 0.0), ([[1.0, None]], 1, 0, None),
        ([[1.0, None]], 0, 2, None), ([[1.0], [2.0]], 1, 0, 2.0), ([[1.0], [2.0]], 0, 1, None),
    ],
)  # fmt: skip
def test_what_a_cell_shows(rows, row, column, expected):
    """0 for an empty value within the array, and nothing beyond it."""
    cells = np.empty((1, len(rows), len(rows[0])), object)
    cells[0] = rows
    assert _pick(from_objects(cells), row, column).objects().tolist() == [expected]
    assert _pick(from_objects(np.array([7.0], object)), 0, 0).objects().tolist() == [7.0]
    assert _pick(from_objects(np.array([7.0], object)), 1, 0).objects().tolist() == [None]


@pytest.fixture
def graph(workbook):
    """`graph(array, cells)`: of a dynamic array in B2 that filled `array` as the file was saved."""

    def make(array, cells=(), dynamic=True):
        anchor = CellContent(1.0, Formula("SEQUENCE(A1)", 2, 2, array=array, dynamic=dynamic))
        book = workbook({"A1": 1.0, "B2": anchor, **dict.fromkeys(cells, 9.0)})
        return build_graph(Resolver(book, {}), [B2], frozenset(), frozenset())

    return make


@pytest.mark.parametrize(
    ("array", "cells", "size", "possible"),
    [
        (Area("S", 2, 2, 4, 2), (), (3, 1), None),
        (Area("S", 2, 2, 4, 2), (), (2, 1), None),
        (Area("S", 2, 2, 4, 2), (), (4, 1), Area("S", 2, 2, 5, 2)),
        (Area("S", 2, 2, 4, 2), (), (3, 2), Area("S", 2, 2, 4, 3)),
        (None, (), (1, 1), None),
        (None, (), (2, 3), Area("S", 2, 2, 3, 4)),
        (Area("S", 2, 2, 4, 2), (), MANY, Area("S", 2, 2, MAX_ROW, 2)),
        (Area("S", 2, 2, 4, 2), ("B9", "C7", "B12"), MANY, Area("S", 2, 2, 8, 2)),
        (Area("S", 2, 2, 4, 3), ("B9", "C7"), MANY, Area("S", 2, 2, 6, 3)),
        (Area("S", 2, 2, 4, 2), ("B5",), MANY, None),
        (Area("S", 2, 2, 2, 4), (), MANY, Area("S", 2, 2, 2, MAX_COLUMN)),
        (Area("S", 2, 2, 2, 4), ("H2", "F3"), MANY, Area("S", 2, 2, 2, 7)),
        (Area("S", 2, 2, 2, 2), ("B9",), MANY, Area("S", 2, 2, 8, 2)),
        (None, ("B4",), MANY, Area("S", 2, 2, 3, 2)),
    ],
)
def test_what_an_array_may_fill(graph, array, cells, size, possible):
    result = _growing(graph(array, cells), B2, *size)
    saved = array or Area("S", 2, 2, 2, 2)
    assert result == (None if possible is None else (B2, saved, possible))


def test_only_dynamic_arrays_grow(graph):
    assert _growing(graph(Area("S", 2, 2, 4, 2), dynamic=False), B2, *MANY) is None
    assert _growing(graph(None), Cell("S", 1, 1), *MANY) is None


SAVED, POSSIBLE = Area("S", 2, 2, 4, 3), Area("S", 2, 2, 9, 5)


@pytest.mark.parametrize(
    ("named", "more"),
    [
        (Cell("S", 4, 3), False), (Cell("S", 5, 3), True), (Cell("S", 4, 4), True), (Cell("S", 10, 3), False),
        (Cell("S", 5, 6), False), (Cell("T", 5, 3), False), (Area("S", 1, 1, 4, 3), False),
        (Area("S", 1, 1, 5, 3), True), (Area("S", 1, 1, 4, 4), True), (Area("S", 10, 1, 20, 9), False),
        (Area("S", 5, 1, 20, 1), False),
    ],
)  # fmt: skip
def test_references_to_more_than_was_saved(named, more):
    assert _names_more(named, SAVED, POSSIBLE) == more
