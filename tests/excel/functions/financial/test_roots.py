from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.excel.functions.financial.roots import growth_root


def test_the_nearest_change_of_sign_counts():
    """1 + r = 2 and 1 + r = 3, seen from three guesses."""
    result = growth_root(lambda x: (np.exp(x) - 2) * (np.exp(x) - 3), np.array([0.5, 1.2, 5.0]))
    assert result == pytest.approx([1.0, 1.0, 2.0], rel=1e-14)


@given(st.floats(-32, 32))
def test_any_rate_is_found_to_the_last_digits(x):
    assert growth_root(lambda y: y - x, np.array([0.1]))[0] == pytest.approx(np.expm1(x), rel=1e-13, abs=1e-16)


def test_nothing_is_found_where_the_sign_stays_or_the_guess_is_no_rate():
    result = growth_root(lambda x: np.where(np.arange(3) == 1, x * x + 1, x), np.array([0.1, 0.1, -1.0]))
    assert result == pytest.approx([0.0, np.nan, np.nan], nan_ok=True, abs=1e-15)


def test_trials_do_not_wait_for_each_other_to_the_bit():
    slopes = np.array([1.0, 9.0, 1e-3, 7.0])

    def function(slope):
        return lambda x: np.expm1(slope * (x - 0.3)) + slope / 10

    with np.errstate(over="ignore"):
        together = growth_root(function(slopes), np.full(4, 0.1))
        alone = [growth_root(function(slopes[i : i + 1]), np.full(1, 0.1))[0] for i in range(4)]
    assert together.tolist() == alone
