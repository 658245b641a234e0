from __future__ import annotations

import math

import pytest

from xlmc.statistics import Estimate, maximum, minimum, range_width


def test_extremes_are_facts_without_an_error():
    assert minimum([3.0, -1.0, 2.0]) == Estimate(-1.0, None, None, 3)
    assert maximum([3.0, -1.0, 2.0]) == Estimate(3.0, None, None, 3)
    assert range_width([3.0, -1.0, 2.0]) == Estimate(4.0, None, None, 3)


def test_a_trial_without_weight_is_no_extreme():
    assert minimum([3.0, -1.0, 2.0], [1.0, 0.0, 1.0]) == Estimate(2.0, None, None, 2)


@pytest.mark.parametrize("statistic", [minimum, maximum, range_width])
def test_no_trials_give_nan(statistic):
    assert math.isnan(statistic([]).value)
    assert statistic([]).n == 0
