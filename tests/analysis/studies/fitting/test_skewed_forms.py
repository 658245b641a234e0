"""Densities against SciPy's, and estimates where SciPy's likelihood has no slope."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.analysis.studies.fitting import Unfit
from xlmc.analysis.studies.fitting.skewed_forms import SKEWED_FORMS

FORMS = {each.name: each for each in SKEWED_FORMS}
SAME = {
    "Laplace": lambda mean, std_dev: stats.laplace(mean, std_dev / np.sqrt(2)),
    "Hyperbolic secant": lambda mean, std_dev: stats.hypsecant(mean, 2 * std_dev / np.pi),
    "Inverse Gaussian": lambda location, mean, shape: stats.invgauss((mean - location) / shape, location, shape),
    "Log-logistic": lambda location, scale, shape: stats.fisk(shape, location, scale),
    "Frechet": lambda location, scale, shape: stats.invweibull(shape, location, scale),
    "Fatigue life": lambda location, scale, shape: stats.fatiguelife(shape, location, scale),
    "Pearson5": lambda location, scale, shape: stats.invgamma(shape, location, scale),
}
PARAMS = [(3.0, 2.0), (0.0, 5.0), (1.5, 3.0, 0.7), (1.5, 3.5, 4.0)]
CASES = [(name, p) for name in SAME for p in PARAMS if len(p) == len(FORMS[name].headings)]


@pytest.mark.parametrize(("name", "params"), CASES)
def test_density_and_distribution_function(name, params):
    oracle = SAME[name](*params)
    x = oracle.ppf([0.003, 0.2, 0.5, 0.7, 0.99])
    np.testing.assert_allclose(FORMS[name].log_density(x, *params), oracle.logpdf(x), rtol=1e-9)
    np.testing.assert_allclose(FORMS[name].cdf(x, *params), oracle.cdf(x), rtol=1e-9)


ABOVE_ZERO = [name for name in SAME if len(FORMS[name].headings) == 3]
WIDE, NARROW = np.array([0.02, 0.7, 0.9, 1.0, 1.4, 2.5, 40.0]), np.array([97.0, 98.5, 99.0, 102.0, 105.0])


@pytest.mark.parametrize("x", [WIDE, NARROW], ids=["wide", "narrow"])
@pytest.mark.parametrize("name", [name for name in SAME if name != "Laplace"])
def test_the_likelihood_has_no_slope_at_the_estimate(name, x):
    form = FORMS[name]
    params = form.estimate(x)
    for place, heading in enumerate(form.headings):
        if heading in form.fixed:
            assert params[place] == 0
            continue
        step = 1e-4 * params[place]
        ends = [np.array(params), np.array(params), np.array(params)]
        ends[0][place] -= step
        ends[2][place] += step
        low, top, high = (SAME[name](*each).logpdf(x).sum() for each in ends)
        bend = 2 * top - low - high
        assert bend > 0
        assert abs(high - low) / 2 < 0.02 * bend, heading  # the top is within a fiftieth of the step


def test_laplace_by_hand():
    """The median is 4; the distances 3, 2, 0, 1 and 9 have the mean 3, times √2; σ/√(2n) and σ/√n for n = 5."""
    x = np.array([1.0, 2.0, 4.0, 5.0, 13.0])
    params = FORMS["Laplace"].estimate(x)
    assert params == pytest.approx((4.0, 3 * np.sqrt(2)), rel=1e-14)
    assert FORMS["Laplace"].errors(x, params) == pytest.approx((3 / np.sqrt(5), 3 * np.sqrt(0.4)), rel=1e-14)


def test_inverse_gaussian_by_hand():
    """Of 1, 2 and 6 the mean is 3; 1/shape is the mean of 1/x less 1/3, 5/9 - 3/9."""
    assert FORMS["Inverse Gaussian"].estimate(np.array([1.0, 2.0, 6.0])) == pytest.approx((0, 3, 4.5), rel=1e-14)


@pytest.mark.parametrize("name", ABOVE_ZERO)
def test_values_above_zero_only(name):
    with pytest.raises(Unfit, match="above 0 only"):
        FORMS[name].estimate(np.array([0.0, 1.0, 2.0]))


def test_equal_values_have_no_fatigue_life():
    with pytest.raises(Unfit, match="all values are equal"):
        FORMS["Fatigue life"].estimate(np.full(5, 3.0))


@pytest.mark.parametrize("name", ABOVE_ZERO)
def test_the_location_stays_at_zero(name):
    assert FORMS[name].free == 2
