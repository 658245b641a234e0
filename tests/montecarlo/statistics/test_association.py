from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.statistics import rank_correlation

pairs = st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=3, max_size=40)


@given(pairs)
def test_it_is_scipys_also_with_ties(values):
    x, y = np.array(values, dtype=float).T
    result = rank_correlation(x, y).value
    if np.ptp(x) == 0 or np.ptp(y) == 0:
        assert math.isnan(result)
    else:
        assert result == pytest.approx(stats.spearmanr(x, y).statistic, abs=1e-12)


@pytest.mark.parametrize("rho", [0.0, 0.5, -0.8])
def test_the_error_is_the_spread_from_run_to_run(rho):
    """500 runs know a spread to 3.2 %: four of those, and 3 % for the formula. Coverage: 95 % ± 4 binomial errors."""
    rng = np.random.default_rng(3)
    z = rng.normal(size=(500, 2, 300))
    z[:, 1] = rho * z[:, 0] + math.sqrt(1 - rho**2) * z[:, 1]
    result = [rank_correlation(*run) for run in z]
    assert np.mean([each.error for each in result]) == pytest.approx(np.std([each.value for each in result]), rel=0.16)
    truth = 6 / np.pi * np.arcsin(rho / 2)
    held = np.mean([each.interval[0] <= truth <= each.interval[1] for each in result])
    assert held == pytest.approx(0.95, abs=4 * math.sqrt(0.95 * 0.05 / 500) + 0.005)


def test_replicates():
    """Of independent trials they have the same error, which 16 of them know to 18 %: four of those."""
    rng = np.random.default_rng(4)
    x, ids = rng.normal(size=8000), np.arange(8000) // 500
    y = x + rng.normal(size=8000)
    plain, result = rank_correlation(x, y), rank_correlation(x, y, ids)
    assert result.value == plain.value
    assert result.error == pytest.approx(plain.error, rel=0.72)
    half = stats.t.ppf(0.975, 15) * result.error
    assert result.interval == pytest.approx((result.value - half, result.value + half))


@pytest.mark.parametrize("ids", [[0] * 30, [0] * 25 + [1] * 5])
def test_too_few_replicates_or_trials_in_them_give_no_error(ids):
    x = np.arange(30.0)
    assert rank_correlation(x, np.sin(x), ids).error is None


def test_columns_without_a_correlation_to_state():
    assert math.isnan(rank_correlation([], []).value)
    assert rank_correlation([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]).error is None
    assert rank_correlation(np.arange(9.0), -np.arange(9.0)).value == -1.0
    with pytest.raises(ValueError, match="of one length"):
        rank_correlation([1.0, 2.0], [1.0])


def test_of_no_trial_and_of_one_it_is_unknown():
    for n in (0, 1):
        assert math.isnan(rank_correlation(np.zeros(n), np.zeros(n)).value)
