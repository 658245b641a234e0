"""Acceptance by rejection from 1e-2 to 1e-6, of trials that were fixed before and of those that were waited for."""

from __future__ import annotations

import math

import numpy as np
import pytest
from simulated import simulated


@pytest.mark.parametrize("rate", [1e-2, 1e-6])
def test_the_interval_covers_however_few_are_accepted(rate):
    """Exact, no simulation: 92.5 % at least and 97 % on average, from 0.05 accepted trials expected to 60."""
    from stressing.accepted import shares

    result = shares(rate, np.geomspace(0.05, 60.0, 13))["coverage"]
    assert min(result["xlmc"]) > 0.925
    assert 0.95 < np.mean(result["xlmc"]) < 0.985
    assert min(result["Wilson"]) < 0.86  # without what xlmc does about a few hits


@pytest.mark.parametrize(("rate", "wanted"), [(1e-2, 100), (1e-2, 2), (1e-4, 10), (1e-6, 2)])
def test_a_share_that_was_waited_for_is_right_on_average(rate, wanted):
    """Exact but for 2e-9 of the probability, whose shares may be large, and for grouping trials: 0.1 % in all."""
    from stressing.accepted import waited_for

    result = waited_for(rate, wanted, 4_000)
    assert result["coverage"] == pytest.approx(0.95, abs=0.002)
    assert abs(result["(N-1)/(n-1)"]) < 1e-3
    assert result["N/n"] == pytest.approx(1 / (wanted - 1), rel=0.1)  # the share as it is usually given


@pytest.fixture(scope="module")
def strict(book):
    """Accepts 1 trial in 2,000."""
    given = {name: {"cell": cell, "low": 0.0, "high": 1.0} for name, cell in (("u", "A1"), ("v", "A2"))}
    filters = {"f": {"cell": "A1", "below": 5e-4}}
    return book({"A1": 0.5, "A2": 0.5, "B1": "=A1+A2"}, given, {"x": "B1"}, filters)


def test_runs_of_a_strict_filter(strict):
    """100 runs with 2 accepted trials expected: the interval of the acceptance holds 1 in 2,000 in 95 % less 4
    standard errors of them; the average share is right to 4 standard errors."""
    runs = [simulated(strict, 4_000, seed, keep_inputs=0) for seed in range(100)]
    held = sum(run.acceptance.interval[0] <= 5e-4 <= run.acceptance.interval[1] for run in runs)
    assert held / 100 > 0.95 - 4 * math.sqrt(0.95 * 0.05 / 100)
    assert np.mean([run.accepted for run in runs]) == pytest.approx(2.0, abs=4 * math.sqrt(2.0 / 100))
    assert {0, 1, 2, 3} < {run.accepted for run in runs}


def test_none_accepted_says_how_many_may_be(strict):
    run = next(run for run in (simulated(strict, 1_000, seed) for seed in range(20)) if run.accepted == 0)
    assert run.acceptance.interval[1] > 5e-4
    assert "or accept fewer than 0.39 % of the trials. " in run.warnings[0]


def test_waiting_for_accepted_trials(strict):
    """40 runs until 20 are accepted: the share is right to 4 standard errors, and so is what was accepted."""
    runs = [simulated(strict, seed=seed, until_accepted=20, keep_inputs=0) for seed in range(40)]
    assert {run.accepted for run in runs} == {20}
    shares = np.array([run.acceptance.value for run in runs])
    assert shares.mean() == pytest.approx(5e-4, abs=4 * shares.std(ddof=1) / math.sqrt(40))
    pooled = np.concatenate([run["x"].values for run in runs])
    assert pooled.mean() == pytest.approx(0.50025, abs=4 * math.sqrt(1 / 12 / pooled.size))
