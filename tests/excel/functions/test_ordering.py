from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.ordering import order_key, search_each_trial, to_ordered
from xlmc.excel.functions.values import Value, from_objects


def _value(rows):
    return from_objects(np.array(rows, object))


def test_texts_of_all_values_share_one_order():
    left, right = to_ordered(_value(["b", 2.0, "A"]), _value([[["a", "C"], [None, ErrorCode.NA]]]))
    assert left.texts == right.texts == ("", "a", "b", "c")
    assert left.order.tolist() == [[2], [2], [1]]
    assert right.order.tolist() == [[1, 3, 0, 0]]


def test_what_stands_under_an_error_does_not_count():
    (result,) = to_ordered(Value(np.array([5.0, 6.0]), np.array([0, 17], np.uint8)))
    assert result.order.tolist() == [[5], [0]]


def test_keys_of_any_shape_are_sought_in_vectors_of_any_trials():
    shapes = []

    def find(keys, vector):
        shapes.append((keys.order.shape, vector.order.shape))
        return np.broadcast_to((vector.order == keys.order).argmax(axis=1), keys.order.shape[:1])

    keys = _value([[[1.0, 3.0]], [[2.0, 1.0]]])
    one = _value([[[3.0, 2.0, 1.0]]])
    two = _value([[[3.0, 2.0, 1.0]], [[1.0, 2.0, 3.0]]])
    assert search_each_trial(keys, one, find).tolist() == [[[2, 0]], [[1, 2]]]
    assert search_each_trial(keys, two, find).tolist() == [[[2, 0]], [[1, 0]]]
    assert search_each_trial(_value([3.0]), two, find).tolist() == [0, 2]
    assert shapes == [((4, 1), (1, 3)), ((2, 1), (2, 3)), ((2, 1), (2, 3)), ((2, 1), (2, 3))]


RISING = ["", " ", "!", "#", "_", "~", "+", "=", "0", "9", "a", "A2", "ab", "é", "ef", "Z", "Zo", "zö", "zz"]


def test_symbols_digits_letters():
    assert sorted(RISING[::2] + RISING[1::2], key=order_key) == RISING


@pytest.mark.parametrize(("left", "right"), [("abc", "ABC"), ("É", "é")])
def test_case_does_not_count(left, right):
    assert order_key(left) == order_key(right)


@pytest.mark.parametrize(("left", "right"), [("coop", "co-op"), ("its", "it's"), ("e", "é")])
def test_marks_count_between_equals_only(left, right):
    assert order_key(left) != order_key(right)
    assert order_key(right)[0] == order_key(left)[0]


def test_hyphens_do_not_part_a_word_from_its_like():
    assert sorted(["co-op", "cooper", "coop", "con"], key=order_key) == ["con", "co-op", "coop", "cooper"]
