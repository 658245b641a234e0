from __future__ import annotations

import numpy as np
import pytest

from xlmc.functions.lookup.picked_cells import by_portions, width_of
from xlmc.functions.values import TEXT, ShapeVaries, Value, constant, from_objects

N = 1000
VARYING = Value.of_numbers(np.arange(float(N)))
WIDE = 2**19  # so that four trials make a portion


def test_portions_are_joined_in_their_order():
    seen = []

    def compute(x, y):
        seen.append(x.shape[0])
        assert y.shape == (1,)
        return Value.of_numbers(x.numbers + y.numbers)

    found = by_portions(compute, [VARYING, constant(0.5)], WIDE)
    assert found.numbers.tolist() == [i + 0.5 for i in range(N)]
    assert seen == [4] * 250


def test_few_trials_are_one_portion():
    assert by_portions(lambda x: x, [VARYING], 1) is VARYING


def test_constants_texts_and_numbers_go_together():
    def compute(x):
        if x.numbers[0] == 0:
            return constant("first")
        return x if x.numbers[0] < 8 else constant(None)

    found = by_portions(compute, [VARYING], WIDE).objects().tolist()
    assert found[:9] == ["first"] * 4 + [4, 5, 6, 7] + [None]
    assert set(found[8:]) == {None}


def test_texts_are_cut_with_the_rest():
    texts = from_objects(np.array([str(i) for i in range(N)], object))
    found = by_portions(lambda x: x, [texts], WIDE)
    assert found.texts.tolist() == texts.texts.tolist()
    assert (found.kinds == TEXT).all()


def test_portions_of_different_shapes_are_no_one_value():
    with pytest.raises(ShapeVaries):
        by_portions(lambda x: x if x.numbers[0] == 0 else x.as_range(), [VARYING], WIDE)


def test_the_width_is_that_of_what_varies():
    table = Value.of_numbers(np.zeros((5, 2, 3)))
    assert width_of(table, Value.of_numbers(np.zeros((1, 90, 90))), VARYING) == 6
    assert width_of(constant(1)) == 0
