from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.distributions.custom import Custom
from xlmc.montecarlo.distributions.parameters import DataError

B = np.nan


def test_the_example_of_the_users_guide():
    """Ranges, whole dollars from 60 to 80, and two single values."""
    cost = Custom().built(
        np.array([[10, 20, 0.2, B], [20, 30, 0.1, B], [40, 50, 0.3, B], [60, 80, 0.3, 1], [90, B, 0.05, B]])
    )
    assert cost.name == "Custom"
    assert cost.support() == (10, 90)
    assert cost.mean() == pytest.approx((0.2 * 15 + 0.1 * 25 + 0.3 * 45 + 0.3 * 70 + 0.05 * 90) / 0.95, rel=1e-14)
    assert cost.cdf(70.0) == pytest.approx((0.6 + 0.3 * 11 / 21) / 0.95, rel=1e-14)


def test_cumulative_weights():
    once = Custom().built(np.array([[5, 15, 0.75], [16, 21, 1.0]]), cumulative=True)
    assert once.cdf(15.0) == 0.75


def test_bad_data_are_told_with_their_place():
    with pytest.raises(DataError, match="overlaps") as caught:
        Custom().built(np.array([[0.0, 5, 1], [4, 9, 1]]))
    assert (caught.value.row, caught.value.column, caught.value.also) == (1, 0, (0, 0))


def test_it_has_no_cutoffs():
    assert not Custom.data.truncates


def test_a_family_without_data_cannot_be_built():
    from xlmc.montecarlo.distributions import FAMILIES

    with pytest.raises(TypeError, match="Normal is not built from data"):
        FAMILIES["Normal"].built(np.zeros((1, 1)))
