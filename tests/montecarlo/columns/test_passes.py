from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.montecarlo.columns import PART, ascending, numbers, on_disk, pairwise_sum, parts, passes, picked

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


def test_picked_from_a_column_of_more_pages_than_are_touched_at_once(stored):
    values = np.arange(passes._PICKED_FROM / 8 + 1)
    where = np.random.default_rng(5).integers(0, values.size, 2_000)
    assert picked(stored(values), where).tolist() == values[where].tolist()


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


RUN = 64


@pytest.fixture(autouse=True, scope="module")
def short_runs():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(passes, "RUN", RUN)
        yield


VALUES = st.one_of(st.floats(allow_nan=False), st.sampled_from((0.0, 1.0, 2.0)))


@settings(max_examples=200)
@given(st.lists(VALUES, max_size=20 * RUN), st.integers(1, 30))
def test_a_column_on_disk_is_sorted_as_in_memory(stored, values, times):
    column = np.array(values * times, float)
    result = ascending(stored(column))
    assert np.array_equal(result, np.sort(column))
    assert on_disk(result) == (column.size > 0)


@pytest.mark.parametrize("share_of_ties", [0.0, 0.5, 0.999, 1.0])
@pytest.mark.parametrize("order", ["random", "ascending", "descending"])
def test_no_piece_is_longer_than_two_runs(stored, monkeypatch, share_of_ties, order):
    rng = np.random.default_rng(3)
    column = np.where(rng.random(100 * RUN + 5) < share_of_ties, 0.5, rng.random(100 * RUN + 5))
    column = {"random": column, "ascending": np.sort(column), "descending": -np.sort(-column)}[order]
    written = []
    append = passes.Folder.append
    monkeypatch.setattr(
        passes.Folder,
        "append",
        lambda self, name, arrays: append(self, name, [written.append(array.size) or array for array in arrays]),
    )
    monkeypatch.setattr(passes, "PART", RUN)
    expected = np.sort(column)
    column = stored(column)
    written.clear()
    assert np.array_equal(ascending(column), expected)
    assert max(written) <= 2 * RUN


def test_in_memory_the_values_given_are_left_as_they_are():
    values = np.array([3.0, 1.0, 2.0])
    assert ascending(values).tolist() == [1, 2, 3]
    assert values.tolist() == [3, 1, 2]
