"""The searches by halves and downwards against plain loops; the others against a model that tries all values."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.excel.functions.lookup.vector_search import (
    EXACT,
    LARGER,
    SMALLER,
    before_first_smaller,
    last_not_beyond,
    nearest,
)
from xlmc.excel.functions.values import from_objects

cells = st.sampled_from([0.0, 1.0, 2.0, 3.0, "a", "b", "bc", True, False, None])


def _place(key, row, side, last):
    like = [(cell, place) for place, cell in enumerate(row) if type(cell) is type(key)]
    if key is not None and side != EXACT:
        like = [(cell, place) for cell, place in like if (cell <= key if side == SMALLER else cell >= key)]
        best = (max if side == SMALLER else min)((cell for cell, _ in like), default=None)
        key = best
    hits = [place for cell, place in like if cell == key]
    return (hits[-1] if last else hits[0]) if hits else -1


@given(
    st.lists(st.tuples(cells, *[cells] * 5), min_size=1, max_size=4),
    st.sampled_from([EXACT, SMALLER, LARGER]),
    st.booleans(),
    st.booleans(),
)
def test_as_the_model_has_it(trials, side, last, same_list):
    rows = [trials[0][1:] if same_list else trial[1:] for trial in trials]
    box = np.empty((1 if same_list else len(trials), 1, 5), object)
    for place in range(len(box)):
        box[place, 0] = rows[place]
    wanted = np.empty(len(trials), object)
    wanted[:] = [trial[0] for trial in trials]
    result = nearest(from_objects(wanted), from_objects(box), side, last=last)
    assert result.tolist() == [_place(trial[0], row, side, last) for trial, row in zip(trials, rows, strict=True)]


def test_wildcards_find_the_first_text_that_fits_or_the_last():
    box = np.empty((1, 5, 1), object)
    box[0, :, 0] = ["xa", 1.0, "b1", "b*", "B2"]
    wanted = np.array(["b?", "b~*", "*", "?", "xa"], object)
    for last, expected in ((False, [2, 3, 0, -1, 0]), (True, [4, 3, 4, -1, 0])):
        result = nearest(from_objects(wanted), from_objects(box), last=last, wildcards=True)
        assert result.tolist() == expected


def _place_halving(key, cells_halving, falling):
    low, high = -1, len(cells_halving)
    while high - low > 1:
        middle = (low + high) // 2
        at = middle
        while at < high and type(cells_halving[at]) is not type(key):
            at += 1
        if at == high:
            high = middle
        elif cells_halving[at] == key:
            while at + 1 < high and type(cells_halving[at + 1]) is type(key) and cells_halving[at + 1] == key:
                at += 1
            return at
        elif (cells_halving[at] < key) != falling:
            low = at
        else:
            high = at if at < high - 1 else middle
    return low


cells_halving = st.sampled_from([0.0, 1.0, 2.0, 3.0, 4.0, "a", "b", True, None])


def _values(items, *shape):
    box = np.empty((len(items), *shape), object)
    for place, item in enumerate(items):
        box[place] = np.array(item, object).reshape(shape) if shape else item
    return from_objects(box)


@given(
    st.lists(
        st.tuples(cells_halving.filter(lambda key: key is not None), *[cells_halving] * 7), min_size=1, max_size=4
    ),
    st.booleans(),
    st.booleans(),
)
def test_as_plain_loops_have_it(trials, falling, same_list):
    lists = [trials[0][1:] if same_list else trial[1:] for trial in trials]
    vector = _values(lists[:1] if same_list else lists, 7, 1)
    result = last_not_beyond(_values([trial[0] for trial in trials]), vector, falling=falling)
    expected = [_place_halving(trial[0], row, falling) for trial, row in zip(trials, lists, strict=True)]
    assert result.tolist() == expected


@pytest.mark.parametrize("size", [1, 2, 7, 100])
def test_in_order_it_is_the_last_value_up_to_the_key(size):
    values = np.sort(np.random.default_rng(size).integers(0, size, size)) * 1.0
    wanted = np.arange(-1.0, size + 1, 0.5)
    result = last_not_beyond(_values(wanted.tolist()), _values([values.tolist()], size, 1))
    assert result.tolist() == (np.searchsorted(values, wanted, side="right") - 1).tolist()


def _place_downwards(key, row):
    before = -1
    for place, cell in enumerate(row):
        if type(cell) is not type(key):
            continue
        if cell == key:
            return place
        if cell < key:
            return before
        before = place
    return before


@given(
    st.lists(
        st.tuples(cells_halving.filter(lambda key: key is not None), *[cells_halving] * 7), min_size=1, max_size=4
    ),
    st.booleans(),
)
def test_downwards_as_a_plain_loop_has_it(trials, same_list):
    lists = [trials[0][1:] if same_list else trial[1:] for trial in trials]
    vector = _values(lists[:1] if same_list else lists, 7, 1)
    result = before_first_smaller(_values([trial[0] for trial in trials]), vector)
    assert result.tolist() == [_place_downwards(trial[0], row) for trial, row in zip(trials, lists, strict=True)]
