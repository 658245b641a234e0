from __future__ import annotations

import numpy as np
import pytest

from xlmc.excel.functions.lookup.picked_cells import (
    arrange,
    by_portions,
    cell_of,
    flatten_cells,
    join_values,
    pick,
    transpose_cells,
    width_of,
)
from xlmc.excel.functions.values import TEXT, ShapeVaries, Value, constant, from_objects

ROWS = [[1.0, "b", True], [None, 5.0, "f"]]
CELLS = from_objects(np.array([ROWS], object))
VARYING = Value.of_numbers(np.arange(12.0).reshape(2, 2, 3))


def test_rows_become_columns():
    assert transpose_cells(CELLS).objects().tolist() == [[[1, None], ["b", 5], [True, "f"]]]


def test_one_cell_of_each_trial():
    assert pick(CELLS, np.array([0, 1, 1]), np.array([1, 0, 2])).objects().tolist() == ["b", None, "f"]
    assert pick(VARYING, np.array([1, 0]), np.array([2])).numbers.tolist() == [5, 8]


def test_many_cells_of_each_trial():
    rows, columns = np.array([[[1], [0]]]), np.array([[[2, 0]], [[1, 1]]])
    assert pick(VARYING, rows, columns).numbers.tolist() == [[[5, 3], [2, 0]], [[10, 10], [7, 7]]]


@pytest.mark.parametrize(("row", "column", "expected"), [(1, 2, "f"), (0, 1, "b")])
def test_a_cell(row, column, expected):
    assert cell_of(CELLS, row, column).objects().tolist() == [expected]


def test_a_cell_of_what_stands_for_all():
    assert cell_of(constant(7), 4, 5).objects().tolist() == [7]
    assert cell_of(from_objects(np.array([[["a", "b"]]], object)), 3, 1).objects().tolist() == ["b"]


def test_side_by_side():
    result = arrange([constant("a"), Value.of_numbers(np.array([1.0, 2.0])), constant(None), constant(True)], 2, 2)
    assert result.objects().tolist() == [[["a", 1], [None, True]], [["a", 2], [None, True]]]


def test_joined():
    assert join_values([VARYING, VARYING], axis=2).shape == (2, 2, 6)
    assert join_values([CELLS, transpose_cells(transpose_cells(CELLS))], axis=0).objects().tolist() == [ROWS, ROWS]


def test_flattened():
    assert flatten_cells(np.zeros((1, 1, 1)), VARYING).shape == (2, 6)


N = 1000
VARYING_OF_PORTIONS = Value.of_numbers(np.arange(float(N)))
WIDE = 2**19  # so that four trials make a portion


def test_portions_are_joined_in_their_order():
    seen = []

    def compute(x, y):
        seen.append(x.shape[0])
        assert y.shape == (1,)
        return Value.of_numbers(x.numbers + y.numbers)

    result = by_portions(compute, [VARYING_OF_PORTIONS, constant(0.5)], WIDE)
    assert result.numbers.tolist() == [i + 0.5 for i in range(N)]
    assert seen == [4] * 250


def test_few_trials_are_one_portion():
    assert by_portions(lambda x: x, [VARYING_OF_PORTIONS], 1) is VARYING_OF_PORTIONS


def test_constants_texts_and_numbers_go_together():
    def compute(x):
        if x.numbers[0] == 0:
            return constant("first")
        return x if x.numbers[0] < 8 else constant(None)

    result = by_portions(compute, [VARYING_OF_PORTIONS], WIDE).objects().tolist()
    assert result[:9] == ["first"] * 4 + [4, 5, 6, 7] + [None]
    assert set(result[8:]) == {None}


def test_texts_are_cut_with_the_rest():
    texts = from_objects(np.array([str(i) for i in range(N)], object))
    result = by_portions(lambda x: x, [texts], WIDE)
    assert result.texts.tolist() == texts.texts.tolist()
    assert (result.kinds == TEXT).all()


def test_portions_of_different_shapes_are_no_one_value():
    with pytest.raises(ShapeVaries):
        by_portions(lambda x: x if x.numbers[0] == 0 else x.as_range(), [VARYING_OF_PORTIONS], WIDE)


def test_the_width_is_that_of_what_varies():
    table = Value.of_numbers(np.zeros((5, 2, 3)))
    assert width_of(table, Value.of_numbers(np.zeros((1, 90, 90))), VARYING_OF_PORTIONS) == 6
    assert width_of(constant(1)) == 0
