from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from xlmc.analysis.studies.fitting import Unfit
from xlmc.analysis.studies.fitting.solved_forms import (
    SOLVED_FORMS,
    TRIANGULAR,
    _draw_triangular,
    _triangular_likeliest,
    maximise,
    root,
)


def test_the_top_of_a_hill():
    result = maximise(lambda p: -((p[0] - 3) ** 2) - 5 * (p[1] + 2 - p[0]) ** 2, [0.0, 0.0])
    np.testing.assert_allclose(result, [3, 1], atol=1e-5)


def test_a_hill_without_a_top():
    with pytest.raises(Unfit, match="no highest point"):
        maximise(lambda p: math.nan, [0.0])


@pytest.mark.parametrize("answer", [1e-4, 0.7, 3e4])
def test_a_root_outside_the_bracket(answer):
    assert root(lambda x: math.log(x / answer), 0.1, 10) == pytest.approx(answer, rel=1e-12)


@pytest.mark.parametrize("value", [-1.0, 1.0])
def test_no_root(value):
    with pytest.raises(Unfit, match="no highest point"):
        root(lambda _: value, 0.1, 10)


FORMS = {each.name: each for each in (*SOLVED_FORMS, TRIANGULAR)}
SAME = {
    "Gamma": (
        lambda location, scale, shape: stats.gamma(shape, location, scale),
        [(1.5, 3.0, 0.7), (1.5, 3.5, 4.0)],
    ),
    "Weibull": (
        lambda location, scale, shape: stats.weibull_min(shape, location, scale),
        [(1.5, 3.0, 0.7), (1.5, 3.5, 4.0)],
    ),
    "Maximum Extreme": (stats.gumbel_r, [(3.0, 2.0)]),
    "Minimum Extreme": (stats.gumbel_l, [(3.0, 2.0)]),
    "Logistic": (stats.logistic, [(3.0, 2.0)]),
    "Student's t": (lambda midpoint, scale, freedom: stats.t(freedom, midpoint, scale), [(3.0, 2.0, 4.0)]),
    "Beta": (lambda low, high, alpha, beta: stats.beta(alpha, beta, low, high - low), [(1.0, 4.0, 2.5, 0.6)]),
    "Triangular": (
        lambda low, likeliest, high: stats.triang((likeliest - low) / (high - low), low, high - low),
        [(1.0, 2.0, 5.0), (1.0, 1.0, 4.0), (1.0, 4.0, 4.0)],
    ),
}


