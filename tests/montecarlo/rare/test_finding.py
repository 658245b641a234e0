"""The whole way on problems with known answers: a small edition of benchmarks/rare_acceptance.py."""

from __future__ import annotations

import importlib
import math
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.special import bdtr

from xlmc.montecarlo.rare import learning
from xlmc.montecarlo.rare.mixture import Mixture
from xlmc.montecarlo.rare.proposal import Proposal, Shear
from xlmc.montecarlo.rare.resampling import resample
from xlmc.montecarlo.rare.search import find

BENCHMARKS = Path(__file__).resolve().parents[3] / "benchmarks"


@pytest.fixture(scope="module")
def bench():
    sys.path.insert(0, str(BENCHMARKS))
    yield importlib.import_module("rare_acceptance")
    sys.path.remove(str(BENCHMARKS))


def test_intervals_hold_the_truth(bench):
    """6 intervals: fewer hits than 95 % coverage has once in 1,000 times, were all independent, fail."""
    problem = importlib.import_module("rare_problems").corner(1e-7, narrowed=3, count=5)
    result = bench.one_run(problem.distance, problem.dimensions, 5000, 1000)
    points = result.resampled.points
    assert np.all(problem.distance(points) == 0.0)
    assert 0.97 * 1000 <= result.resampled.size <= 1000
    hits = sum(bench.covered(bench.estimates(result, problem.forecast(points)), problem.truth))
    assert bdtr(hits, 6, 0.95) > 1e-3
    assert problem.truth[0] <= 1e-6
    assert result.evaluations < 1000 / problem.truth[0] / 50


def shifted(mean):
    mixture = Mixture(np.ones(1), np.array([[mean]]), np.array([[[0.5]]]))
    return Proposal(np.eye(1), Shear(np.zeros(0), np.zeros((0, 1)), np.zeros((0, 1, 1))), mixture, mixture)


def test_a_trial_heavier_than_any_known_is_learnt_from(random):
    """The proposal lies at 4, most of the region at 2 to 3: its first trials there weigh far more than was known."""
    result = resample(lambda z: z[:, 0] > 2.0, shifted(4.0), -9.0, -math.inf, 10_000, 10**6, random)
    assert result.surprise is not None
    assert result.surprise.points.min() < 3.0
    again = resample(lambda z: z[:, 0] > 2.0, shifted(2.5), -2.0, -math.inf, 500, 10**6, random)
    assert again.surprise is None
    assert len(again.points) == 500
    low, high = again.acceptance.interval
    assert low < math.erfc(2 / math.sqrt(2)) / 2 * 1.02
    assert high > math.erfc(2 / math.sqrt(2)) / 2 * 0.98


def test_too_many_for_the_limit_are_not_begun():
    def distance(z):
        return np.maximum(0.0, 3.0 - z[:, 0])

    random = np.random.default_rng(3)
    result = find(distance, lambda z: distance(z) == 0.0, 1, 10**9, 10**7, random, random)
    assert result.resampled is None
    assert result.learned.best is not None


def wavy(half):
    """A layer of that half thickness that no quadratic function follows, in 4 dimensions."""

    def distance(z):
        return np.maximum(0.0, np.abs(z[:, 0] - np.sin(3.0 * z[:, 1])) - half)

    return distance


def test_a_layer_of_which_few_proposals_are_part_is_described_all_the_same():
    """Its probability is 2h·E[φ(sin 3Z)], by 40-point quadrature; 4.5 standard errors are allowed for."""
    half = 0.006
    nodes, weights = np.polynomial.hermite_e.hermegauss(40)
    truth = 2 * half * weights @ np.exp(-0.5 * np.sin(3.0 * nodes) ** 2) / (2 * np.pi)
    distance = wavy(half)
    random = [np.random.default_rng((11, each)) for each in (0, 1)]
    result = find(distance, lambda z: distance(z) == 0.0, 4, 100, 10**8, *random)
    assert result.used.trials > learning._TRIALS
    assert np.all(distance(result.resampled.points) == 0.0)
    acceptance = result.resampled.acceptance
    assert abs(acceptance.value - truth) < 4.5 * acceptance.error
    assert result.resampled.fresh <= result.resampled.proposals // 2


def test_learning_keeps_to_the_limit():
    """Long rounds would take far more: what is left of the limit is one round at most."""
    distance = wavy(1e-6)
    random = [np.random.default_rng((12, each)) for each in (0, 1)]
    message = []
    result = find(distance, lambda z: distance(z) == 0.0, 4, 100, 1_000_000, *random, message.append)
    assert result.evaluations <= 1_000_000 + 32_768
    assert message == sorted(message)


def test_acceptance_is_more_than_nothing_where_few_trials_are_wanted():
    """Some 1.3 of 32,768 are accepted: as many draws again may have none, so there are more, a million at most."""
    for seed in range(2):
        random = np.random.default_rng((13, seed))
        result = resample(
            lambda z: (z[:, 0] > 2.5) & (z[:, 0] < 2.5 + 6.4e-5), shifted(2.5), -2.7, -math.inf, 2, 10**8, random
        )
        assert len(result.points) == 2
        assert result.proposals - result.fresh < result.fresh <= 1 << 20
        assert result.acceptance.value > 0.0
        assert result.acceptance.interval is not None
