from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.montecarlo.statistics import Sample
from xlmc.montecarlo.statistics.sample import positions_of

EXAMPLES = settings(max_examples=50, deadline=None)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_values_must_be_finite_even_without_weight(bad):
    with pytest.raises(ValueError, match="finite"):
        Sample.of([1.0, bad])
    with pytest.raises(ValueError, match="finite"):
        Sample.of([1.0, bad], weights=[1.0, 0.0])


@pytest.mark.parametrize("weights", [[1.0, -1.0], [1.0, np.nan], [1.0, np.inf]])
def test_weights_must_be_finite_and_not_negative(weights):
    with pytest.raises(ValueError, match="weights must be finite"):
        Sample.of([1.0, 2.0], weights)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([[1.0, 2.0]],), "one column"),
        (([1.0, 2.0], [1.0]), "weights must match"),
        (([1.0, 2.0], None, [1]), "replicate ids must match"),
    ],
)
def test_shapes_must_match(arguments, message):
    with pytest.raises(ValueError, match=message):
        Sample.of(*arguments)


def test_sorts_and_carries_weights_and_replicates_along():
    sample = Sample.of([3.0, 1.0, 2.0], [6.0, 2.0, 4.0], [7, 9, 7])
    assert sample.x.tolist() == [1.0, 2.0, 3.0]
    assert sample.w == pytest.approx([1 / 6, 1 / 3, 1 / 2])
    assert sample.group.tolist() == [1, 0, 0]
    assert sample.units == 2


def test_leaves_the_callers_values_alone():
    values = np.array([3.0, 1.0, 2.0])
    Sample.of(values, np.ones(3))
    assert values.tolist() == [3.0, 1.0, 2.0]


def test_a_sample_is_its_own_sample():
    sample = Sample.of([1.0, 2.0])
    assert Sample.of(sample) is sample


def test_trials_without_weight_are_left_out():
    sample = Sample.of([1.0, 2.0, 3.0, 4.0], [0.0, 1.0, 3.0, 1e-40])
    assert sample.x.tolist() == [2.0, 3.0]


def test_no_weight_at_all_is_no_trial():
    assert Sample.of([1.0, 2.0], [0.0, 0.0]).n == 0


def test_effective_size_is_kishs():
    assert Sample.of([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]).effective == pytest.approx(36 / 14)
    assert Sample.of([1.0, 2.0, 3.0], [5.0, 5.0, 5.0]).effective == pytest.approx(3)


def test_weights_may_be_as_large_as_numbers_go():
    assert Sample.of([1.0, 2.0], [1e308, 1e308]).w.tolist() == [0.5, 0.5]


def test_many_replicates_are_joined_to_64_of_which_none_is_split():
    ids = np.repeat(np.arange(400), 5)
    sample = Sample.of(np.arange(2000.0), replicate=ids)
    assert sample.groups == 64
    assert all(np.unique(sample.group[ids == each]).size == 1 for each in range(400))


def test_replicate_ids_need_not_count_from_zero():
    assert Sample.of([1.0, 2.0, 3.0], replicate=[64, -5, 128]).groups == 3


def test_amounts_are_summed_over_each_independent_unit():
    amounts = np.array([1.0, 2.0, 4.0])
    assert Sample.of([1.0, 2.0, 3.0], None, [7, 9, 7]).per_unit(amounts).tolist() == [5.0, 2.0]
    assert Sample.of([1.0, 2.0, 3.0]).per_unit(amounts).tolist() == [1.0, 2.0, 4.0]


def test_a_replicate_alone_has_weights_that_sum_to_1():
    sample = Sample.of([1.0, 2.0, 3.0], [1.0, 1.0, 3.0], [0, 1, 1]).replicate(1)
    assert sample.x.tolist() == [2.0, 3.0]
    assert sample.w == pytest.approx([1 / 4, 3 / 4])
    assert sample.group is None


@EXAMPLES
@given(st.lists(st.floats(1e-6, 1e6), min_size=2, max_size=40))
def test_positions_run_from_0_to_1(weights):
    positions = positions_of(np.array(weights))
    assert positions[0] == 0.0
    assert positions[-1] == 1.0
    assert np.all(np.diff(positions) > -1e-15)


@EXAMPLES
@given(st.integers(2, 60))
def test_equal_weights_stand_at_equal_distances(n):
    assert positions_of(np.full(n, 0.3)) == pytest.approx(np.linspace(0, 1, n))


@pytest.mark.parametrize("weighted", [False, True], ids=["plain", "equal weights"])
@pytest.mark.parametrize(
    ("values", "p", "expected"),
    [
        ([10, 10, 20, 30], 0.0, 10),
        ([10, 10, 20, 30], 0.5, 10),
        ([10, 10, 20, 30], 0.51, 20),
        ([10, 10, 20, 30], 0.75, 20),
        ([10, 10, 20, 30], 1.0, 30),
        (list(range(100)), 0.07, 6),  # 0.07 * 100 is a little more than 7
        (list(range(100)), 0.29, 28),
        (list(range(1000)), 1 - 0.9, 99),
    ],
)
def test_the_first_value_that_a_share_does_not_exceed(values, p, expected, weighted):
    sample = Sample.of(values, np.ones(len(values)) if weighted else None)
    assert sample.reaching(p) == expected


def test_it_counts_weights():
    sample = Sample.of([10, 20, 30], [1, 2, 5])
    assert [sample.reaching(p) for p in (0.1, 0.125, 0.126, 0.375, 0.376)] == [10, 10, 20, 20, 30]


@pytest.mark.parametrize(
    ("values", "sure", "at_most"),
    [
        ([0.0, 1.0], True, True),
        ([1.0, 0.0, 1.0], True, True),
        ([1.0, 1.0], True, True),
        ([0.0, 0.5], False, False),
        ([0.0, 0.5, 1.0], False, False),
        ([0.5, 0.5], False, False),
        ([-1.0, 0.0], False, False),
        ([1.0, 2.0], False, False),
        ([1.0], False, True),
        ([0.0], False, True),
        ([0.5], False, False),
        ([], False, False),
    ],
)
def test_which_values_are_yes_and_no(values, sure, at_most):
    """From one trial alone nobody knows it, and of no trial there is nothing to say."""
    sample = Sample.of(values)
    assert (sample.yes_no, bool(sample.yes_no_at_most)) == (sure, at_most)


@pytest.mark.parametrize(
    ("values", "whole"),
    [
        ([1.0, 2.0], True),
        ([1.0, 2.5], False),
        ([2.0, 2.0], False),
        ([2.0], False),
        ([0.0, 2.0**53 - 1], True),
        ([0.0, 2.0**53], False),
        ([-(2.0**53), 0.0], False),
    ],
)
def test_which_values_are_whole(values, whole):
    assert Sample.of(values).whole is whole


def test_values_that_no_draw_decides_are_yes_and_no_without_doubt():
    still = Sample.of([1.0, 1.0], still=True)
    assert (still.yes_no, bool(still.yes_no_at_most)) == (False, True)
    assert not Sample.of([1.0, 1.0], two_valued=False).yes_no
