from __future__ import annotations

import math

import pytest

from xlmc.analysis.studies.optimising.selection import Rival, _exceeds


@pytest.mark.parametrize(
    ("ahead", "error", "significant"),
    [(3.0, 1.0, True), (-3.0, 1.0, True), (2.9, 1.0, False), (-2.9, 1.0, False), (0.0, 0.0, False), (1.0, 0.0, True)],
)
def test_a_difference_is_significant_from_three_standard_errors_on(ahead, error, significant):
    assert Rival((1.0,), ahead, error, chance=0.5, trials=100, meets=True).significant is significant


@pytest.mark.parametrize(
    ("ahead", "error", "indifference", "chance"),
    [
        (1.0, 1.0, 1.0, 0.5),
        (2.0, 1.0, 1.0, 0.841345),
        (0.0, 0.5, 1.0, 0.022750),
        (1.0, 0.0, 1.0, 0.0),  # exact, and no larger than what does not matter
        (1.1, 0.0, 1.0, 1.0),
        (0.0, math.inf, 1.0, 1.0),  # nothing is known
    ],
)
def test_the_probability_that_a_difference_matters(ahead, error, indifference, chance):
    assert _exceeds(ahead, error, indifference) == pytest.approx(chance, abs=1e-6)
