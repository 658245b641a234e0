"""The families that @RISK has beside Crystal Ball's, against SciPy: quantiles, both tails, moments, draws."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated

CASES = [
    ("BetaSubj", (0.0, 2.0, 3.0, 10.0), stats.beta(1.8, 4.2, 0, 10)),
    ("BetaSubj", (-5.0, 8.0, 6.0, 10.0), stats.beta(121 / 30, 22 / 15, -5, 15)),
    ("Burr12", (1.0, 2.0, 3.0, 1.5), stats.burr12(3.0, 1.5, 1, 2)),
    ("Burr12", (0.0, 1e4, 0.9, 4.0), stats.burr12(0.9, 4.0, 0, 1e4)),
    ("Dagum", (1.0, 2.0, 3.0, 2.0), stats.burr(3.0, 2.0, 1, 2)),
    ("Dagum", (0.0, 1e-3, 5.0, 0.4), stats.burr(5.0, 0.4, 0, 1e-3)),
    ("F", (3.0, 10.0), stats.f(3, 10)),
    ("F", (12.0, 5.5), stats.f(12, 5.5)),
    ("Fatigue life", (1.0, 2.0, 0.5), stats.fatiguelife(0.5, 1, 2)),
    ("Fatigue life", (0.0, 1.0, 3.0), stats.fatiguelife(3.0)),
    ("Frechet", (1.0, 2.0, 3.0), stats.invweibull(3.0, 1, 2)),
    ("Frechet", (-4.0, 1.0, 12.0), stats.invweibull(12.0, -4)),
    ("Hyperbolic secant", (10.0, 2.0), stats.hypsecant(10, 4 / np.pi)),
    ("Inverse Gaussian", (0.0, 3.0, 5.0), stats.invgauss(3 / 5, 0, 5)),
    ("Inverse Gaussian", (1.0, 3.0, 0.5), stats.invgauss(4.0, 1, 0.5)),
    ("Inverse Gaussian", (0.0, 1.0, 400.0), stats.invgauss(1 / 400, 0, 400)),
    ("Johnson SB", (10.0, 20.0, 1.0, 2.0), stats.johnsonsb(1.0, 2.0, 10, 10)),
    ("Johnson SB", (0.0, 1.0, -0.4, 0.3), stats.johnsonsb(-0.4, 0.3)),
    ("Johnson SU", (10.0, 2.0, -1.0, 2.0), stats.johnsonsu(-1.0, 2.0, 10, 2)),
    ("Johnson SU", (0.0, 1.0, 3.0, 1.2), stats.johnsonsu(3.0, 1.2)),
    ("Laplace", (10.0, 2.0), stats.laplace(10, np.sqrt(2))),
    ("Log-logistic", (1.0, 2.0, 3.0), stats.fisk(3.0, 1, 2)),
    ("Pareto2", (0.0, 2.0, 3.0), stats.lomax(3.0, 0, 2)),
    ("Pareto2", (5.0, 0.1, 7.5), stats.lomax(7.5, 5, 0.1)),
    ("Pearson5", (0.0, 2.0, 3.0), stats.invgamma(3.0, 0, 2)),
    ("Pearson5", (1.0, 50.0, 40.0), stats.invgamma(40.0, 1, 50)),
    ("Pearson6", (0.0, 2.0, 3.0, 4.0), stats.betaprime(3.0, 4.0, 0, 2)),
    ("Pearson6", (1.0, 1.0, 0.5, 9.0), stats.betaprime(0.5, 9.0, 1)),
    ("Reciprocal", (1.0, 100.0), stats.loguniform(1, 100)),
    ("Reciprocal", (9.0, 20.0), stats.loguniform(9, 20)),
]
HEAVY = [("Cauchy", (10.0, 2.0), stats.cauchy(10, 2)), ("Levy", (1.0, 2.0), stats.levy(1, 2))]
NAMES = [f"{name} {params}" for name, params, _ in (*CASES, *HEAVY)]


@pytest.mark.parametrize(("name", "params", "oracle"), [*CASES, *HEAVY], ids=list(NAMES))
def test_against_scipy(name, params, oracle, quantiles_agree, moments_agree, draws_fit):
    family = FAMILIES[name]
    if name == "Levy":  # its quartiles say little of values up to 1e12: the far ones are compared as ratios
        u = np.array([1e-6, 0.01, 0.5, 0.99, 1 - 1e-6])
        np.testing.assert_allclose(family.ppf(u, *params), oracle.ppf(u), rtol=1e-9)
        np.testing.assert_allclose(family.isf(u, *params), oracle.isf(u), rtol=1e-9)
        np.testing.assert_allclose(family.sf(oracle.isf(u), *params), u, rtol=1e-9)
    else:
        quantiles_agree(family, params, oracle, rtol=1e-10)  # in heavy tails SciPy rounds 1 - u
    if np.isfinite(oracle.std()):
        # SciPy integrates these, and is wrong in the seventh digit; see the next test.
        moments_agree(family, params, oracle, digits=1e-6 if name == "Johnson SB" else 1e-9)
    draws_fit(family, params, oracle)


def test_moments_that_do_not_exist():
    for name, params, mean, variance in (
        ("Cauchy", (0.0, 1.0), np.nan, np.nan),
        ("Levy", (0.0, 1.0), np.inf, np.inf),
        ("Frechet", (0.0, 1.0, 1.0), np.inf, np.inf),
        ("Pareto2", (0.0, 1.0, 2.0), 1.0, np.inf),
        ("Pearson5", (0.0, 1.0, 2.0), 1.0, np.inf),
        ("Log-logistic", (0.0, 1.0, 0.5), np.inf, np.inf),
        ("Burr12", (0.0, 1.0, 1.0, 1.0), np.inf, np.inf),
        ("F", (3.0, 2.0), np.inf, np.inf),
    ):
        assert np.array_equal(FAMILIES[name].mean(*params), mean, equal_nan=True), name
        assert np.array_equal(FAMILIES[name].variance(*params), variance, equal_nan=True), name


def test_moments_of_johnson_sb():
    """By the trapezoidal rule over the normal scores, with a step so small that it is exact to rounding."""
    z = np.arange(-12, 12, 1e-4)
    weights = stats.norm.pdf(z) * 1e-4
    for first, second in ((1.0, 2.0), (-0.4, 0.3), (0.2, 0.05), (1.0, 0.999), (-3.0, 50.0)):
        x = 1 / (1 + np.exp((first - z) / second))
        mean = weights @ x
        params = (0.0, 1.0, first, second)
        assert FAMILIES["Johnson SB"].mean(*params) == pytest.approx(mean, rel=1e-10)
        assert FAMILIES["Johnson SB"].variance(*params) == pytest.approx(weights @ (x - mean) ** 2, rel=1e-10)


def test_double_triangle_and_kumaraswamy_by_integration():
    """SciPy has neither: the moments from the quantile function, and F of the quantile of u is u."""
    nodes, weights = np.polynomial.legendre.leggauss(200)
    u = (nodes + 1) / 2
    for name, params in (
        ("DoubleTriang", (0.0, 4.0, 10.0, 0.76)),
        ("DoubleTriang", (-3.0, -2.5, 8.0, 0.1)),
        ("Kumaraswamy", (2.0, 5.0, 2.0, 3.0)),
        ("Kumaraswamy", (0.0, 1.0, 0.8, 1.7)),
    ):
        family = FAMILIES[name]
        x = family.ppf(u, *params)
        mean = weights @ x / 2
        assert family.mean(*params) == pytest.approx(mean, rel=2e-5), name
        assert family.variance(*params) == pytest.approx(weights @ (x - mean) ** 2 / 2, rel=2e-4), name
        np.testing.assert_allclose(family.cdf(x, *params), u, rtol=1e-12)
        np.testing.assert_allclose(family.sf(x, *params), 1 - u, rtol=1e-12)
        np.testing.assert_allclose(family.isf(1 - u, *params), x, rtol=1e-12)
    below = FAMILIES["DoubleTriang"].cdf(np.array([0.0, 2.0, 4.0, 7.0, 10.0]), 0, 4, 10, 0.76)
    np.testing.assert_allclose(below, [0, 0.19, 0.76, 0.94, 1], rtol=1e-15)


MOMENTS = [
    (0.0, 3.0),
    (0.5, 5.0),
    (-0.5, 5.0),
    (0.0, 2.2),
    (1.5, 5.0),
    (-1.5, 5.0),
    (0.0, 9.0),
    (2.0, 12.0),
    (3.0, 40.0),
    (0.2, 1.6),
]


@pytest.mark.parametrize(("skewness", "kurtosis"), MOMENTS)
def test_johnson_has_the_moments_asked_for(skewness, kurtosis):
    """By integration over the normal scores of u, by the trapezoidal rule."""
    johnson, params = FAMILIES["Johnson moments"], (10.0, 2.0, skewness, kurtosis)
    assert johnson.fault(*params) is None
    z = np.arange(-8.2, 8.2, 1 / 64)
    weights = stats.norm.pdf(z) / 64
    lower = z <= 0
    x = np.concatenate([johnson.ppf(stats.norm.cdf(z[lower]), *params), johnson.isf(stats.norm.sf(z[~lower]), *params)])
    mean = weights @ x
    central = [weights @ (x - mean) ** k for k in (2, 3, 4)]
    assert mean == pytest.approx(10.0, abs=1e-5)
    assert central[0] == pytest.approx(4.0, rel=1e-5)
    assert central[1] / central[0] ** 1.5 == pytest.approx(skewness, abs=1e-3)
    assert central[2] / central[0] ** 2 == pytest.approx(kurtosis, rel=1e-3)
    middle = lower & (z > -3)
    np.testing.assert_allclose(johnson.cdf(x[middle], *params), stats.norm.cdf(z[middle]), rtol=1e-9)
    assert (johnson.mean(*params), johnson.variance(*params)) == (10.0, 4.0)


def test_johnson_of_the_lognormal_line_is_lognormal():
    """Skewness and kurtosis of the lognormal with σ = 0.3."""
    w = np.exp(0.09)
    skewness, kurtosis = (w + 2) * np.sqrt(w - 1), w**4 + 2 * w**3 + 3 * w**2 - 3
    oracle = stats.lognorm(0.3)
    u = np.array([1e-6, 0.1, 0.5, 0.9, 1 - 1e-6])
    result = FAMILIES["Johnson moments"].ppf(u, oracle.mean(), oracle.std(), skewness, kurtosis)
    np.testing.assert_allclose(result, oracle.ppf(u), rtol=1e-9)
    mirrored = FAMILIES["Johnson moments"].ppf(1 - u, -oracle.mean(), oracle.std(), -skewness, kurtosis)
    np.testing.assert_allclose(mirrored, -oracle.ppf(u), rtol=1e-7)


def test_far_tails_keep_their_digits():
    """Cut off beyond the quantile of 1 - 1e-12, against SciPy's survival function."""
    u = np.array([0.1, 0.5, 0.9])
    for name, params, oracle in CASES:
        family = FAMILIES[name]
        if not np.isinf(oracle.support()[1]):
            continue
        cutoff = float(family.isf(1e-12, *params))
        x = Truncated(family).ppf(u, cutoff, np.inf, *params)
        np.testing.assert_allclose(family.sf(x, *params) / family.sf(cutoff, *params), 1 - u, rtol=1e-9, err_msg=name)


def test_parameters_that_vary_by_trial():
    """Trials with impossible parameters are NaN, the others as with numbers."""
    for name, params, _ in (*CASES, *HEAVY):
        family = FAMILIES[name]
        good = family.ppf(np.array([0.2, 0.7]), *params)
        columns = [np.array([value, value, np.nan]) for value in params]
        result = family.ppf(np.array([0.2, 0.7, 0.5]), *columns)
        np.testing.assert_allclose(result[:2], good, rtol=1e-12, err_msg=name)
        assert np.isnan(result[2]), name


@pytest.mark.parametrize(("skewness", "kurtosis"), [(1.0, 1.9), (-1.0, 2.0), (0.0, 0.5)])
def test_johnson_refuses_a_kurtosis_that_nothing_has(skewness, kurtosis):
    fault = FAMILIES["Johnson moments"].fault(10.0, 2.0, skewness, kurtosis)
    assert fault.key == "kurtosis"
    assert "must be above 1 + Skewness" in fault.message


@pytest.mark.parametrize(("low", "high"), [(0.0, 5.0), (-5.0, 0.0)])
def test_johnson_sb_ends_at_its_limits(low, high):
    assert FAMILIES["Johnson SB"].support(low, high, 1.0, 2.0) == (low, high)
