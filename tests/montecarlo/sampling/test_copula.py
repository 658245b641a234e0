from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import optimize, stats

from xlmc.montecarlo.distributions import family_named
from xlmc.montecarlo.sampling.copula import (
    GaussianCopula,
    Ties,
    bounds,
    nearest_by_weights,
    nearest_correlation,
    parameter,
    spearman,
)
from xlmc.montecarlo.sampling.draws import Draw

N = 50_000


def matrix(k, **pairs):
    result = np.eye(k)
    for pair, value in pairs.items():
        i, j = int(pair[1]), int(pair[2])
        result[i, j] = result[j, i] = value
    return result


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
        assert stats.kstest(row, "uniform", method="asymp").statistic < 1.95 / np.sqrt(N)


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
        assert stats.kstest(row, "uniform", method="asymp").statistic < 1.95 / np.sqrt(N)


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
    result = GaussianCopula(target).spearman
    assert np.diagonal(result) == pytest.approx(np.ones(k), abs=1e-9)
    assert np.abs(result).max() <= 1 + 1e-12
    assert np.linalg.eigvalsh(2 * np.sin(np.pi / 6 * result))[0] > -1e-7
    assert GaussianCopula(result).spearman == pytest.approx(result, abs=1e-6)


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


def symmetric(k, seed):
    values = np.random.default_rng(seed).uniform(-1, 1, (k, k))
    return np.triu(values, 1) + np.triu(values, 1).T + np.eye(k)


def test_the_published_examples():
    """Higham 2002, section 4."""
    result = nearest_correlation(np.array([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]]))
    assert result[[0, 0, 1], [1, 2, 2]] == pytest.approx([0.7607, 0.1573, 0.7607], abs=5e-5)
    band = 2 * np.eye(4) - np.eye(4, k=1) - np.eye(4, k=-1)
    result = nearest_correlation(band)
    assert result[0, 1:] == pytest.approx([-0.8084, 0.1916, 0.1068], abs=5e-5)
    assert result[1, 2] == pytest.approx(-0.6562, abs=5e-5)


@given(st.integers(2, 8), st.integers(0, 10_000))
def test_it_is_a_correlation_matrix_and_no_other_is_nearer(k, seed):
    """Nearest on a convex set: from it, the way to any other correlation matrix leads away from the one asked for."""
    asked = symmetric(k, seed)
    result = nearest_correlation(asked)
    assert np.array_equal(result, result.T) or np.allclose(result, result.T, atol=1e-12)
    assert np.array_equal(np.diagonal(result), np.ones(k))
    assert np.linalg.eigvalsh(result)[0] > -1e-7
    rng = np.random.default_rng(seed)
    for _ in range(5):
        rows = rng.normal(size=(k, rng.integers(1, k + 1)))
        rows /= np.linalg.norm(rows, axis=1, keepdims=True)
        assert np.sum((asked - result) * (rows @ rows.T - result)) < 1e-5


@given(st.integers(2, 8), st.integers(0, 10_000))
def test_a_correlation_matrix_is_its_own(k, seed):
    rows = np.random.default_rng(seed).normal(size=(k, k + 2))
    rows /= np.linalg.norm(rows, axis=1, keepdims=True)
    given_matrix = rows @ rows.T
    np.fill_diagonal(given_matrix, 1.0)
    assert nearest_correlation(given_matrix) == pytest.approx(given_matrix, abs=1e-9)


HALF, TENTH = Ties(np.array([0.5])), Ties(np.array([0.9]))
DIE = Ties(np.arange(1, 6) / 6)
SKEWED = Ties(np.cumsum([0.5, 0.3, 0.1, 0.07]))
PAIRS = [(None, TENTH), (HALF, None), (HALF, TENTH), (TENTH, TENTH), (DIE, None), (DIE, SKEWED), (SKEWED, HALF)]


def values(ties, u):
    return u if ties is None else np.searchsorted(ties.cuts, u, side="right").astype(float)


def test_bounds_are_those_of_formulas():
    assert bounds(None, TENTH)[1] == pytest.approx(math.sqrt(3 * 0.1 * 0.9))
    assert bounds(TENTH, None)[0] == pytest.approx(-math.sqrt(3 * 0.1 * 0.9))
    both = 0.1 * 0.5 / math.sqrt(0.25 * 0.09)  # phi of two 0-1 variables: (min(p, q) - pq) / sqrt(pq(1-p)(1-q))
    assert bounds(HALF, TENTH) == pytest.approx((-both, both))
    assert bounds(TENTH, TENTH) == pytest.approx(((-0.1 * 0.1) / 0.09, 1.0))
    assert bounds(DIE, DIE) == pytest.approx((-1.0, 1.0))


@pytest.mark.parametrize(("first", "second"), PAIRS)
def test_the_parameter_gives_what_was_wanted(first, second):
    least, most = bounds(first, second)
    for share in (-0.9, -0.3, 0.2, 0.95):
        wanted = share * (most if share > 0 else -least)
        assert spearman(first, second, parameter(first, second, wanted)) == pytest.approx(wanted, abs=1e-9)
    assert parameter(first, second, 1.0) == 1.0
    assert parameter(first, second, least - 0.01) == -1.0


