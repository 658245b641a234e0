from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.report.page.scale import scale_of

numbers = st.floats(-1e12, 1e12).filter(lambda x: x == 0 or abs(x) > 1e-12)


@given(st.lists(numbers, min_size=1, max_size=8))
def test_every_value_and_tick_stands_between_the_ends(values):
    scale = scale_of(values, 100.0, 500.0)
    assert all(100.0 - 1e-6 <= scale(value) <= 500.0 + 1e-6 for value in values)
    assert all(100.0 - 1e-6 <= scale(tick) <= 500.0 + 1e-6 for tick in scale.ticks)
    assert 1 <= len(scale.ticks) <= 7


@pytest.mark.parametrize("values", [[], [math.nan], [math.inf, -math.inf], [0.0], [5.0, 5.0]])
def test_what_has_no_width_is_given_one(values):
    scale = scale_of(values, 0.0, 1.0)
    assert scale.low < scale.high
    assert scale.ticks


@pytest.mark.parametrize(
    ("values", "ticks"),
    [
        ([0.0, 71.0], [0.0, 20.0, 40.0, 60.0]),
        ([-0.3, 0.2], [-0.3, -0.2, -0.1, 0.0, 0.1, 0.2]),
        ([0.0, 3e-7], [0.0, 1e-7, 2e-7, 3e-7]),
    ],
)
def test_ticks_are_round(values, ticks):
    assert scale_of(values, 0.0, 1.0).ticks == ticks


def test_it_may_run_upwards():
    scale = scale_of([0.0, 10.0], 200.0, 20.0)
    assert scale(0.0) > scale(5.0) > scale(10.0)
    assert scale.text(-0.5) == "−0.5"
