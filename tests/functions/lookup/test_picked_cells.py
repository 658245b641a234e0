from __future__ import annotations

import numpy as np
import pytest

from xlmc.functions.lookup.picked_cells import cell_of, flattened, joined, picked, side_by_side, transposed
from xlmc.functions.values import Value, constant, from_objects

ROWS = [[1.0, "b", True], [None, 5.0, "f"]]
CELLS = from_objects(np.array([ROWS], object))
VARYING = Value.of_numbers(np.arange(12.0).reshape(2, 2, 3))


def test_rows_become_columns():
    assert transposed(CELLS).objects().tolist() == [[[1, None], ["b", 5], [True, "f"]]]


def test_one_cell_of_each_trial():
    assert picked(CELLS, np.array([0, 1, 1]), np.array([1, 0, 2])).objects().tolist() == ["b", None, "f"]
    assert picked(VARYING, np.array([1, 0]), np.array([2])).numbers.tolist() == [5, 8]


def test_many_cells_of_each_trial():
    rows, columns = np.array([[[1], [0]]]), np.array([[[2, 0]], [[1, 1]]])
    assert picked(VARYING, rows, columns).numbers.tolist() == [[[5, 3], [2, 0]], [[10, 10], [7, 7]]]


@pytest.mark.parametrize(("row", "column", "expected"), [(1, 2, "f"), (0, 1, "b")])
def test_a_cell(row, column, expected):
    assert cell_of(CELLS, row, column).objects().tolist() == [expected]


def test_a_cell_of_what_stands_for_all():
    assert cell_of(constant(7), 4, 5).objects().tolist() == [7]
    assert cell_of(from_objects(np.array([[["a", "b"]]], object)), 3, 1).objects().tolist() == ["b"]


def test_side_by_side():
    found = side_by_side([constant("a"), Value.of_numbers(np.array([1.0, 2.0])), constant(None), constant(True)], 2, 2)
    assert found.objects().tolist() == [[["a", 1], [None, True]], [["a", 2], [None, True]]]


def test_joined():
    assert joined([VARYING, VARYING], axis=2).shape == (2, 2, 6)
    assert joined([CELLS, transposed(transposed(CELLS))], axis=0).objects().tolist() == [ROWS, ROWS]


def test_flattened():
    assert flattened(np.zeros((1, 1, 1)), VARYING).shape == (2, 6)