@pytest.mark.parametrize(("first", "second"), PAIRS)
def test_continuous_up_to_the_bounds(first, second):
    """The integral comes to Frechet's bounds as the parameter comes to 1."""
    assert spearman(first, second, 1 - 1e-9) == pytest.approx(bounds(first, second)[1], abs=2e-4)
    assert spearman(first, second, -1 + 1e-9) == pytest.approx(bounds(first, second)[0], abs=2e-4)
    assert (spearman(first, second, -1.0), spearman(first, second, 1.0)) == pytest.approx(bounds(first, second))


@pytest.mark.parametrize(("first", "second"), PAIRS)
@pytest.mark.parametrize("wanted", [0.3, -0.1])
def test_draws_have_it(first, second, wanted):
    n = 25_000
    u = np.random.default_rng(1904).random((2, n))
    copula = GaussianCopula(np.array([[1.0, wanted], [wanted, 1.0]]), [first, second])
    assert not copula.repaired
    assert copula.spearman[0, 1] == pytest.approx(wanted, abs=1e-9)
    copula.join(u)
    result = stats.spearmanr(values(first, u[0]), values(second, u[1])).statistic
    assert abs(result - wanted) < 4 * 1.2 / math.sqrt(n)


def test_wanted_is_brought_to_what_can_be():
    copula = GaussianCopula(np.array([[1.0, 0.9], [0.9, 1.0]]), [None, TENTH])
    assert copula.wanted[0, 1] == pytest.approx(0.5196, abs=1e-4)
    assert copula.spearman[0, 1] == pytest.approx(0.5196, abs=1e-4)
    assert not copula.repaired


def test_solved_parameters_that_contradict_each_other_are_repaired():
    target = np.array([[1.0, 0.45, 0.45], [0.45, 1.0, -0.45], [0.45, -0.45, 1.0]])
    assert not GaussianCopula(target).repaired
    copula = GaussianCopula(target, [TENTH, None, None])
    assert copula.repaired
    assert np.linalg.eigvalsh(copula.spearman)[0] > -1e-9
    u = np.random.default_rng(7).random((3, 25_000))
    copula.join(u)
    result = stats.spearmanr(np.array([values(TENTH, u[0]), u[1], u[2]]).T).statistic
    assert result == pytest.approx(copula.spearman, abs=4 * 1.2 / math.sqrt(25_000))


@pytest.mark.parametrize(
    ("name", "parameters", "cuts"),
    [
        ("Yes-No", (0.1,), [0.9]),
        ("Binomial", (0.5, 2.0), [0.25, 0.75]),
        ("Discrete Uniform", (1.0, 4.0), [0.25, 0.5, 0.75]),
        ("Yes-No", (0.0001,), [0.9999]),
        ("Yes-No", (1 - 1e-9,), [1e-9]),
    ],
)
def test_the_values_of_a_draw(name, parameters, cuts):
    assert Draw("x", family_named(name), parameters).ties().cuts == pytest.approx(cuts, abs=1e-12)


@pytest.mark.parametrize(
    ("name", "parameters"),
    [("Normal", (1.0, 2.0)), ("Uniform", (0.0, 1.0)), ("Uniform", (2.0, 2.0)), ("Poisson", (1e7,)), ("Yes-No", ("p",))],
)
def test_no_ties_that_matter_or_are_known(name, parameters):
    assert Draw("x", family_named(name), parameters).ties() is None


def test_many_values_are_taken_together():
    ties = Draw("x", family_named("Poisson"), (400.0,)).ties()
    assert ties is None or ties.cuts.size < 600
    assert spearman(Ties(np.arange(1, 100) / 100), None, 0.5) == pytest.approx(6 / math.pi * math.asin(0.25), abs=1e-4)


WEIGHTED = np.array([[1, 0.9, -0.3], [0.9, 1, 0.8], [-0.3, 0.8, 1]])


@pytest.mark.parametrize("weights", [(0, 0, 0), (50, 0, 0), (90, 20, 5), (99, 99, 0)], ids=str)
def test_nearest_by_weights_is_the_least_weighted_change(weights):
    """Beside a search over all correlation matrices of three, by angles: r₂₃ is cos a cos b + sin a sin b cos c."""
    pairs = (0, 1), (0, 2), (1, 2)
    square = np.zeros((3, 3))
    for (i, j), weight in zip(pairs, weights, strict=True):
        square[i, j] = square[j, i] = weight

    def numbers(angles):
        a, b, c = angles
        return np.array([np.cos(a), np.cos(b), np.cos(a) * np.cos(b) + np.sin(a) * np.sin(b) * np.cos(c)])

    def change(angles):
        asked = np.array([WEIGHTED[pair] for pair in pairs])
        return float(((numbers(angles) - asked) ** 2 / (1 - np.array(weights) / 100)).sum())

    best = min(
        (optimize.minimize(change, start, tol=1e-14) for start in ((0.5, 1, 1), (1, 2, 0.1))), key=lambda r: r.fun
    )
    result, met = nearest_by_weights(WEIGHTED, square)
    assert met
    assert [result[pair] for pair in pairs] == pytest.approx(numbers(best.x), abs=1e-4)
    if not any(weights):
        assert result == pytest.approx(nearest_correlation(WEIGHTED), abs=1e-8)


def test_numbers_that_must_all_stay_and_cannot_give_way_alike():
    target = np.array([[1, 0.9, 0.9], [0.9, 1, -0.9], [0.9, -0.9, 1]])
    every = np.full((3, 3), 100.0)
    assert not nearest_by_weights(target, every)[1]
    assert GaussianCopula(target, weights=every).spearman == pytest.approx(GaussianCopula(target).spearman, abs=1e-6)
