from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.studies.fitting.goodness import anderson_darling, kolmogorov_smirnov, kolmogorov_smirnov_of_counts

X = np.sort(np.random.default_rng(1).normal(0.1, 1.1, 50))


def test_anderson_darling_against_scipy():
    theirs = stats.goodness_of_fit(
        stats.norm, X, known_params={"loc": 0, "scale": 1}, statistic="ad", n_mc_samples=1
    ).statistic
    assert anderson_darling(stats.norm.cdf(X)) == pytest.approx(theirs, rel=1e-12)


def test_a_value_on_the_end_is_infinitely_far():
    assert anderson_darling(np.array([0.0, 0.5])) == anderson_darling(np.array([0.5, 1.0])) == np.inf


def test_kolmogorov_smirnov_against_scipy():
    assert kolmogorov_smirnov(stats.norm.cdf(X)) == pytest.approx(stats.kstest(X, "norm").statistic, rel=1e-14)


def test_kolmogorov_smirnov_of_counts_looks_at_every_whole_number():
    x = np.sort(np.random.default_rng(2).poisson(4, 60)).astype(float)
    oracle = stats.poisson(4.2)
    expected = max(abs(np.mean(x <= k) - oracle.cdf(k)) for k in range(-1, 30))
    assert kolmogorov_smirnov_of_counts(x, oracle.cdf) == pytest.approx(expected, rel=1e-14)
