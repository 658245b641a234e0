from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.rare.mixture import Mixture, fit_mixture, log_sum, standard_log_density


@pytest.fixture
def mixture():
    roots = np.array([[[1.0, 0.0], [0.5, 0.3]], [[0.2, 0.0], [0.0, 2.0]]])
    return Mixture(np.array([0.3, 0.7]), np.array([[0.0, 1.0], [4.0, -2.0]]), roots)


def test_the_density_is_that_of_scipy(mixture, random):
    points = random.normal(size=(50, 2)) * 3
    expected = sum(
        share * stats.multivariate_normal(mean, root @ root.T).pdf(points)
        for share, mean, root in zip(mixture.shares, mixture.means, mixture.roots, strict=True)
    )
    assert np.exp(mixture.log_density(points)) == pytest.approx(expected, rel=1e-12)


def test_the_standard_density_is_that_of_scipy(random):
    points = random.normal(size=(9, 3))
    assert standard_log_density(points) == pytest.approx(stats.norm.logpdf(points).sum(axis=1), rel=1e-13)


def test_draws_have_the_components_moments(mixture, random):
    n = 40_000
    points = mixture.draw(n, random)
    mean = mixture.shares @ mixture.means
    spread = points.std(axis=0)
    assert np.all(np.abs(points.mean(axis=0) - mean) < 4.5 * spread / np.sqrt(n))
    own = points[points[:, 0] > 3]
    assert abs(len(own) / n - 0.7) < 4.5 * np.sqrt(0.21 / n) + 0.3 * stats.norm.sf(3)


def test_sums_of_logarithms_neither_overflow_nor_vanish():
    assert log_sum(np.array([[1000.0, -1000.0], [1000.0, -2000.0]])) == pytest.approx([1000 + np.log(2), -1000])


def test_two_clouds_are_found_with_their_shares(random):
    cloud = random.normal(size=(1000, 2)) * [0.1, 1.0]
    points = cloud + np.where(random.random(1000) < 0.25, 5.0, -5.0)[:, None] * [1.0, 0.0]
    result = fit_mixture(points, np.ones(1000), random)
    right = result.means[:, 0] > 0
    assert result.shares[right].sum() == pytest.approx(0.25, abs=4.5 * np.sqrt(0.25 * 0.75 / 1000))
    assert np.abs(np.abs(result.means[:, 0]) - 5.0).max() < 0.1


def test_a_layer_a_millionth_thin_is_as_good_as_any_other(random):
    points = random.normal(size=(2000, 3))
    points[:, 2] = points[:, 0] + 1e-6 * points[:, 2]
    result = fit_mixture(points, np.ones(2000), random)
    inside = result.draw(2000, random)
    assert np.std(inside[:, 2] - inside[:, 0]) == pytest.approx(1e-6, rel=0.3)


def test_weights_count_as_repetitions(random):
    points = random.normal(size=(3000, 1))
    result = fit_mixture(points, np.exp(points[:, 0] - 0.5), random)
    drawn = result.draw(20_000, random)
    assert drawn.mean() == pytest.approx(1.0, abs=0.15)  # the tilted normal has mean 1; the weights' own error is 0.03
