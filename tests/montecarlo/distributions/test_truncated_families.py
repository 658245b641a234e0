"""Cutoffs on every family: what is left is the family between them, also where next to nothing is left."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.distributions import FAMILIES, Truncated

FAR = [
    ("Normal", (3.0, 2.0)),
    ("Exponential", (0.2,)),
    ("Gamma", (1.0, 2.0, 0.7)),
    ("Gamma", (0.0, 1.0, 40.0)),
    ("Logistic", (3.0, 2.0)),
    ("Lognormal", (0.0, 10.0, 3.0)),
    ("Lognorm2", (2.0, 1.0, 0.5)),
    ("Maximum Extreme", (3.0, 2.0)),
    ("Minimum Extreme", (3.0, 2.0)),
    ("Pareto", (10.0, 1.5)),
    ("Student's t", (3.0, 2.0, 4.0)),
    ("Weibull", (1.0, 2.0, 2.5)),
    ("Burr12", (1.0, 2.0, 3.0, 1.5)),
    ("Cauchy", (3.0, 2.0)),
    ("Dagum", (1.0, 2.0, 3.0, 2.0)),
    ("Fatigue life", (1.0, 2.0, 0.5)),
    ("Frechet", (1.0, 2.0, 3.0)),
    ("Hyperbolic secant", (3.0, 2.0)),
    ("Inverse Gaussian", (1.0, 3.0, 5.0)),
    ("Laplace", (3.0, 2.0)),
    ("Levy", (1.0, 2.0)),
    ("Log-logistic", (1.0, 2.0, 3.0)),
    ("Pareto2", (1.0, 2.0, 3.0)),
    ("Pearson5", (1.0, 2.0, 3.0)),
    ("Pearson6", (1.0, 2.0, 3.0, 4.0)),
]
NEAR = [
    *FAR,
    ("Uniform", (2.0, 6.0)),
    ("Triangular", (2.0, 5.0, 6.0)),
    ("Trapezoid", (2.0, 3.0, 5.0, 6.0)),
    ("Beta", (10.0, 20.0, 0.5, 3.0)),
    ("BetaPERT", (0.0, 1.0, 4.0)),
    ("Trigen", (1.0, 2.0, 3.0, 10.0, 90.0)),
    ("Kumaraswamy", (2.0, 6.0, 2.0, 3.0)),
]
U = np.array([0.0, 1e-6, 0.1, 0.5, 0.9, 1 - 1e-6])


@pytest.mark.parametrize(("name", "params"), NEAR)
@pytest.mark.parametrize(("below", "above"), [(0.2, 0.9), (0.6, 0.95), (1e-3, 0.3)])
def test_between_two_quantiles(name, params, below, above):
    family = FAMILIES[name]
    lower, upper = family.ppf(np.array([below, above]), *params)
    spread = family.ppf(0.75, *params) - family.ppf(0.25, *params)
    assert Truncated(family).check(lower, upper, *params) is None
    expected = family.ppf(below + U * (above - below), *params)
    np.testing.assert_allclose(Truncated(family).ppf(U, lower, upper, *params), expected, rtol=0, atol=1e-9 * spread)


@pytest.mark.parametrize(("name", "params"), FAR)
@pytest.mark.parametrize("left", [1e-12, 1e-100])
def test_far_out_above(name, params, left):
    """Of the probability above the cutoff, the share 1 - u lies above the quantile of u."""
    family = FAMILIES[name]
    cutoff = family.isf(left, *params)
    assert Truncated(family).check(cutoff, np.inf, *params) is None
    x = Truncated(family).ppf(U, cutoff, np.inf, *params)
    assert np.isfinite(x).all()
    assert (np.diff(x) > 0).all()
    np.testing.assert_allclose(family.sf(x[1:], *params) / left, 1 - U[1:], rtol=1e-9)


def test_every_continuous_family_is_here():
    continuous = {family.name for family in FAMILIES.values() if family.roles} | {"Uniform", "Trigen"}
    assert {name for name, _ in NEAR} == continuous
