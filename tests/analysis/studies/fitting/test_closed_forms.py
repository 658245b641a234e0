"""Errors against the exact laws of the extremes and of the estimates; the values that a family cannot take."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.analysis.studies.fitting import Unfit
from xlmc.analysis.studies.fitting.closed_forms import CLOSED_FORMS

FORMS = {each.name: each for each in CLOSED_FORMS}


@pytest.mark.parametrize("n", [2, 5, 40])
def test_the_errors_of_the_ends_are_those_of_the_extremes_of_uniform_numbers(n):
    """The largest of n is a Beta(n, 1), see David and Nagaraja 2003, §2.1."""
    x = np.linspace(3, 7, n)
    error = 4 * stats.beta(n, 1).std()
    assert FORMS["Uniform"].errors(x, (3.0, 7.0)) == pytest.approx((error, error), rel=1e-12)


@pytest.mark.parametrize(("n", "shape"), [(4, 2.5), (10, 0.4), (3, 1.0), (2, 1.1)])
def test_the_error_of_the_least_value_of_a_pareto(n, shape):
    """The least of n is a Pareto number too, with n times the shape."""
    error, _ = FORMS["Pareto"].errors(np.ones(n), (5.0, shape))
    assert error == pytest.approx(stats.pareto(n * shape, scale=5).std(), rel=1e-9)


@pytest.mark.parametrize("n", [4, 5, 30])
def test_the_error_of_the_shape_of_a_pareto(n):
    """The sum of logarithms is a gamma number with n - 1 degrees: the estimate is n times the shape over it."""
    _, error = FORMS["Pareto"].errors(np.ones(n), (5.0, 1.5))
    assert error == pytest.approx(stats.invgamma(n - 1, scale=n * 1.5).std(), rel=1e-9)


def test_few_values_of_a_pareto_have_no_finite_error():
    assert FORMS["Pareto"].errors(np.ones(2), (5.0, 1.0)) == (None, None)
    assert FORMS["Pareto"].errors(np.ones(3), (5.0, 0.5)) == (None, None)


@pytest.mark.parametrize(("name", "least"), [("Lognormal", 1e-3), ("Pareto", 1e-3), ("Exponential", 0.0)])
def test_values_that_a_family_can_take(name, least):
    assert np.isfinite(FORMS[name].estimate(np.array([least, 0.5, 2.0]))).all()


@pytest.mark.parametrize(
    ("name", "least", "reason"),
    [("Lognormal", 0.0, "above 0"), ("Pareto", 0.0, "above 0"), ("Exponential", -1e-9, "from 0")],
)
def test_values_that_it_cannot_take(name, least, reason):
    with pytest.raises(Unfit, match=reason):
        FORMS[name].estimate(np.array([least, 0.5, 2.0]))


VALUES = np.array([1.0, 2.0, 4.0, 8.0])
ESTIMATES = {
    "Normal": (3.75, np.sqrt((2.75**2 + 1.75**2 + 0.25**2 + 4.25**2) / 4)),
    "Uniform": (1, 8),
    "Exponential": (1 / 3.75,),
    "Pareto": (1, 4 / (6 * np.log(2))),  # ln 2, ln 4 and ln 8 add up to 6 ln 2
    # logarithms 0, 1, 2, 3 times ln 2: mean 1.5 ln 2, variance 1.25 (ln 2)²
    "Lognormal": (
        0,
        float(stats.lognorm(np.sqrt(1.25) * np.log(2), scale=2**1.5).mean()),
        float(stats.lognorm(np.sqrt(1.25) * np.log(2), scale=2**1.5).std()),
    ),
}


@pytest.mark.parametrize("name", ESTIMATES)
def test_estimates_by_hand(name):
    assert FORMS[name].estimate(VALUES) == pytest.approx(ESTIMATES[name], rel=1e-12)


def test_a_pareto_that_begins_elsewhere():
    assert FORMS["Pareto"].estimate(3 * VALUES) == pytest.approx((3, ESTIMATES["Pareto"][1]), rel=1e-12)


SAME = {
    "Normal": ((5, 2), stats.norm(5, 2)),
    "Uniform": ((2, 6), stats.uniform(2, 4)),
    "Lognormal": ((1, 2, 1), stats.lognorm(np.sqrt(np.log(1.25)), loc=1, scale=2 / np.sqrt(1.25))),
    "Exponential": ((0.5,), stats.expon(scale=2)),
    "Pareto": ((2, 3), stats.pareto(3, scale=2)),
}


@pytest.mark.parametrize("name", SAME)
def test_densities_and_distribution_functions(name):
    params, oracle = SAME[name]
    x = oracle.ppf([0.01, 0.3, 0.5, 0.8, 0.999])
    np.testing.assert_allclose(FORMS[name].log_density(x, *params), oracle.logpdf(x), rtol=1e-11)
    np.testing.assert_allclose(FORMS[name].cdf(x, *params), oracle.cdf(x), rtol=1e-11)


@pytest.mark.parametrize(("name", "x"), [("Uniform", [1.0, 2.0, 6.0, 7.0]), ("Pareto", [1.0, 2.0, 2.0, 3.0])])
def test_at_and_beyond_the_ends(name, x):
    params, oracle = SAME[name]
    np.testing.assert_allclose(FORMS[name].log_density(np.array(x), *params), oracle.logpdf(x), rtol=1e-11)
    np.testing.assert_allclose(FORMS[name].cdf(np.array(x), *params), oracle.cdf(x), rtol=1e-11)


def test_which_parameters_are_estimated():
    assert {name: form.free for name, form in FORMS.items()} == {
        "Normal": 2, "Uniform": 2, "Lognormal": 2, "Exponential": 1, "Pareto": 2
    }  # fmt: skip
