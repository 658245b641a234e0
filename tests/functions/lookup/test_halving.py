"""The search by halves against the same search for one key in one list, written with plain loops."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.functions.lookup.vector_search import last_not_beyond
from xlmc.functions.values import from_objects


def _place(key, cells, falling):
    low, high = -1, len(cells)
    while high - low > 1:
        middle = (low + high) // 2
        at = middle
        while at < high and type(cells[at]) is not type(key):
            at += 1
        if at == high:
            high = middle
        elif cells[at] == key:
            while at + 1 < high and type(cells[at + 1]) is type(key) and cells[at + 1] == key:
                at += 1
            return at
        elif (cells[at] < key) != falling:
            low = at
        else:
            high = at if at < high - 1 else middle
    return low


cells = st.sampled_from([0.0, 1.0, 2.0, 3.0, 4.0, "a", "b", True, None])


def _values(items, *shape):
    box = np.empty((len(items), *shape), object)
    for place, item in enumerate(items):
        box[place] = np.array(item, object).reshape(shape) if shape else item
    return from_objects(box)


@given(
    st.lists(st.tuples(cells.filter(lambda key: key is not None), *[cells] * 7), min_size=1, max_size=4),
    st.booleans(),
    st.booleans(),
)
def test_as_plain_loops_have_it(trials, falling, same_list):
    lists = [trials[0][1:] if same_list else trial[1:] for trial in trials]
    vector = _values(lists[:1] if same_list else lists, 7, 1)
    found = last_not_beyond(_values([trial[0] for trial in trials]), vector, falling=falling)
    expected = [_place(trial[0], row, falling) for trial, row in zip(trials, lists, strict=True)]
    assert found.tolist() == expected


@pytest.mark.parametrize("size", [1, 2, 7, 100])
def test_in_order_it_is_the_last_value_up_to_the_key(size):
    values = np.sort(np.random.default_rng(size).integers(0, size, size)) * 1.0
    wanted = np.arange(-1.0, size + 1, 0.5)
    found = last_not_beyond(_values(wanted.tolist()), _values([values.tolist()], size, 1))
    assert found.tolist() == (np.searchsorted(values, wanted, side="right") - 1).tolist()
