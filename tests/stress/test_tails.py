"""A ratio whose denominator passes 0: it has no mean, and the run says so; its percentiles are as good as any."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats
from simulated import simulated

from xlmc.montecarlo.statistics import farthest_part

TRIALS, SEEDS = 5_000, 60


@pytest.fixture(scope="module")
def model():
    from stressing.tails import book

    return book()


@pytest.fixture(scope="module")
def runs(model):
    from stressing.tails import measure

    return [measure(model, TRIALS, seed)["found"] for seed in range(SEEDS)]


def test_it_is_told_of_the_ratio_alone(runs):
    assert all(run["ratio"]["told"] for run in runs)
    assert not any(run["normal"]["told"] for run in runs)
    assert np.mean([run["lognormal"]["told"] for run in runs]) < 0.3  # σ = 1: by then and now it hangs on one too


def test_the_mean_does_not_settle(model, runs):
    """The mean of n Cauchy numbers has the distribution of one: half of the means lie beyond ±1, whatever n is."""
    beyond = np.mean([abs(run["ratio"]["mean"]) > 1 for run in runs])
    assert beyond == pytest.approx(0.5, abs=4 * 0.5 / math.sqrt(SEEDS))
    normal = np.array([run["normal"]["mean"] for run in runs])
    assert np.abs(normal).max() < 5 / math.sqrt(TRIALS)


def test_its_percentiles_do(runs):
    held = sum(low <= 1.0 <= high for run in runs for low, high in [run["ratio"]["quartile interval"]])
    assert held / SEEDS > 0.95 - 4 * math.sqrt(0.95 * 0.05 / SEEDS)
    density = stats.cauchy.pdf(1.0)
    result = np.array([run["ratio"]["quartile"] for run in runs])
    assert result.std(ddof=1) == pytest.approx(math.sqrt(0.1875 / TRIALS) / density, rel=4 / math.sqrt(2 * SEEDS))


def test_the_notice_stands_in_notices_and_is_no_warning(model):
    run = simulated(model, 2_000, 1)
    (notice,) = [each for each in run.notices_of_run if "'ratio'" in each.message]
    assert notice in run.notices
    assert "depend on a single trial" in notice.message
    assert run.warnings == []


def test_few_trials_say_nothing_of_tails(model):
    assert not any("hang" in notice.message for notice in simulated(model, 900, 1).notices_of_run)


@pytest.mark.parametrize("weights", [None, [1.0, 1.0, 1.0, 1.0], [2.0, 2.0, 2.0, 2.0]])
def test_the_part_of_the_farthest(weights):
    assert farthest_part([1.0, 1.0, 5.0, 1.0], weights) == pytest.approx(0.75)
    assert farthest_part([3.0, -3.0]) == pytest.approx(0.5)
    assert farthest_part([0.0, 4.0], [3.0, 1.0]) == pytest.approx(0.75)


def test_what_does_not_vary_has_no_farthest_trial():
    for values in ([], [2.0], [2.0, 2.0]):
        assert math.isnan(farthest_part(values))
