from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.samples import at_each, mean_of, pairs_of, row_sums, sample_of
from xlmc.excel.functions.values import NUM, Value, constant


def test_sums_run_from_left_to_right():
    x = np.array([[1e16, 1.0, -1e16], [1e16, -1e16, 1.0]])
    assert row_sums(x).tolist() == [0.0, 1.0]


def test_distances_of_equal_numbers_are_0_and_their_mean_is_the_number():
    mean, distance, k = mean_of(np.full((1, 10), 0.1), np.ones((1, 10), bool))
    assert (mean.item(), distance.any(), k.item()) == (0.1, False, 10)


def test_the_mean_of_nothing_is_0():
    mean, distance, k = mean_of(np.array([[1.0, 2.0]]), np.zeros((1, 2), bool))
    assert (mean.item(), distance.any(), k.item()) == (0, False, 0)


def test_distances_far_from_0_keep_their_digits():
    x = 2.0**40 + np.array([[3.0, 4.0, 6.0]])
    _, distance, _ = mean_of(x, np.ones((1, 3), bool))
    assert distance[0] == pytest.approx([-4 / 3, -1 / 3, 5 / 3], rel=1e-15)


def test_only_numbers_in_a_range_count(value):
    sample = sample_of(value([[1, "2", None], [True, 4, ErrorCode.NA]]))
    assert sample.counts.tolist() == [[True, False, False, False, True, False]]
    assert sample.ordered()[0].tolist() == [1, 4, *[np.inf] * 4]
    assert sample.errors.tolist() == [ErrorCode.NA]
    assert sample.size.tolist() == [[2]]


@pytest.mark.parametrize(("given", "number"), [(True, 1.0), ("12", 12.0), (None, 0.0)])
def test_what_is_given_directly_is_coerced(given, number):
    sample = sample_of(constant(given))
    assert (sample.x.item(), sample.counts.item()) == (number, True)


def test_pairs_need_ranges_of_one_size(value):
    assert pairs_of(value([[1, 2]]), value([[1, 2, 3]])) is None
    assert pairs_of(value([[1, 2]]), value([[1], [2]])) is not None


def test_a_body_is_asked_at_every_place_of_every_trial(value):
    @at_each()
    def above(sample, places):
        """How many numbers lie above; 9 is refused."""
        return np.where(places == 9, NUM, sample.count_where(np.greater, places))

    places = Value.of_numbers(np.array([[[0.0, 1.0]], [[2.0, 9.0]]]))
    assert above(value([[1, 2]]), places).objects().tolist() == [[[2.0, 1.0]], [[0.0, ErrorCode.NUM]]]
    assert above(value([[1, 2]]), constant(1)).objects().tolist() == [1.0]
    assert above.__doc__ == "How many numbers lie above; 9 is refused."
