"""The true family of a large seeded sample comes first, with parameters within four standard errors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from xlmc.analysis.studies.fitting import (
    CRITERIA,
    KINDS,
    fit,
    parameter_texts,
    rounded_value,
    row_to_paste,
    share_at_most,
    solved_forms,
)
from xlmc.analysis.studies.fitting.fit import (
    anderson_darling,
    cautions,
    kolmogorov_smirnov,
    kolmogorov_smirnov_of_counts,
)
from xlmc.errors import SimulationError
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.distributions.spelling import plain

N = 2000
HARD_TO_TELL = ("Uniform", "Hyperbolic secant", "Inverse Gaussian")
"""From others that are much like them: samples of these are twice as large."""
TRUTHS = {
    "Normal": (stats.norm(5, 2), {"Mean": 5, "Std dev": 2}),
    "Uniform": (stats.uniform(2, 4), {"Low": 2, "High": 6}),
    "Triangular": (stats.triang(0.25, 0, 4), {"Low": 0, "Likeliest": 1, "High": 4}),
    "Lognormal": (
        stats.lognorm(0.5, scale=np.e),
        {"Location": 0, "Mean": np.exp(1.125), "Std dev": np.exp(1.125) * np.sqrt(np.expm1(0.25))},
    ),
    "Exponential": (stats.expon(scale=2), {"Rate": 0.5}),
    "Gamma": (stats.gamma(3, scale=2), {"Location": 0, "Scale": 2, "Shape": 3}),
    "Weibull": (stats.weibull_min(1.7, scale=2), {"Location": 0, "Scale": 2, "Shape": 1.7}),
    "Logistic": (stats.logistic(3, 2), {"Mean": 3, "Scale": 2}),
    "Beta": (stats.beta(2, 5), {"Low": 0, "High": 1, "Alpha": 2, "Beta": 5}),
    "Maximum Extreme": (stats.gumbel_r(5, 2), {"Likeliest": 5, "Scale": 2}),
    "Minimum Extreme": (stats.gumbel_l(-5, 2), {"Likeliest": -5, "Scale": 2}),
    "Student's t": (stats.t(4, 3, 2), {"Midpoint": 3, "Scale": 2, "Degrees of freedom": 4}),
    "Pareto": (stats.pareto(3, scale=2), {"Location": 2, "Shape": 3}),
    "Laplace": (stats.laplace(3, np.sqrt(2)), {"Mean": 3, "Std dev": 2}),
    "Hyperbolic secant": (stats.hypsecant(3, 4 / np.pi), {"Mean": 3, "Std dev": 2}),
    "Inverse Gaussian": (stats.invgauss(0.6, 0, 5), {"Location": 0, "Mean": 3, "Shape": 5}),
    "Log-logistic": (stats.fisk(3, scale=2), {"Location": 0, "Scale": 2, "Shape": 3}),
    "Frechet": (stats.invweibull(3, scale=2), {"Location": 0, "Scale": 2, "Shape": 3}),
    "Fatigue life": (stats.fatiguelife(1.5, scale=2), {"Location": 0, "Scale": 2, "Shape": 1.5}),
    "Pearson5": (stats.invgamma(3, scale=2), {"Location": 0, "Scale": 2, "Shape": 3}),
    "Poisson": (stats.poisson(4), {"Rate": 4}),
    "Binomial": (stats.binom(12, 0.3), {"Probability": 0.3, "Trials": 12}),
    "Geometric": (stats.geom(0.3), {"Probability": 0.3}),
    "Geomet": (stats.geom(0.3, loc=-1), {"Probability": 0.3}),
    "Negative Binomial": (stats.nbinom(4, 0.3, loc=4), {"Probability": 0.3, "Shape": 4}),
    "Negbin": (stats.nbinom(4, 0.3), {"Probability": 0.3, "Shape": 4}),
    "Discrete Uniform": (stats.randint(3, 12), {"Low": 3, "High": 11}),
}

X = np.sort(np.random.default_rng(1).normal(0.1, 1.1, 50))


@pytest.fixture
def few_bootstrap_samples(monkeypatch):
    """Errors of the triangular family from 25 samples, of which they are known to 14 %."""
    monkeypatch.setattr(solved_forms, "_BOOTSTRAP_SAMPLES", 25)


def test_every_family_is_tried():
    assert {candidate.name for kind in KINDS.values() for candidate in kind} == set(TRUTHS)


@pytest.mark.parametrize("name", TRUTHS)
def test_a_large_sample_finds_its_family(name, few_bootstrap_samples):
    """By BIC, which also tells a family from a wider one that contains it."""
    oracle, truth = TRUTHS[name]
    n = 2 * N if name in HARD_TO_TELL else N
    result = fit(oracle.rvs(n, random_state=np.random.default_rng(999)), by="bic")
    best = result.fits[0]
    assert best.name == name, [each.name for each in result.fits[:3]]
    assert best.parameters.keys() == truth.keys()
    for heading, value in truth.items():
        error = best.errors[heading]
        if error is None:
            assert best.parameters[heading] == value, heading
        else:
            assert abs(best.parameters[heading] - value) < 4 * error, heading
            assert 0 < error < 0.3 * (abs(value) + 1)


@pytest.mark.parametrize("by", CRITERIA)
def test_ranking(by):
    result = fit(stats.gamma(3).rvs(500, random_state=np.random.default_rng(2)), by=by)
    figures = [getattr(each, by) for each in result.fits]
    assert figures == sorted(figures)
    assert result.by == by
    assert result.fits[0].name in ("Gamma", "Weibull", "Lognormal", "Maximum Extreme")


def test_criteria_are_what_they_are_called():
    x = stats.norm(5, 2).rvs(300, random_state=np.random.default_rng(3))
    normal = next(each for each in fit(x).fits if each.name == "Normal")
    top = stats.norm(x.mean(), x.std()).logpdf(x).sum()
    assert normal.log_likelihood == pytest.approx(top, rel=1e-12)
    assert normal.aic == pytest.approx(4 - 2 * top, rel=1e-12)
    assert normal.bic == pytest.approx(2 * np.log(300) - 2 * top, rel=1e-12)


def test_whole_numbers_are_counts_unless_told_otherwise():
    x = [3, 5, 4, 2, 6, 3, 4, 7, 1, 0]
    assert fit(x, errors=False).kind == "counts"
    assert fit(x, kind="continuous", errors=False).kind == "continuous"
    assert fit([*x, 2.5], errors=False).kind == "continuous"
    assert fit([*x, -1], errors=False).kind == "continuous"


def test_what_cannot_be_fitted_says_why():
    unfit = fit([-1.5, 2, 3, 5], errors=False).unfit
    assert unfit["Lognormal"] == "it takes values above 0 only"
    assert unfit["Exponential"] == "it takes values from 0 up only"
    assert unfit["Beta"] == "it is fitted to values between 0 and 1 only"
    assert fit([0, 2, 9, 5]).unfit["Geometric"] == "it counts trials, which are 1 or more"
    assert fit([0, 2, 9, 5]).unfit["Binomial"] == "the variance of the values is not below their mean"
    assert fit([4, 4, 5, 5]).unfit["Negbin"] == "the variance of the values is not above their mean"


@pytest.mark.parametrize(
    ("values", "kind", "message", "hint"),
    [
        ([], None, "there is no value to fit", "One measurement justifies a uniform range only"),
        ([0.7], None, "there is one value to fit", "One measurement justifies a uniform range only"),
        ([0.7, 0.7, 0.7], None, "all 3 values are equal", "say nothing of the spread"),
        ([0.7, np.nan], None, "a value is not a finite number", "Correct it"),
        ([0.7, 0.8], "counts", "not every value is a whole number from 0 up", "continuous"),
    ],
)
def test_values_that_cannot_be_fitted(values, kind, message, hint):
    with pytest.raises(SimulationError) as caught:
        fit(values, kind=kind)
    assert caught.value.message == message
    assert hint in caught.value.hint


def test_the_order_and_the_scale_of_the_values_do_not_matter():
    x = stats.gamma(3).rvs(60, random_state=np.random.default_rng(5))
    plain_, backwards, large = fit(x), fit(x[::-1]), fit(x * 1e6)
    assert backwards == plain_
    assert [each.name for each in large.fits] == [each.name for each in plain_.fits]
    for one, other in zip(plain_.fits, large.fits, strict=True):
        assert other.aic - large.fits[0].aic == pytest.approx(one.aic - plain_.fits[0].aic, abs=1e-4)


@pytest.mark.parametrize("n", [2, 5, 16])
def test_small_samples_are_fitted_without_a_fault(n, few_bootstrap_samples):
    """With the errors of the fewest."""
    result = fit(np.random.default_rng(n).normal(0.75, 0.05, n), errors=n == 2)
    assert result.n == n
    assert len(result.fits) >= 5
    assert all(np.isfinite(each.aic) for each in result.fits)


def test_ties_and_rounded_values_are_fitted_without_a_fault():
    assert len(fit([0.7, 0.7, 0.7, 0.8, 0.8, 0.9], errors=False).fits) >= 8


def test_headings_are_those_of_the_families():
    """So that the row to paste can be read."""
    checked = set()
    for candidate in (candidate for kind in KINDS.values() for candidate in kind):
        if candidate.name in FAMILIES:
            known = {plain(heading) for spec in FAMILIES[candidate.name].parameters for heading in spec.headings}
            assert {plain(heading) for heading in candidate.headings} <= known, candidate.name
            checked.add(candidate.name)
    assert checked >= {"Normal", "Uniform", "Triangular", *(candidate.name for candidate in KINDS["counts"])}


@pytest.mark.parametrize(
    ("n", "words"),
    [(2, "2 values cannot tell"), (14, "cannot tell"), (15, "only roughly"), (29, "only roughly"), (30, None)],
)
def test_few_values(n, words):
    sentence = cautions(n, ["Normal"])
    if words is None:
        assert sentence == ()
    else:
        assert words in sentence[0]
        assert "uniform range" in sentence[0]


def test_rivals():
    (sentence,) = cautions(100, ["Normal", "Logistic", "Weibull"])
    assert sentence.startswith("Normal, Logistic and Weibull describe the values about equally well")


def test_anderson_darling_against_scipy():
    theirs = stats.goodness_of_fit(
        stats.norm, X, known_params={"loc": 0, "scale": 1}, statistic="ad", n_mc_samples=1
    ).statistic
    assert anderson_darling(stats.norm.cdf(X)) == pytest.approx(theirs, rel=1e-12)


def test_a_value_on_the_end_is_infinitely_far():
    assert anderson_darling(np.array([0.0, 0.5])) == anderson_darling(np.array([0.5, 1.0])) == np.inf


def test_kolmogorov_smirnov_against_scipy():
    assert kolmogorov_smirnov(stats.norm.cdf(X)) == pytest.approx(stats.kstest(X, "norm").statistic, rel=1e-14)


def test_kolmogorov_smirnov_of_counts_looks_at_every_whole_number():
    x = np.sort(np.random.default_rng(2).poisson(4, 60)).astype(float)
    oracle = stats.poisson(4.2)
    expected = max(abs(np.mean(x <= k) - oracle.cdf(k)) for k in range(-1, 30))
    assert kolmogorov_smirnov_of_counts(x, oracle.cdf) == pytest.approx(expected, rel=1e-14)


DATA = {
    "positive": np.random.default_rng(0).lognormal(0.0, 1.0, 60),
    "between 0 and 1": np.random.default_rng(1).beta(0.5, 0.5, 60),
    "negative": np.random.default_rng(2).normal(-5.0, 1.0, 50),
    "heavy tails": np.random.default_rng(3).standard_t(2, 80),
    "counts": np.random.default_rng(4).poisson(3, 40),
    "counts from 1": np.random.default_rng(5).geometric(0.3, 40),
}


@pytest.mark.parametrize("name", DATA)
def test_shares_at_most_rise_from_0_to_1_beyond_the_support_too(name):
    values = np.sort(DATA[name])
    margin = 0.3 * (values[-1] - values[0])
    at = np.linspace(values[0] - margin, values[-1] + margin, 101)
    for fitted in fit(values, errors=False).fits:
        shares = share_at_most(fitted, at)
        assert np.all((shares >= 0.0) & (shares <= 1.0)), fitted.name
        assert np.all(np.diff(shares) >= -1e-12), fitted.name


FAR_FROM_0 = {
    "coordinates": 1_234_567.0 + np.random.default_rng(6).normal(0.0, 0.05, 40).round(4),
    "times of one day": 45_321.5 + np.random.default_rng(7).uniform(0.0, 0.01, 40).round(6),
    "large counts": 3.0e7 + np.random.default_rng(8).poisson(9, 40),
}


@pytest.mark.parametrize("name", FAR_FROM_0)
def test_rounded_parameters_give_the_same_distribution_far_from_0(name):
    values = np.sort(FAR_FROM_0[name])
    result = fit(values, kind="continuous", errors=False)
    assert len(result.fits) > 3
    for fitted in result.fits:
        texts = parameter_texts(fitted)
        read = {heading: float(text) for heading, text in texts.items()}
        shares = share_at_most(replace(fitted, parameters=read), values)
        assert shares == pytest.approx(share_at_most(fitted, values), abs=2e-4), (fitted.name, texts)
    middle = float(np.median(values))
    assert rounded_value(result.fits[0], middle) == pytest.approx(middle, abs=1e-3 * (values[-1] - values[0]))


def test_parameters_and_the_base_value_have_six_digits_where_these_are_enough():
    fitted = next(each for each in fit(DATA["negative"], errors=False).fits if each.name == "Normal")
    mean = float(np.mean(DATA["negative"]))
    assert parameter_texts(fitted)["Mean"] == f"{mean:.6g}"
    assert row_to_paste(fitted, "x", "")["Mean"] == f"{mean:.6g}"
    assert rounded_value(fitted, -5.123456789) == -5.12346