@pytest.mark.parametrize(("name", "params"), [(name, params) for name, (_, every) in SAME.items() for params in every])
def test_density_and_distribution_function(name, params):
    oracle = SAME[name][0](*params)
    x = oracle.ppf([0.003, 0.2, 0.25, 0.5, 0.7, 0.99])
    np.testing.assert_allclose(FORMS[name].log_density(x, *params), oracle.logpdf(x), rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(FORMS[name].cdf(x, *params), oracle.cdf(x), rtol=1e-9)


def test_a_triangular_at_and_beyond_its_ends():
    x = np.array([0.5, 2.0, 5.5])
    with np.errstate(invalid="ignore"):
        density = FORMS["Triangular"].log_density(x, 1.0, 2.0, 5.0)
    np.testing.assert_allclose(density, [-np.inf, np.log(0.5), -np.inf])
    np.testing.assert_array_equal(FORMS["Triangular"].cdf(x, 1.0, 2.0, 5.0), [0, 0.25, 1])


UNITS = np.array([0.02, 0.1, 0.15, 0.4, 0.55, 0.93])
VALUES = {
    "wide": np.array([0.02, 0.7, 0.9, 1.0, 1.4, 2.5, 40.0]),
    "narrow": np.array([92.0, 97.0, 98.5, 99.0, 99.2, 99.9, 105.0, 117.0]),
}
SLOPES = [(name, each) for name in SAME if name not in ("Beta", "Triangular") for each in VALUES]


@pytest.mark.parametrize(("name", "values"), [*SLOPES, ("Beta", None)])
def test_the_likelihood_has_no_slope_at_the_estimate(name, values):
    x = UNITS if values is None else VALUES[values]
    form = FORMS[name]
    params = form.estimate(x)
    for place, heading in enumerate(form.headings):
        if heading in form.fixed:
            assert params[place] == (heading == "High")
            continue
        step = 1e-4 * params[place]
        ends = [np.array(params), np.array(params), np.array(params)]
        ends[0][place] -= step
        ends[2][place] += step
        low, top, high = (SAME[name][0](*each).logpdf(x).sum() for each in ends)
        bend = 2 * top - low - high
        assert bend > 0
        assert abs(high - low) / 2 < 0.02 * bend, heading  # the top is within a fiftieth of the step


@pytest.mark.parametrize("name", ["Gamma", "Weibull"])
def test_values_above_zero_only(name):
    with pytest.raises(Unfit, match="above 0 only"):
        FORMS[name].estimate(np.array([0.0, 1.0, 2.0]))


@pytest.mark.parametrize("x", [[0.0, 0.5, 0.7], [0.3, 0.5, 1.0]])
def test_a_beta_between_0_and_1_only(x):
    with pytest.raises(Unfit, match="between 0 and 1"):
        FORMS["Beta"].estimate(np.array(x))


@pytest.mark.parametrize(
    ("x", "reason"),
    [
        ([1.0, *[2.0] * 8, 3.0], "half of the values are equal"),
        (stats.norm.ppf((np.arange(40) + 0.5) / 40), "no heavier tails"),
    ],
)
def test_what_is_no_students_t(x, reason):
    with pytest.raises(Unfit, match=reason):
        FORMS["Student's t"].estimate(np.array(x))


def test_the_corner_of_a_triangular_is_the_likeliest_of_the_values():
    """The search over both ends against a grid of them, each value in turn as the corner."""
    x = np.array([1.0, 1.3, 1.4, 1.9, 2.6, 3.0, 4.2])
    low, likeliest, high = FORMS["Triangular"].estimate(x)
    assert likeliest in x
    ours = SAME["Triangular"][0](low, likeliest, high).logpdf(x).sum()
    a, b, c, value = np.meshgrid(np.linspace(0.0, 0.99, 34), np.linspace(4.21, 6.0, 36), x, x, indexing="ij")
    grid = stats.triang.logpdf(value, (c - a) / (b - a), a, b - a).sum(axis=-1)
    assert grid.max() <= ours < grid.max() + 0.05


@pytest.mark.parametrize("best", [0, 2, 5])
def test_the_best_of_the_values_as_the_corner(best):
    """Values crowd around one of them; the ends are given."""
    x = np.sort(np.append(np.arange(6.0), best + np.array([-0.1, 0.1, 0.15])))
    heights = [SAME["Triangular"][0](-1.0, c, 6.0).logpdf(x).sum() for c in x]
    assert _triangular_likeliest(x, -1.0, 6.0) == pytest.approx((x[np.argmax(heights)], max(heights)), rel=1e-12)


def test_the_errors_of_a_triangular_are_the_scatter_of_estimates(monkeypatch):
    """Samples from SciPy's triangular and the errors of the fit; 30 samples each know a scatter to 13 %."""
    monkeypatch.setattr("xlmc.analysis.studies.fitting.solved_forms._BOOTSTRAP_SAMPLES", 30)
    form, law = FORMS["Triangular"], SAME["Triangular"][0](1.0, 2.0, 5.0)
    random = np.random.default_rng(3)
    samples = [np.sort(law.rvs(60, random_state=random)) for _ in range(30)]
    scatter = np.std([form.estimate(x) for x in samples], axis=0, ddof=1)
    np.testing.assert_allclose(form.errors(samples[0], (1.0, 2.0, 5.0)), scatter, rtol=0.55)  # three times √2 · 13 %


@pytest.mark.parametrize(("u", "x"), [(0.0, 1.0), (0.0625, 1.5), (0.25, 2.0), (0.4375, 5 - np.sqrt(6.75)), (1.0, 5.0)])
def test_draws_of_a_triangular(u, x):
    """Below the corner at 2 the share is (x - 1)²/4, above it 1 - (5 - x)²/12."""
    assert _draw_triangular(np.array([u]), 1.0, 2.0, 5.0)[0] == pytest.approx(x, rel=1e-14)


def test_a_slope_without_an_end():
    with pytest.raises(Unfit, match="no highest point"):
        maximise(lambda p: p[0], [0.0], most=50)
