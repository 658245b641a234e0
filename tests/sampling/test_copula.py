from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from xlmc.sampling.copula import GaussianCopula, nearest_correlation

N = 200_000


def matrix(k, **pairs):
    found = np.eye(k)
    for pair, value in pairs.items():
        i, j = int(pair[1]), int(pair[2])
        found[i, j] = found[j, i] = value
    return found


def uniforms(k, n=N):
    return np.random.default_rng(20010311).random((k, n))


TARGETS = {
    "strong": matrix(2, r01=0.9),
    "negative": matrix(2, r01=-0.6),
    "none": matrix(2),
    "three": matrix(3, r01=0.5, r02=-0.3, r12=0.2),
    "four": matrix(4, r01=0.7, r12=0.7, r23=0.7, r02=0.5, r13=0.5, r03=0.3),
}


@pytest.mark.parametrize("name", TARGETS)
def test_spearman_correlations_are_those_asked_for(name):
    target = TARGETS[name]
    u = uniforms(len(target))
    GaussianCopula(target).join(u)
    seen = np.atleast_2d(np.corrcoef(stats.rankdata(u, axis=1)))
    error = (1 - target**2) * np.sqrt((1 + target**2 / 2) / (N - 3))  # Bonett and Wright 2000, back from Fisher's z
    assert np.all(np.abs(seen - target) <= 4 * error + 1e-12)


@pytest.mark.parametrize("name", TARGETS)
def test_margins_stay_uniform_and_the_first_keeps_its_draws(name):
    target = TARGETS[name]
    u = uniforms(len(target))
    first = u[0].copy()
    GaussianCopula(target).join(u)
    assert np.array_equal(u[0], first)
    for row in u:
        assert ((row >= 0) & (row < 1)).all()
        assert stats.kstest(row, "uniform").statistic < 1.95 / np.sqrt(N)


def test_a_trial_depends_on_its_own_uniforms_alone():
    copula, u = GaussianCopula(TARGETS["three"]), uniforms(3, 1000)
    whole, part = u.copy(), u[:, 400:700].copy()
    copula.join(whole)
    copula.join(part)
    assert np.array_equal(part, whole[:, 400:700])


def test_the_ends_of_the_grid():
    u = np.array([[0.0, 1 - 2.0**-53, 0.0], [0.0, 1 - 2.0**-53, 1 - 2.0**-53]])
    GaussianCopula(TARGETS["strong"]).join(u)
    assert ((u >= 0) & (u < 1)).all()


@pytest.mark.parametrize("value", [1.0, -1.0])
def test_full_correlation_of_two(value):
    u = uniforms(2, 1000)
    GaussianCopula(matrix(2, r01=value)).join(u)
    assert np.allclose(u[1], u[0] if value > 0 else 1 - u[0], atol=1e-6)


CONTRADICTIONS = [
    matrix(3, r01=0.9, r12=0.9, r02=-0.9),
    matrix(3, r01=0.9, r02=0.9),
    matrix(3, r01=1.0, r02=-1.0, r12=1.0),
    matrix(5, r01=0.95, r12=0.95, r23=0.95, r34=0.95),
]


@pytest.mark.parametrize("target", CONTRADICTIONS)
def test_contradictions_give_way_to_the_nearest_correlations(target):
    copula = GaussianCopula(target)
    assert copula.repaired
    pearson = 2 * np.sin(np.pi / 6 * target)
    np.fill_diagonal(pearson, 1.0)
    expected = 6 / np.pi * np.arcsin(nearest_correlation(pearson) / 2)
    assert copula.spearman == pytest.approx(expected, abs=1e-6)
    u = uniforms(len(target))
    copula.join(u)
    seen = np.corrcoef(stats.rankdata(u, axis=1))
    error = (1 - expected**2) * np.sqrt((1 + expected**2 / 2) / (N - 3))
    assert np.all(np.abs(seen - expected) <= 4 * error + 1e-6)
    for row in u:
        assert stats.kstest(row, "uniform").statistic < 1.95 / np.sqrt(N)


@pytest.mark.parametrize("name", TARGETS)
def test_what_is_possible_is_not_changed(name):
    copula = GaussianCopula(TARGETS[name])
    assert not copula.repaired
    assert copula.spearman == pytest.approx(TARGETS[name], abs=1e-12)


NEARLY_ONE = [1 - 1e-6, 1 - 1e-12, -1 + 1e-6, -1 + 1e-12]


@pytest.mark.parametrize("value", [1.0, -1.0, *NEARLY_ONE])
def test_three_that_are_one(value):
    """One quantity under three names: singular, or nearly so, and still no contradiction."""
    target = matrix(3, r01=value, r02=value, r12=abs(value))
    copula, u = GaussianCopula(target), uniforms(3, 10_000)
    assert not copula.repaired
    assert copula.spearman == pytest.approx(target, abs=1e-8)
    copula.join(u)
    assert ((u >= 0) & (u < 1)).all()
    for other in u[1:]:
        assert np.abs(other - (u[0] if value > 0 else 1 - u[0])).max() < 5e-3


@given(st.integers(2, 7), st.integers(0, 10_000))
def test_any_matrix_gives_correlations_that_are_possible(k, seed):
    rng = np.random.default_rng(seed)
    target = np.clip(rng.uniform(-1.3, 1.3, (k, k)), -1, 1)
    target = np.triu(target, 1) + np.triu(target, 1).T + np.eye(k)
    found = GaussianCopula(target).spearman
    assert np.diagonal(found) == pytest.approx(np.ones(k), abs=1e-9)
    assert np.abs(found).max() <= 1 + 1e-12
    assert np.linalg.eigvalsh(2 * np.sin(np.pi / 6 * found))[0] > -1e-7
    assert GaussianCopula(found).spearman == pytest.approx(found, abs=1e-6)


@pytest.mark.parametrize("name", TARGETS)
def test_a_uniform_of_0_is_joined_as_half_of_the_least_step(name):
    k = len(TARGETS[name])
    zero, least = uniforms(k, k + 1), uniforms(k, k + 1)
    zero[:, 0], least[:, 0] = 0.0, 2.0**-54
    zero[np.arange(k), np.arange(1, k + 1)], least[np.arange(k), np.arange(1, k + 1)] = 0.0, 2.0**-54
    for u in (zero, least):
        GaussianCopula(TARGETS[name]).join(u)
    assert zero[1:].tolist() == least[1:].tolist()
    assert ((zero[1:] > 0.0) & (zero[1:] < 1.0)).all()
