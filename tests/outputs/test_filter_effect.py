from __future__ import annotations

import numpy as np
import pytest

from xlmc.outputs.filter_effect import filter_effect, marginal

RANDOM = np.random.default_rng(11)


def test_shift_and_narrowing_are_those_of_the_marginals():
    prior, accepted = RANDOM.normal(10.0, 2.0, 50_000), RANDOM.normal(11.0, 1.0, 20_000)
    found = filter_effect(prior, accepted)
    assert found.shift.value == pytest.approx((accepted.mean() - prior.mean()) / prior.std(ddof=1))
    assert found.narrowing.value == pytest.approx(accepted.std(ddof=1) / prior.std(ddof=1))
    assert abs(found.shift.value - 0.5) < 4 * found.shift.error
    assert abs(found.narrowing.value - 0.5) < 4 * found.narrowing.error


def test_errors_are_what_other_seeds_would_change():
    runs = [filter_effect(RANDOM.normal(0.0, 2.0, 900), RANDOM.normal(1.0, 1.0, 300)) for _ in range(200)]
    for pick in (lambda run: run.shift, lambda run: run.narrowing):
        spread = np.std([pick(run).value for run in runs], ddof=1)
        stated = np.mean([pick(run).error for run in runs])
        assert stated == pytest.approx(spread, rel=4 / np.sqrt(2 * len(runs)))


def test_marginals_leave_out_draws_that_are_errors():
    found = marginal(np.array([1.0, np.nan, 3.0]))
    assert (found.trials, found.mean.value) == (2, 2.0)
    assert list(found.percentiles) == [5.0, 50.0, 95.0]


@pytest.mark.parametrize(
    ("prior", "accepted"), [([2.0] * 9, [2.0] * 3), ([], []), ([1.0], [1.0]), ([1.0, 2.0, 3.0], [])]
)
def test_where_there_is_nothing_to_compare_there_is_no_number(prior, accepted):
    found = filter_effect(np.array(prior), np.array(accepted))
    assert np.isnan(found.shift.value)
    assert np.isnan(found.narrowing.value)
    assert found.shift.error is None
    assert found.narrowing.error is None


def test_a_single_accepted_trial_has_a_shift_without_an_error():
    found = filter_effect(np.array([1.0, 2.0, 3.0]), np.array([3.0]))
    assert (found.shift.value, found.shift.error) == (pytest.approx(1.0), None)
    assert np.isnan(found.narrowing.value)
