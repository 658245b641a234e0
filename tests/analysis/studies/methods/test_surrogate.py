"""Polynomials that are exact for quadratic cells, and the cells at which they take over."""

from __future__ import annotations

import numpy as np
import pytest
from simulated import simulated

from xlmc.analysis.studies.methods.surrogate import (
    Quadratic,
    Surrogate,
    _cut,
    _draws,
    _errors,
    _pilot_size,
    _run,
    _terms,
    fit_quadratic,
)
from xlmc.errors import SimulationError
from xlmc.excel.address import parse_address

INPUTS = {"u": {"cell": "A1", "low": 1.0, "high": 2.0}, "v": {"cell": "A2", "low": -1.0, "high": 1.0}}
CELLS = {
    "A1": 1.5,
    "A2": 0.5,
    "B1": "=A1^2+3*A1*A2-A2",
    "B2": "=A1+2",
    "C1": "=IF(A2>0,1,-1)",
    "D1": "=B1/B2",
    "D2": "=B2*C1",
}


@pytest.fixture(scope="module")
def model(model_of):
    return model_of(CELLS, INPUTS, {"ratio": "D1", "sign": "D2"}, {"f": {"cell": "D1", "at_least": 0.5}})


@pytest.mark.parametrize(("k", "count"), [(0, 1), (1, 3), (2, 6), (3, 10), (60, 1 + 120 + 1770), (61, 123)])
def test_how_many_coefficients(k, count):
    """1, the variables, their squares and, of sixty variables and fewer, products of two."""
    assert Quadratic.coefficients(k) == count
    assert _terms(np.ones((2, k))).shape == (count, 2)


