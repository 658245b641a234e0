from __future__ import annotations

import numpy as np
import pytest
from scipy.special import bdtr, betaln, xlog1py, xlogy

from xlmc.statistics import inverse_proportion


def waiting_times(successes, p):
    """Numbers of trials until so many successes, and their probabilities; what is left out is below 1e-12."""
    n = np.arange(successes, int(successes / p * 8 + 200 / p))
    choose = -np.log(n) - betaln(n - successes + 1, successes)
    return n, np.exp(choose + xlogy(successes, p) + xlog1py(n - successes, -p))


CASES = [(2, 0.5), (2, 0.05), (5, 0.3), (20, 0.0176), (50, 0.6)]


@pytest.mark.parametrize(("successes", "p"), CASES)
def test_it_is_unbiased_and_so_is_its_variance(successes, p):
    n, weights = waiting_times(successes, p)
    assert weights.sum() == pytest.approx(1.0, abs=1e-9)
    found = (successes - 1) / (n - 1)
    assert (weights * found).sum() == pytest.approx(p, rel=1e-9)
    assert (weights * successes / n).sum() > p  # what it is not
    estimates = [inverse_proportion(successes, int(each)).value for each in n[:50]]
    assert estimates == pytest.approx(found[:50].tolist(), rel=1e-15)
    if successes > 2:
        variance = (weights * (found - p) ** 2).sum()
        keep = n > 2
        estimated = (weights * found * (1 - found) / np.where(keep, n - 2, 1))[keep].sum()
        assert estimated == pytest.approx(variance, rel=1e-6)


@pytest.mark.parametrize(("successes", "p"), CASES)
@pytest.mark.parametrize("confidence", [0.9, 0.95])
def test_either_end_misses_in_no_more_than_a_tail(successes, p, confidence):
    n, weights = waiting_times(successes, p)
    common = weights > 1e-9
    ends = np.array([inverse_proportion(successes, int(each), confidence=confidence).interval for each in n[common]])
    tail = (1 - confidence) / 2
    assert weights[common][ends[:, 0] > p].sum() <= tail + 1e-9
    assert weights[common][ends[:, 1] < p].sum() <= tail + 1e-9


def test_the_ends_are_where_the_observed_is_as_rare_as_a_tail():
    low, high = inverse_proportion(20, 1000).interval
    assert 1.0 - bdtr(19, 1000, low) == pytest.approx(0.025, rel=1e-9)  # as few trials, or fewer
    assert bdtr(19, 999, high) == pytest.approx(0.025, rel=1e-9)  # as many, or more


def test_every_trial_a_success():
    found = inverse_proportion(50, 50)
    assert found.value == 1.0
    assert found.error > 0.0
    assert found.interval[1] == 1.0
    assert 0.9 < found.interval[0] < 1.0
    assert inverse_proportion(2, 2).value == 1.0


def test_seeded_replicates():
    """20,000 runs: the mean of the estimates lies within 4 of its standard errors."""
    draws = np.random.default_rng(5).negative_binomial(10, 0.02, 20_000) + 10
    found = np.array([inverse_proportion(10, int(n)).value for n in draws])
    assert abs(found.mean() - 0.02) < 4 * found.std() / np.sqrt(found.size)


@pytest.mark.parametrize(("successes", "trials"), [(1, 5), (0, 5), (6, 5)])
def test_what_cannot_be(successes, trials):
    with pytest.raises(ValueError, match="successes, waited for in"):
        inverse_proportion(successes, trials)
