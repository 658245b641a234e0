"""A limit moved over a few trials, counted by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.analysis.studies.sensitivity.moved_limit import LimitTrials, _round_below, grid, holds_to, moved_limit


def trials_of(relation="<=", limit=5.0, values=(1, 2, 3, 4, 5, 6, 7), forecasts=None, trials=100, loosened=50):
    values = np.array(values, np.float64)
    accepted = holds_to(relation, values, limit)
    forecasts = values * 10 if forecasts is None else np.array(forecasts, np.float64)
    return LimitTrials(relation, limit, values, accepted, forecasts[None], None, trials, loosened)


@pytest.mark.parametrize(
    ("relation", "holds"),
    [
        ("<=", [True, True, False, False]),
        ("<", [True, False, False, False]),
        (">=", [False, True, True, False]),
        (">", [False, False, True, False]),
    ],
)
def test_values_that_hold_to_a_limit(relation, holds):
    assert holds_to(relation, np.array([1.0, 2.0, 3.0, np.nan]), 2.0).tolist() == holds


@pytest.mark.parametrize(
    ("relation", "limit", "count"),
    [("<=", 5.0, 5), ("<=", 3.0, 3), ("<=", 6.5, 6), (">=", 5.0, 3), (">=", 6.0, 2), (">=", 2.0, 6)],
)
def test_trials_inside_a_moved_limit(relation, limit, count):
    assert trials_of(relation).inside(limit).sum() == count


def test_what_the_run_accepted_stays_accepted_within_a_looser_limit():
    """A trial that was accepted as the run counts is never lost by loosening, nor is one gained by tightening."""
    made = LimitTrials("<=", 5.0, np.array([5.0, 5.5, 4.0]), np.array([True, True, False]), np.ones((1, 3)), None, 3, 3)
    assert made.inside(5.0).tolist() == [True, True, False]
    assert made.inside(5.2).tolist() == [True, True, True]
    assert made.inside(4.5).tolist() == [False, False, False]


@pytest.mark.parametrize(("loosened", "weight"), [(50, 2.0), (100, 1.0), (0, 100.0)])
def test_trials_that_are_known_of_fewer_stand_for_several(loosened, weight):
    assert trials_of(loosened=loosened).weights.tolist() == [1] * 5 + [weight] * 2


@pytest.mark.parametrize(
    ("size", "round_"),
    [(1.0, 1), (1.99, 1), (2.0, 2), (2.49, 2), (2.5, 2.5), (4.99, 2.5), (5.0, 5), (9.99, 5), (0.03, 0.025), (7e8, 5e8)],
)
def test_steps_are_round(size, round_):
    assert _round_below(size) == pytest.approx(round_, rel=1e-12)


@pytest.mark.parametrize(
    ("limit", "values", "limits"),
    [
        (10.0, [4.0, 4.0, 4.0], [4, 6, 8, 10, 12, 14, 16]),  # a median distance of 6, in three steps
        (0.0, [-3.1, -3.2, np.nan, -3.0], [-3, -2, -1, 0, 1, 2, 3]),
        (1.0, [1.75, 1.76], [0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75]),
        (10.0, [10.0, 10.0, 12.0], []),
        (10.0, [], []),
        (10.0, [10.0 + 5e-9], []),
        (0.0, [1e-301], []),
    ],
)
def test_limits_to_try(limit, values, limits):
    assert list(grid(limit, np.array(values))) == pytest.approx(limits)


LIMITS = (3.0, 4.0, 5.0, 6.0, 7.0)


def test_answers_at_every_limit():
    made = trials_of()
    points, (slope,) = moved_limit(made, LIMITS, ["x"], [0.5])
    assert [each.limit for each in points] == list(LIMITS)
    assert [each.trials for each in points] == [3, 4, 5, 7, 9]  # either of the last two stands for two
    assert [each.acceptance.value for each in points] == pytest.approx([0.03, 0.04, 0.05, 0.05 + 1 / 50, 0.05 + 2 / 50])
    means = [each.answers[0].mean.value for each in points]
    assert means == pytest.approx([20, 25, 30, (150 + 120) / 7, (150 + 120 + 140) / 9])
    changes = [each.answers[0].change.value for each in points]
    assert changes == pytest.approx([mean - 30 for mean in means])
    assert changes[2] == 0
    assert (slope.forecast, slope.mean.value) == ("x", pytest.approx((270 / 7 - 25) / 2))
    low, high = points[2].answers[0].low, points[2].answers[0].high
    assert (low.value, high.value) == pytest.approx((20, 40))


def test_errors_of_means_and_of_the_acceptance():
    points, _ = moved_limit(trials_of(), LIMITS, ["x"], [0.5])
    now = points[2]
    assert now.answers[0].mean.error == pytest.approx(np.std([10, 20, 30, 40, 50]) / math.sqrt(5), rel=0.2)
    assert now.answers[0].change.error == pytest.approx(0, abs=1e-12)
    assert now.acceptance.error == pytest.approx(math.sqrt(0.05 * 0.95 / 100), rel=0.01)
    looser = points[4].acceptance
    parts = math.sqrt(0.05 * 0.95 / 100), math.sqrt(0.04 * 0.96 / 50)
    assert looser.error == pytest.approx(math.hypot(*parts), rel=0.01)


def test_forecasts_without_a_number_and_limits_without_a_trial():
    made = trials_of(forecasts=[np.nan, 20, 30, np.nan, 50, 60, 70])
    points, _ = moved_limit(made, (0.5, 2.0, 5.0, 6.0), ["x"], [0.5])
    means = [each.answers[0].mean for each in points]
    assert math.isnan(means[0].value)
    assert (means[1].value, means[1].error) == (20, None)  # one trial has no error
    assert means[2].value == pytest.approx(100 / 3)


def test_very_large_answers_do_not_overflow():
    made = trials_of(forecasts=[1e308] * 7)
    points, _ = moved_limit(made, LIMITS, ["x"], [0.5])
    assert points[2].answers[0].mean.value == pytest.approx(1e308)
