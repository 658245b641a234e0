"""What is said of the errors of long tails: one thing of each number."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.loop.forecast_result import interval_notices
from xlmc.montecarlo.statistics import Sample, errors_from_trials, too_short


@pytest.fixture(scope="module")
def long_tailed():
    """Lognormal, sigma 1.5, in 16 replicates of which each has one number from every interval."""
    from scipy.special import ndtri

    rng = np.random.default_rng(1)
    u = np.concatenate([(rng.permutation(1024) + rng.random(1024)) / 1024 for _ in range(16)])
    return Sample.of(np.exp(1.5 * ndtri(u)), replicate=np.repeat(np.arange(16), 1024))


def test_a_number_whose_interval_may_be_too_short_is_not_said_to_vary_less(long_tailed):
    assert set(too_short(long_tailed)) & set(errors_from_trials(long_tailed))
    short, plain = [each.message for each in interval_notices({"x": long_tailed}, "Latin hypercube")]
    assert "The interval of the standard deviation of 'x' may be too short" in short
    assert "The error of the mean of 'x' is that of independent trials" in plain
    assert "standard deviation" not in plain