@pytest.mark.parametrize(("k", "trials"), [(2, 1_024), (18, 1_024), (19, 16 * 210 // 3), (60, 16 * 1891 // 3)])
def test_the_size_of_a_pilot(k, trials):
    assert _pilot_size(k) == trials


def test_terms_by_hand():
    assert _terms(np.array([[2.0, 3.0, 5.0]])).ravel().tolist() == [1, 2, 3, 5, 4, 9, 25, 6, 10, 15]


@pytest.mark.parametrize("n", [40, 2_500])
def test_a_quadratic_is_fitted_exactly(n):
    rng = np.random.default_rng(1)
    x = rng.uniform(3.0, 9.0, (n, 3))

    def values(x):
        a, b, c = x.T
        return np.column_stack([1 + 2 * a - b + 0.5 * c * c + a * b - 3 * b * c, a * a])

    made = fit_quadratic(x, values(x))
    assert (made.centre, made.scale) == (pytest.approx(x.mean(axis=0)), pytest.approx(x.std(axis=0)))
    other = rng.uniform(3.0, 9.0, (n, 3))
    np.testing.assert_allclose(made(other), values(other), rtol=1e-7, atol=1e-6)


def test_a_variable_that_does_not_vary_changes_nothing():
    x = np.column_stack([np.linspace(0, 1, 30), np.full(30, 5.0)])
    made = fit_quadratic(x, (3 * x[:, :1] + 1))
    assert made.scale[1] == 1
    np.testing.assert_allclose(made(x)[:, 0], 3 * x[:, 0] + 1, rtol=1e-8)


def test_errors_in_trials_that_were_not_fitted_to():
    x = np.random.default_rng(2).uniform(-1, 1, (4_000, 1))
    quadratic, step, constant = 1 + x**2, np.sign(x), np.full_like(x, 3.0)
    lost = np.where(x > 0.9, np.nan, x)
    errors = _errors(x, np.column_stack([quadratic, step, constant, lost]))
    assert errors[0] == pytest.approx(0, abs=1e-8)
    # the best line through a sign on (-1, 1) is 3x/2, and leaves a quarter of its variance
    assert errors[1] == pytest.approx(0.5, abs=0.03)
    assert errors[2] == pytest.approx(0, abs=1e-8)
    assert errors[3] == np.inf
    assert _errors(x, lost).tolist() == [np.inf]
    tested = np.where(np.arange(4_000)[:, None] < 1_000, 100.0, 0.0)  # the first quarter is what it is tested with
    assert _errors(x, tested)[0] == pytest.approx(100 / tested.std())


def at(*addresses):
    return [parse_address(each, "S") for each in addresses]


@pytest.mark.parametrize(
    ("errors", "cells"),
    [
        ({"B1": 0.0, "B2": 0.0, "C1": 0.9, "D1": 0.5, "D2": 0.9}, ["B1", "B2", "A2"]),
        ({"B1": 0.03, "B2": 0.031, "C1": 0.9, "D1": 0.5, "D2": 0.9}, ["B1", "A1", "A2"]),
        ({"B1": 0.0, "B2": 0.0, "C1": 0.0, "D1": 0.0, "D2": 0.0}, ["D1", "D2"]),
    ],
)
def test_formulas_are_followed_upwards_to_smooth_cells(model, errors, cells):
    known = {parse_address(address, "S"): error for address, error in errors.items()}
    assert {*_cut(model, known)} == {*at(*cells)}


def test_draws_are_independent_and_without_what_is_no_number(model, model_of):
    points = _draws(model, 500, 1)
    assert points.shape == (500, 2)
    assert (points.min(axis=0) >= [1, -1]).all()
    inputs = {"u": {"cell": "A1", "low": -1.0, "high": 1.0}, "w": {"cell": "A2", "low": 0.0, "high": "A1"}}
    some = _draws(model_of({"A1": 0.5, "A2": 0.1, "B1": "=A1+A2"}, inputs, {"x": "B1"}), 500, 1)
    assert 150 < len(some) < 350  # where the high end is above the low one
    assert np.isfinite(some).all()


def test_answers_are_those_of_the_workbook_where_polynomials_are_exact(model):
    n = 20_000  # three blocks, the last one in part
    result = Surrogate().run(model, n, 1)
    run = simulated(model, n, seed=5)
    assert result.evaluations == 1_024
    assert result.acceptance == pytest.approx(run.accepted / n, abs=4 * np.sqrt(0.25 / n * 2))
    for name in ("ratio", "sign"):
        x = run.forecasts[name]
        error = x.std() / np.sqrt(run.accepted / 2)
        assert result.answers[name].mean == pytest.approx(x.mean(), abs=4 * error)
        assert result.answers[name].sd == pytest.approx(x.std(), rel=0.05)
    (remark,) = result.remarks
    assert remark.startswith("fitted to 1,024 trials; polynomials instead of S!")


@pytest.mark.parametrize("trials", [100, 8_192, 8_193])
def test_as_many_trials_as_were_asked_for(model, trials):
    (b1,) = at("B1")
    pilot = _draws(model, 1_024, 1)
    values = pilot[:, 0] ** 2 + 3 * pilot[:, 0] * pilot[:, 1] - pilot[:, 1]
    accepted, columns = _run(model, [b1], fit_quadratic(pilot, values[:, None]), trials, 7)
    drawn = model.sampler(7, trials).draw(0)
    u, v = drawn["u"], drawn["v"]
    ratio = (u**2 + 3 * u * v - v) / (u + 2)
    assert accepted == np.count_nonzero(ratio >= 0.5)
    np.testing.assert_allclose(columns[:, 0], ratio[ratio >= 0.5], rtol=1e-6)


def test_no_cell_is_smooth(model_of):
    cells = {"A1": 1.5, "A2": 0.5, "B1": "=IF(A1>1.5,1,0)+IF(A2>0,1,0)"}
    with pytest.raises(SimulationError, match="quadratic polynomial to 3 % of its spread"):
        Surrogate().run(model_of(cells, INPUTS, {"x": "B1"}), 1_000, 1)


def test_too_many_cells(model, monkeypatch):
    monkeypatch.setattr("xlmc.analysis.studies.methods.surrogate._MOST_CELLS", 4)
    with pytest.raises(SimulationError, match="5 cells vary, and the surrogate looks at no more than 4"):
        Surrogate().run(model, 1_000, 1)
    monkeypatch.setattr("xlmc.analysis.studies.methods.surrogate._MOST_CELLS", 5)
    assert Surrogate().run(model, 1_000, 1).evaluations == 1_024
