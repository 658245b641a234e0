from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import (
    align_ranges,
    error_everywhere,
    error_where,
    errors_unless_range,
    fill_blanks,
    first_error,
    first_error_in_row,
    require_same_in_all_trials,
    whole_numbers,
    with_errors,
)
from xlmc.excel.functions.values import ShapeVaries, Value, constant, from_objects

NA, NUM, VALUE = ErrorCode.NA, ErrorCode.NUM, ErrorCode.VALUE
ITEMS = from_objects(np.array([1.9, None, "-2.5", "x", NA], object))


def test_numbers_in_place_of_blanks():
    assert fill_blanks(ITEMS, 7.0).objects().tolist() == [1.9, 7, "-2.5", "x", NA]


def test_whole_numbers():
    numbers, errors = whole_numbers(ITEMS)
    assert numbers[:3].tolist() == [1, 0, -2]
    assert errors.tolist() == [0, 0, 0, VALUE, NA]


def test_leveled():
    grid = from_objects(np.array([[[1.0, 2.0]]], object))
    assert [value.shape for value in align_ranges(ITEMS, grid)] == [(5, 1, 1), (1, 1, 2)]
    assert align_ranges(ITEMS, ITEMS)[0] is ITEMS


def test_errors_of_a_range_are_its_cells_own_matter():
    grid = ITEMS.as_range()
    assert errors_unless_range(grid).tolist() == [0]
    assert errors_unless_range(ITEMS).tolist() == [0, 0, 0, 0, NA]
    assert errors_unless_range(ITEMS, grid).shape == (5, 1, 1)


def test_the_earliest_and_the_first_error():
    codes = np.array([[0, NA, NUM], [0, 0, 0], [NUM, NA, 0]], np.uint8)
    assert first_error_in_row(codes).tolist() == [NA, 0, NUM]
    assert first_error(*codes.T).tolist() == [NA, 0, NUM]
    assert error_where(np.array([True, False]), NA).tolist() == [NA, 0]


def test_errors_over_a_value():
    result = with_errors(constant(5), np.array([0, NA], np.uint8))
    assert result.objects().tolist() == [5, NA]
    assert result.numbers.tolist() == [5, 0]
    assert with_errors(constant(5), np.zeros((2, 1, 1), np.uint8)).shape == (2, 1, 1)


def test_one_error_in_place_of_all():
    assert error_everywhere(ITEMS, VALUE, np.array([0, 0, NUM, 0, 0], np.uint8)).objects().tolist() == [
        *[VALUE, VALUE, NUM],
        *[VALUE, VALUE],
    ]
    assert error_everywhere(Value.of_numbers(np.zeros((2, 1, 3))), NA, np.zeros(1, np.uint8)).shape == (2, 1, 3)


def test_what_decides_on_the_shape():
    assert require_same_in_all_trials(np.array([[1, 2], [1, 2]])).tolist() == [1, 2]
    with pytest.raises(ShapeVaries):
        require_same_in_all_trials(np.array([[1, 2], [1, 3]]))
