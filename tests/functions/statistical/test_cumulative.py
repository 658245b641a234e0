from __future__ import annotations

import numpy as np
import pytest

from xlmc.functions.statistical.probabilities import by_form


def _never():
    raise AssertionError("it was asked for")


@pytest.mark.parametrize(
    ("cumulative", "probability", "density", "expected"),
    [
        ([True, False], lambda: np.array([1.0, 2.0]), lambda: np.array([3.0, 4.0]), [1, 4]),
        ([True, True], lambda: np.array([1.0, 2.0]), _never, [1, 2]),
        ([False, False], _never, lambda: np.array([3.0, 4.0]), [3, 4]),
        ([True, True], lambda: np.array([1.0]), _never, [1, 1]),
    ],
)
def test_only_the_form_that_a_trial_asks_for_is_computed(cumulative, probability, density, expected):
    assert by_form(np.array(cumulative), probability, density).tolist() == expected
