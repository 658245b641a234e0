"""Columns that are fitted together: closed loops with known families and copulas, and what is written into a book."""

from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.analysis.studies.fitting import columns as studied
from xlmc.analysis.studies.fitting.columns import fit_columns
from xlmc.errors import SimulationError
from xlmc.montecarlo.sampling.copulas import Clayton, Frank, Gumbel, StudentTCopula


def measured(n=200, seed=3):
    rng = np.random.default_rng(seed)
    friction = rng.normal(0.7, 0.05, n)
    speed = 30 + 60 * (friction - 0.7) + rng.normal(0, 2, n)
    return {"Friction": friction.tolist(), "Speed": speed.tolist(), "Surface": rng.choice(["dry", "wet"], n).tolist()}


@pytest.mark.parametrize(
    ("density", "parameters"),
    [
        (studied._gaussian, (0.6,)),
        (studied._student, (0.5, 4.0)),
        (studied._clayton, (2.0,)),
        (studied._gumbel, (1.8,)),
        (studied._frank, (5.0,)),
    ],
)
def test_densities_have_uniform_margins(density, parameters):
    at = (np.arange(2_000) + 0.5) / 2_000
    for u in (0.2, 0.5, 0.9):
        total = np.exp(density(np.full(at.size, u), at, *parameters)).mean()
        assert total == pytest.approx(1.0, abs=2e-3)


@pytest.mark.parametrize(
    ("name", "copula", "key", "wanted"),
    [
        ("Clayton", Clayton(2, 2.0), "theta", 2.0),
        ("Gumbel", Gumbel(2, 1.8), "theta", 1.8),
        ("Frank", Frank(2, 5.0), "theta", 5.0),
        ("t", StudentTCopula(np.array([[1.0, 0.6], [0.6, 1.0]]), 4.0), "correlation", 0.6),
    ],
)
@pytest.mark.parametrize("turned", [False, True])
def test_the_copula_that_drew_is_the_best_and_has_its_number(name, copula, key, wanted, turned):
    u = np.random.default_rng(7).random((2, 3_000))
    copula.join(u)
    result = fit_columns({"a": u[0].tolist(), "b": (1.0 - u[1] if turned else u[1]).tolist()})
    best = result.pairs[0].copulas[0]
    assert best.name == name
    if name != "t":
        assert best.turned == turned
    sign = -1.0 if turned and name == "t" else 1.0
    assert best.parameters[key] == pytest.approx(sign * wanted, rel=0.12)


def test_independent_columns_are_so():
    rng = np.random.default_rng(5)
    result = fit_columns({"a": rng.normal(size=500).tolist(), "b": rng.normal(size=500).tolist()})
    assert result.pairs[0].copulas[0].aic > -4.0


def test_columns_of_numbers_texts_and_gaps():
    data = measured()
    data["Speed"][5] = None
    data["Always"] = [1.0] * 200
    result = fit_columns(data)
    friction, speed, surface, always = result.columns
    assert friction.best.name in (
        "Normal",
        "Logistic",
        "Fatigue life",
        "Gamma",
        "Lognormal",
        "Inverse Gaussian",
        "Weibull",
    )
    assert speed.fitting.n == 199
    assert sum(each.value for each in surface.shares.values()) == pytest.approx(1.0)
    assert "equal" in always.why
    (pair,) = result.pairs
    assert pair.n == 199
    exact = 60 * 0.05 / math.hypot(60 * 0.05, 2)
    assert abs(pair.correlation.value - 6 / math.pi * math.asin(exact / 2)) < 4 * pair.correlation.error
    with pytest.raises(SimulationError, match="No column can be fitted"):
        fit_columns({"a": [1.0, 1.0]})


def test_the_bootstrap_spreads_as_the_likelihood_says():
    result = fit_columns({"x": np.random.default_rng(2).normal(10, 2, 400).tolist()}, bootstraps=300)
    (column,) = result.columns
    assert column.best.name == "Normal"
    for heading, error in column.best.errors.items():
        assert column.repeated[heading].std() == pytest.approx(error, rel=0.25)
