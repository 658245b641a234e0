"""Rank correlations of draws that take few values, against formulas and against many draws."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from xlmc.distributions import family_named
from xlmc.sampling.copula import GaussianCopula, Ties, bounds, parameter, spearman
from xlmc.sampling.draws import Draw

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


@pytest.mark.parametrize(("first", "second"), PAIRS)
@pytest.mark.parametrize("wanted", [0.3, -0.1])
def test_draws_have_it(first, second, wanted):
    n = 100_000
    u = np.random.default_rng(1904).random((2, n))
    copula = GaussianCopula(np.array([[1.0, wanted], [wanted, 1.0]]), [first, second])
    assert not copula.repaired
    assert copula.spearman[0, 1] == pytest.approx(wanted, abs=1e-9)
    copula.join(u)
    found = stats.spearmanr(values(first, u[0]), values(second, u[1])).statistic
    assert abs(found - wanted) < 4 * 1.2 / math.sqrt(n)


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
    u = np.random.default_rng(7).random((3, 100_000))
    copula.join(u)
    found = stats.spearmanr(np.array([values(TENTH, u[0]), u[1], u[2]]).T).statistic
    assert found == pytest.approx(copula.spearman, abs=4 * 1.2 / math.sqrt(100_000))


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
