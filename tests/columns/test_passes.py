from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.columns import PART, numbers, on_disk, pairwise_sum, parts, picked

SIZES = [0, 1, 7, 8, 129, PART - 1, PART, PART + 1, 2 * PART + 9, 300_001]


@pytest.mark.parametrize("n", SIZES)
def test_a_sum_in_parts_is_numpys_to_the_bit(n):
    values = np.random.default_rng(n).lognormal(sigma=3.0, size=n)
    assert pairwise_sum(lambda here: values[here], n) == values.sum()


@pytest.mark.parametrize("n", SIZES)
def test_parts_are_the_column(stored, n):
    values = np.arange(float(n))
    for column in (values, stored(values)):
        seen = [part.copy() for part in parts(column, 1000)]
        assert all(part.size == 1000 for part in seen[:-1])
        assert np.concatenate([np.empty(0), *seen]).tolist() == values.tolist()


@given(st.lists(st.integers(0, 4999), max_size=3000))
def test_picked_is_a_fancy_index(stored, places):
    values, where = np.arange(5000.0) ** 2, np.array(places, np.intp)
    assert picked(values, where).tolist() == picked(stored(values), where).tolist() == values[where].tolist()


@given(st.lists(st.sampled_from((1.0, 2.5, np.nan)), max_size=50))
def test_numbers_are_all_but_nan(stored, values):
    column = np.array(values, float)
    expected = [value for value in values if value == value]
    assert numbers(column).tolist() == expected
    assert numbers(stored(column)).tolist() == expected


def test_a_column_of_numbers_is_left_as_it_is(stored):
    for column in (np.arange(3.0), stored(np.arange(3.0))):
        assert numbers(column) is column
    assert on_disk(numbers(stored(np.array([1.0, np.nan]))))
