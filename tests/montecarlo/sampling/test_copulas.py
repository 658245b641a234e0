"""Copulas: margins, Kendall's tau against its formulas, dependence in the tails against C(q, q) itself."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats
from scipy.integrate import quad

from xlmc.montecarlo.distributions.empirical import Empirical
from xlmc.montecarlo.sampling.copulas import Clayton, Frank, Gumbel, Reflected, SameTrials, StudentTCopula

N = 20_000
FEW = 1_500


def debye(theta):
    return quad(lambda x: x / np.expm1(x), 0, theta)[0] / theta


def t_matrix(size, r):
    return np.full((size, size), r) + (1 - r) * np.eye(size)


CASES = {
    "Clayton": (lambda k: Clayton(k, 2.0), 0.5),
    "Clayton weak": (lambda k: Clayton(k, 0.2), 0.2 / 2.2),
    "Clayton strong": (lambda k: Clayton(k, 30.0), 30 / 32),
    "Gumbel": (lambda k: Gumbel(k, 2.0), 0.5),
    "Gumbel independent": (lambda k: Gumbel(k, 1.0), 0.0),
    "Gumbel strong": (lambda k: Gumbel(k, 20.0), 0.95),
    "Frank": (lambda k: Frank(k, 5.0), 1 - 4 / 5 * (1 - debye(5))),
    "Frank strong": (lambda k: Frank(k, 40.0), 1 - 4 / 40 * (1 - debye(40))),
    "t": (lambda k: StudentTCopula(t_matrix(k, 0.5), 3.0), 1 / 3),
    "t of few degrees": (lambda k: StudentTCopula(t_matrix(k, 0.7), 0.8), 2 / np.pi * np.arcsin(0.7)),
}


def joined(copula, size, seed=20010311, n=N):
    u = np.random.default_rng(seed).integers(2**53, size=(size, n)) * 2.0**-53
    copula.join(u)
    return u


@pytest.mark.parametrize("name", CASES)
def test_margins_and_kendalls_tau(name):
    """Of all pairs of two and of three; tau has a standard error of at most 2·√((1 − τ²)/n)."""
    made, tau = CASES[name]
    for size in (2, 3):
        u = joined(made(size), size, n=N // 2)
        for row in u:
            assert stats.kstest(row, "uniform").pvalue > 1e-3
            assert 0 < row.min() <= row.max() < 1
        for i in range(1, size):
            result = stats.kendalltau(u[i - 1, :FEW], u[i, :FEW]).statistic
            assert abs(result - tau) < 4 * 2 * np.sqrt((1 - tau**2) / FEW)
        rho = stats.spearmanr(u[0], u[1]).statistic
        assert abs(made(size).spearman[0, 1] - rho) < 4 / np.sqrt(u.shape[1]) + 2e-3


@pytest.mark.parametrize("name", ["Clayton", "Clayton strong", "Gumbel", "Gumbel strong", "Frank"])
@pytest.mark.parametrize("q", [0.01, 0.1, 0.5, 0.9, 0.99])
def test_both_below(name, q):
    """The share of trials with both, or all three, at most q is ψ(2φ(q)), or ψ(3φ(q)): the tails among them."""
    for size in (2, 3):
        copula = CASES[name][0](size)
        exact = float(copula.generator(size * copula.inverse(np.array(q))))
        share = np.mean((joined(copula, size) <= q).all(axis=0))
        assert abs(share - exact) < 4 * np.sqrt(exact * (1 - exact) / N)


def test_tail_dependence():
    """P(V <= q | U <= q) for small q, and 1 - q for the upper tail, near to the limits of the formulas."""
    q = 0.002
    for copula, upper, limit in (
        (Clayton(2, 2.0), False, 2**-0.5),
        (Gumbel(2, 2.0), True, 2 - 2**0.5),
        (Reflected(Clayton(2, 2.0), (True, True)), True, 2**-0.5),
        (Reflected(Gumbel(2, 2.0), (True, True)), False, 2 - 2**0.5),
    ):
        u = joined(copula, 2, n=200_000)
        both = np.mean((u > 1 - q).all(axis=0) if upper else (u <= q).all(axis=0)) / q
        assert abs(both - limit) < 4 * np.sqrt(limit * (1 - limit) / (200_000 * q)) + 0.005
    degrees, r = 3.0, 0.5
    limit = 2 * stats.t.cdf(-np.sqrt((degrees + 1) * (1 - r) / (1 + r)), degrees + 1)
    u = joined(StudentTCopula(t_matrix(2, r), degrees), 2)
    for both in (np.mean((u <= q).all(axis=0)) / q, np.mean((u > 1 - q).all(axis=0)) / q):
        assert abs(both - limit) < 4 * np.sqrt(limit * (1 - limit) / (N * q)) + 0.01


def test_t_against_draws_of_the_multivariate_t():
    """The share of trials in each of 25 cells of a grid, against SciPy's sampler; each within 4 standard errors."""
    matrix = np.array([[1.0, 0.6], [0.6, 1.0]])
    other = stats.t.cdf(stats.multivariate_t(shape=matrix, df=4.5).rvs(N, random_state=1), 4.5).T
    own = joined(StudentTCopula(matrix, 4.5), 2)
    bins = np.linspace(0, 1, 6)
    a, b = (np.histogram2d(*each, bins=(bins, bins))[0] for each in (own, other))
    assert (np.abs(a - b) < 4 * np.sqrt(a + b)).all()


