"""The weight that piles up at the end of a range, however small all weights are."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.diagnostics.evidence_trials import _Outer


def outer(log_weight, log_weights):
    """1,000 trials in the outer twentieth of [0, 1], nearest to 1 first, with logarithms of weights."""
    result = _Outer(1.0, 0.95)
    result.add(1.0 - np.arange(1_000) / 20_000, log_weight + log_weights)
    return result


@pytest.mark.parametrize("log_weight", [0.0, -800.0, 800.0])
def test_the_share_at_the_end_of_a_range_does_not_depend_on_the_size_of_all_weights(log_weight):
    result = outer(log_weight, np.zeros(1_000))
    assert result.share(log_weight, 4_000.0) == pytest.approx(0.25)


@pytest.mark.parametrize(("slope", "share"), [(-4.0, 0.25), (0.0, 1.0), (8.0, 0.0)])
def test_weight_that_falls_towards_the_end_does_not_pile_up_there(slope, share):
    logs = slope * np.arange(1_000) / 1_000
    total = float(np.exp(logs - logs.max()).sum())
    result = outer(0.0, logs).share(float(logs.max()), total / share if share else total)
    assert result == pytest.approx(share)


def test_trials_further_in_do_not_count():
    result = _Outer(1.0, 0.95)
    result.add(np.array([0.94, 0.5]), np.zeros(2))
    assert result.share(0.0, 2.0) == 0.0
