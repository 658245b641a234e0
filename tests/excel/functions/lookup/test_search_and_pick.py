from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.lookup.search_and_pick import CELL_AT, POSITION, Pick, Search, numbers_of
from xlmc.excel.functions.values import ERROR, LOGICAL, NUMBER, Value, constant

STEADY = st.builds(
    lambda first, step, count, bend: [first + step * i + step * bend * (i % 3 - 1) for i in range(count)],
    st.sampled_from([0.0, -7.5, 1e6]),
    st.sampled_from([1e-6, 0.1, 10.0]),
    st.integers(2, 40),
    st.floats(0.0, 0.3),
)
"""Numbers that are evenly spaced, or nearly so: on either side of what a search takes for even."""
NUMBERS = st.one_of(st.lists(st.sampled_from([-2.5, -1.0, 0.0, 0.1, 0.3, 1.0, 4.0, 1e300]), min_size=1), STEADY)


def column(numbers):
    """A range of constants."""
    return Value(np.array(numbers, float).reshape(1, -1, 1), np.full((1, 1, 1), NUMBER, np.uint8))


def of_trials(numbers):
    """One number a trial."""
    return Value(np.asarray(numbers, float), np.full(1, NUMBER, np.uint8))


@given(NUMBERS, st.sampled_from([1.0, 0.0, -1.0]), st.data())
def test_a_search_finds_what_match_finds(numbers, order, data):
    numbers = sorted(set(numbers) if order < 0 else numbers, reverse=order < 0)
    numbers = numbers if order else data.draw(st.permutations(numbers))
    at = np.array(numbers)
    between = (at[1:] + at[:-1]) / 2
    keys = np.concatenate([at, np.nextafter(at, np.inf), np.nextafter(at, -np.inf), between, [-1e301, 1e301]])
    expected = REGISTRY["MATCH"]([of_trials(keys), column(numbers), constant(order)])
    missing = np.broadcast_to(expected.kinds >= ERROR, keys.shape)
    search = Search.of(at, order)
    assert [search.finds(keys[i : i + 1]) for i in range(keys.size)] == (~missing).tolist()
    assert search.finds(keys) == (not missing.any())
    result = keys[~missing]
    if result.size:
        assert search(result).tolist() == expected.numbers[~missing].tolist()
        assert search(result, out=result.copy()).tolist() == expected.numbers[~missing].tolist()
        own = result.copy()
        for indices in (
            search.indices(result),
            search.indices(result, out=result.copy()),
            search.indices(own, out=own),
        ):
            assert (indices + 1).tolist() == expected.numbers[~missing].tolist()


def test_numbers_that_are_not_in_order_are_not_searched():
    assert Search.of(np.array([1.0, 3.0, 2.0]), 1.0) is None
    assert Search.of(np.array([1.0, 2.0]), -1.0) is None
    assert Search.of(np.array([2.0, 2.0, 1.0]), -1.0) is None  # MATCH finds the first of equal numbers there
    assert Search.of(np.array([3.0, 1.0, 2.0]), 0.0) is not None


def test_evenly_spaced_numbers_are_found_by_a_division():
    assert Search.of(np.arange(0.0, 400.0, 10.0), 1.0).step == 10.0
    assert Search.of(np.array([0.0, 1.0, 4.0]), 1.0).step == 0.0


def test_the_division_alone_finds_where_no_number_next_to_a_step_misleads_it():
    assert Search.of(np.arange(0.0, 400.0, 10.0), 1.0).divides
    assert not Search.of(np.arange(41) * 0.1, 1.0).divides  # 3 * 0.1 is above 0.3


def test_steps_without_an_inverse_are_not_divided_by():
    assert Search.of(np.array([3e-308, np.nextafter(3e-308, 1.0)]), 1.0).step == 0.0
    assert Search.of(np.array([-1.7e308, 0.0, 1.7e308]), 1.0).step == 0.0


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=9), st.data())
def test_a_pick_gives_what_index_gives(numbers, data):
    positions = np.array(data.draw(st.lists(st.integers(1, len(numbers)), min_size=1)), float)
    expected = REGISTRY["INDEX"]([column(numbers), of_trials(positions)])
    assert Pick.of(np.array(numbers))(positions, out=positions.copy()).tolist() == expected.numbers.tolist()
    assert Pick.of(np.array(numbers)).at(positions.astype(np.int64) - 1).tolist() == expected.numbers.tolist()
    assert CELL_AT([column(numbers), of_trials(positions)]).numbers.tolist() == expected.numbers.tolist()


VARYING = Value(np.zeros((2, 3, 1)), np.full((1, 1, 1), NUMBER, np.uint8))
WIDE = Value(np.zeros((1, 2, 2)), np.full((1, 1, 1), NUMBER, np.uint8))
HALF_LOGICAL = Value(np.zeros((1, 2, 1)), np.array([NUMBER, LOGICAL], np.uint8).reshape(1, 2, 1))


@pytest.mark.parametrize(
    "value", [constant(1.0), VARYING, WIDE, HALF_LOGICAL], ids=["single", "varying", "wide", "logical"]
)
def test_only_a_constant_row_or_column_is_searched(value):
    assert numbers_of(value) is None


def test_the_position_of_a_key_without_one_is_its_error():
    result = POSITION([of_trials([0.5, 1.5]), column([1.0, 2.0]), constant(1.0)])
    assert result.objects().tolist()[1] == 1.0
    assert result.errors[0] > 0