def test_reflections():
    """RX turns the first over, RY the second; tau changes its sign, and the margins stay uniform."""
    for turned, sign in (((True, True), 1), ((True, False), -1), ((False, True), -1)):
        copula = Reflected(Clayton(2, 2.0), turned)
        u = joined(copula, 2)
        assert abs(stats.kendalltau(u[0, :FEW], u[1, :FEW]).statistic - sign * 0.5) < 8 * np.sqrt(0.75 / FEW)
        assert copula.spearman[0, 1] == pytest.approx(sign * Clayton(2, 2.0).spearman[0, 1])
        back = u.copy()
        back[np.array(turned)] = 1 - back[np.array(turned)]
        assert abs(np.mean((back <= 0.05).all(axis=0)) - (2 * 0.05**-2 - 1) ** -0.5) < 4 * np.sqrt(0.04 / N)


def test_frank_of_a_negative_theta():
    u = joined(Frank(2, -5.0), 2)
    assert abs(stats.kendalltau(u[0, :FEW], u[1, :FEW]).statistic + CASES["Frank"][1]) < 8 * np.sqrt(0.8 / FEW)


def test_a_matrix_that_contradicts_itself_is_repaired():
    matrix = np.array([[1.0, 0.9, -0.9], [0.9, 1.0, 0.9], [-0.9, 0.9, 1.0]])
    copula = StudentTCopula(matrix, 4.0)
    assert copula.repaired
    assert np.linalg.eigvalsh(copula.matrix)[0] > -1e-9


def test_a_trial_depends_on_its_own_uniforms_alone():
    for made, _ in CASES.values():
        whole = joined(made(3), 3, n=1000)
        u = np.random.default_rng(20010311).integers(2**53, size=(3, 1000)) * 2.0**-53
        part = np.ascontiguousarray(u[:, 300:400])
        made(3).join(part)
        np.testing.assert_array_equal(part, whole[:, 300:400])


def test_values_that_stand_together_are_drawn_together():
    """Quantiles of the empirical distributions at these uniforms are the values of one trial; some are equal."""
    values = np.array([[3.0, 1.0, 2.0, 2.0, 5.0], [7.0, 7.0, 6.0, 9.0, 8.0], [1.0, 2.0, 3.0, 4.0, 5.0]])
    u = np.random.default_rng(1).random((3, 5_000))
    u[0, :2] = 0.0, 1 - 2.0**-53
    first = u[0].copy()
    SameTrials(values).join(u)
    assert np.abs(u[0] - first).max() <= 0.5 / 5
    drawn = np.stack([Empirical().built(row[:, None]).ppf(at) for row, at in zip(values, u, strict=True)])
    result, counts = np.unique(drawn, axis=1, return_counts=True)
    assert sorted(map(tuple, result.T.tolist())) == sorted(map(tuple, values.T.tolist()))
    assert counts == pytest.approx(1_000, abs=5 * (5_000 * 0.2 * 0.8) ** 0.5)
    assert SameTrials(values[[0, 0]]).pair(0, 1) == pytest.approx(1.0)


@pytest.mark.parametrize("name", CASES)
def test_the_ends_of_the_uniforms_stay_inside(name):
    """A 0, and the last number below 1, give joined uniforms that every quantile function can take."""
    ends = np.array([0.0, 1 - 2.0**-53])
    u = np.array([each.ravel() for each in np.meshgrid(ends, ends)])
    CASES[name][0](2).join(u)
    assert (u >= 0).all()
    assert (u < 1).all()


def test_a_reflected_0_is_below_1():
    u = np.zeros((2, 1))
    Reflected(Clayton(2, 2.0), (True, True)).join(u)
    assert (u < 1).all()
