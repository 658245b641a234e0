"""What a percentile needs, beside what repeated runs of distributions with known percentiles keep."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ndtri

from xlmc.analysis.studies.methods.quantile_need import quantile_need

SIZE = 1 << 18
SHARES = (np.arange(SIZE) + 0.5) / SIZE


def two_modes(u):
    """Normals about -10 and 10, the lower one with a share of .26."""
    return np.where(u < 0.26, -10 + ndtri(np.minimum(u / 0.26, 1 - 1e-12)), 10 + ndtri((u - 0.26).clip(1e-12) / 0.74))


CASES = [
    pytest.param(ndtri, 0.245, 0.033, id="normal"),
    pytest.param(ndtri, 0.975, 0.1, id="normal, far out"),
    pytest.param(two_modes, 0.245, 0.5, id="beside a gap"),
    pytest.param(lambda u: -np.log1p(-u), 0.755, 0.05, id="exponential"),
    pytest.param(lambda u: np.floor(5 * u), 0.245, 0.5, id="whole numbers"),
]


@pytest.mark.parametrize(("quantile", "p", "tolerance"), CASES)
def test_95_of_100_runs_keep_the_tolerance(quantile, p, tolerance):
    result = quantile_need(quantile(SHARES), p, tolerance, SIZE, gain=0.01)
    trials, runs = round(result.trials), 2_000
    generator = np.random.default_rng(3)
    below = np.floor(p * (trials - 1)) + 1  # the percentile of uniforms is a beta variable
    shares = generator.beta(below, trials - below + 1, size=runs)
    kept = np.mean(np.abs(quantile(shares) - quantile(np.array([p]))) <= tolerance)
    assert abs(kept - 0.95) < 4 * np.sqrt(0.95 * 0.05 / runs) + 0.02


def test_the_density_decides_where_it_is_constant():
    """c = sqrt(p (1 - p)) / f, n = (1.96 c / tolerance)^2."""
    result = quantile_need(ndtri(SHARES), 0.245, 0.01, SIZE, gain=0.01)
    density = np.exp(-(ndtri(0.245) ** 2) / 2) / np.sqrt(2 * np.pi)
    assert result.trials == pytest.approx((1.959964 / 0.01) ** 2 * 0.245 * 0.755 / density**2, rel=0.03)


def test_a_reference_that_is_too_short_says_nothing():
    assert quantile_need(ndtri(SHARES[::1024]), 0.245, 0.01, 256) is None


def test_a_reference_that_knows_less_says_so():
    sure, unsure = (quantile_need(ndtri(SHARES), 0.245, 0.033, SIZE, gain) for gain in (0.01, 1.0))
    assert sure.trials == unsure.trials
    assert unsure.error == pytest.approx(100 * sure.error)
