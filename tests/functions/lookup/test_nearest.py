"""Equal, next smaller and next larger values against a model that tries them all."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from xlmc.functions.lookup.vector_search import EXACT, LARGER, SMALLER, nearest
from xlmc.functions.values import from_objects

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
    found = nearest(from_objects(wanted), from_objects(box), side, last=last)
    assert found.tolist() == [_place(trial[0], row, side, last) for trial, row in zip(trials, rows, strict=True)]


def test_wildcards_find_the_first_text_that_fits_or_the_last():
    box = np.empty((1, 5, 1), object)
    box[0, :, 0] = ["xa", 1.0, "b1", "b*", "B2"]
    wanted = np.array(["b?", "b~*", "*", "?", "xa"], object)
    for last, expected in ((False, [2, 3, 0, -1, 0]), (True, [4, 3, 4, -1, 0])):
        found = nearest(from_objects(wanted), from_objects(box), last=last, wildcards=True)
        assert found.tolist() == expected
