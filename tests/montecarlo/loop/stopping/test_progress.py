from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.montecarlo import statistics
from xlmc.montecarlo.loop.stopping.progress import RunningMoments

numbers = st.floats(-1e6, 1e6, allow_subnormal=False)
blocks = st.lists(st.lists(st.one_of(numbers, st.just(math.nan)), max_size=20), min_size=1, max_size=8)


def merged(parts, **more):
    running = RunningMoments(**more)
    for part in parts:
        running.add(np.array(part, np.float64))
    return running


@given(blocks)
def test_blocks_give_what_all_of_them_give_at_once(parts):
    values = np.array([value for part in parts for value in part if not math.isnan(value)])
    running = merged(parts)
    assert running.n == values.size
    scale = max(1.0, float(np.abs(values).max(initial=0.0)))
    result, expected = running.mean(), statistics.mean(values)
    assert result.value == pytest.approx(expected.value, abs=1e-12 * scale, nan_ok=True)
    result, expected = running.standard_deviation(), statistics.standard_deviation(values)
    assert result.value == pytest.approx(expected.value, abs=1e-7 * scale, nan_ok=True)


@pytest.mark.parametrize("draw", ["normal", "exponential", "uniform"])
@pytest.mark.parametrize("confidence", [0.9, 0.95])
def test_errors_and_intervals_are_those_of_the_statistics(draw, confidence):
    values = getattr(np.random.default_rng(3), draw)(size=5000) + 7.0
    running = merged(np.array_split(values, [10, 11, 900, 4000]))
    for name in ("mean", "standard_deviation"):
        result = getattr(running, name)(confidence)
        expected = getattr(statistics, name)(values, confidence=confidence)
        assert result.value == pytest.approx(expected.value, rel=1e-12)
        assert result.error == pytest.approx(expected.error, rel=1e-3)  # terms of order 1/n are left out
        assert result.interval == pytest.approx(expected.interval, rel=1e-3)
        assert result.n == expected.n


def test_digits_survive_far_from_zero():
    values = 1e9 + np.random.default_rng(1).normal(size=4000)
    running = merged(np.array_split(values, 7))
    assert running.deviation == pytest.approx(values.std(ddof=1), rel=1e-9)


def test_what_has_no_spread():
    running = merged([[2.0, 2.0], [2.0]])
    assert running.mean().interval == (2.0, 2.0)
    assert running.standard_deviation().value == 0.0


def test_nothing_and_one_have_no_error():
    assert math.isnan(RunningMoments().mean().value)
    assert merged([[1.0], [math.nan]]).mean().error is None
    assert math.isnan(merged([[1.0]]).standard_deviation().value)


def test_without_spread_the_mean_is_the_same():
    parts = np.array_split(np.random.default_rng(2).normal(size=100), 3)
    assert merged(parts, spread=False).mean() == merged(parts).mean()


def test_beyond_the_largest_number_nothing_is_precise():
    running = merged([[1e308, -1e308, 1e308]])
    assert running.mean().interval is None
