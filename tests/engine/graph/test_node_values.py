"""Arrays whose sizes are known only when they are computed, side by side, nested, and where one value is wanted."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.engine import column_of
from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.node_values import align, corner, evaluate_node, single
from xlmc.engine.graph.nodes import Range
from xlmc.errors import ErrorCode
from xlmc.excel.functions.values import Value, constant, from_objects

NA, CALC = ErrorCode.NA, ErrorCode.CALC


def array(rows, trials=1):
    return from_objects(np.array([rows] * trials, object))


@pytest.mark.parametrize(
    ("one", "other", "as_one", "as_other"),
    [
        ([[1.0], [2.0]], [[3.0], [4.0], [5.0]], [[1.0], [2.0], [NA]], [[3.0], [4.0], [5.0]]),
        ([[1.0, 2.0]], [["a"], [True], [None]], [[1.0, 2.0]], [["a"], [True], [None]]),
        ([[1.0]], [[1.0, 2.0], [3.0, 4.0]], [[1.0]], [[1.0, 2.0], [3.0, 4.0]]),
        ([[1.0, 2.0, 3.0]], [[4.0, 5.0]], [[1.0, 2.0, 3.0]], [[4.0, 5.0, NA]]),
        ([["a", "b"], ["c", "d"]], [[1.0, 2.0, 3.0]], [["a", "b", NA], ["c", "d", NA]], [[1.0, 2.0, 3.0]]),
    ],
)
def test_what_one_array_lacks_is_na(one, other, as_one, as_other):
    result = align([array(one), constant(7.0), array(other, trials=2)])
    assert result[0].objects()[0].tolist() == as_one
    assert result[1].objects().tolist() == [7.0]
    assert [trial.tolist() for trial in result[2].objects()] == [as_other] * 2


def test_an_array_in_a_cell_of_an_array_is_calc_but_for_one_of_one_cell():
    assert single(array([[5.0]], trials=2)).objects().tolist() == [5.0, 5.0]
    assert single(array([[5.0, 6.0]])).objects().tolist() == [CALC]
    assert single(constant("x")).objects().tolist() == ["x"]


def test_a_cell_shows_the_upper_left_value_of_an_array():
    assert corner(array([[5.0, 6.0], [7.0, 8.0]])).objects().tolist() == [5.0]
    assert corner(from_objects(np.empty((1, 0, 1), object))).objects().tolist() == [CALC]
    assert column_of(array([[5.0, 6.0]], trials=3), 3).values.tolist() == [5.0] * 3


def test_a_range_of_no_trials():
    dag = Dag()
    a, one = dag.input("a"), dag.constant(constant(1.0))
    node = dag.nodes[dag.add(Range(((a, one),)))]
    values = {a: Value.of_numbers(np.empty(0)), one: constant(1.0)}
    assert evaluate_node(node, values).shape == (0, 1, 2)
