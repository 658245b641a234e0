from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import ndtri

from xlmc.montecarlo.rare.splitting import descend

START = -ndtri(1e-5)


def half_space(z):
    return np.maximum(0.0, START - z.sum(axis=1) / math.sqrt(z.shape[1]))


def test_the_population_arrives_and_knows_the_probability(random):
    result = descend(half_space, 5, random)
    assert result.reached
    assert np.all(half_space(result.points) == 0.0)
    assert abs(result.log_probability - math.log(1e-5)) < 0.6  # one population's error is about 0.15
    along = result.points.sum(axis=1) / math.sqrt(5)
    assert along.mean() == pytest.approx(START + 1 / START, abs=0.05)
    assert list(result.levels) == sorted(result.levels, reverse=True)
    assert result.levels[-1] == 0.0


def test_both_of_two_tails_are_found(random):
    result = descend(lambda z: np.maximum(0.0, START - np.abs(z[:, 0])), 3, random)
    assert 0.25 < np.mean(result.points[:, 0] > 0) < 0.75


def test_a_filter_that_only_says_no_is_found_where_chance_finds_it(random):
    result = descend(lambda z: np.where(z[:, 0] > 3.0, 0.0, 1.0), 2, random)  # 1.3 in 1,000: 88 of the first draws
    assert result.reached
    assert result.levels == (0.0,)


@pytest.mark.parametrize("distance", [lambda z: np.ones(len(z)), lambda z: np.full(len(z), np.inf)])
def test_what_is_never_accepted_ends_the_search(random, distance):
    result = descend(distance, 2, random, population=256, first=1024)
    assert not result.reached
    assert result.evaluations < 20_000


def test_a_region_that_does_not_exist_is_given_up(random):
    result = descend(lambda z: 1.0 + np.square(z).sum(axis=1), 2, random, population=256, first=1024)
    assert not result.reached
    assert np.square(result.nearest).sum() < 1e-3


def test_counts_what_it_asked_for(random):
    asked = []

    def distance(z):
        asked.append(len(z))
        return half_space(z)

    assert descend(distance, 2, random, population=512, first=2048).evaluations == sum(asked)
