"""Sobol's indices within 4 standard errors of the closed form, and not given where they would mislead."""

from __future__ import annotations

import numpy as np
import pytest
from simulated import simulated

from xlmc.analysis.studies.sensitivity import pick_and_freeze as module
from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.analysis.studies.sensitivity.pick_and_freeze import pick_and_freeze, sobol_indices

# Ishigami & Homma 1990, a = 7, b = 0.1: assumption -> first order, total.
ISHIGAMI = {"x1": (0.31391, 0.55759), "x2": (0.44241, 0.44241), "x3": (0.0, 0.24368)}


@pytest.fixture(scope="module")
def result(ishigami):
    return sensitivities(simulated(ishigami, 50_000, 3))


@pytest.mark.parametrize("name", ISHIGAMI)
def test_ishigami(result, name):
    first, total = ISHIGAMI[name]
    each = next(i for i in result["y"].influences if i.assumption == name)
    assert abs(each.first_order.value - first) < 4.0 * each.first_order.error
    assert abs(each.total.value - total) < 4.0 * each.total.error
    assert abs(each.explained.value - first) < 4.0 * each.explained.error + 0.002  # 16 classes of a sine
    assert 0.0 < each.total.error < 0.03
    assert each.seen


def test_what_acts_only_with_others_is_not_explained_but_seen(result):
    """x3 moves the spread alone: no rank correlation, no variance explained, a total effect, and dependence."""
    each = next(i for i in result["y"].influences if i.assumption == "x3")
    assert each.explained.value < each.explained_floor
    assert abs(each.rank_correlation.value) < 4.0 * each.rank_correlation.error
    assert each.dependence.value > each.dependence_floor


def test_linear(book, normal):
    model = book(
        {"A1": 0.0, "A2": 0.0, "A3": 0.0, "B1": "=3*A1-4*A2", "B2": "=A3"},
        {name: normal(f"A{n}") for n, name in enumerate("abc", 1)},
        {"y": "B1", "z": "B2"},
    )
    run = pick_and_freeze(model, {name: [0, 1] for name in model.draws}, 200_000, 5)
    for name, truth in (("a", 0.36), ("b", 0.64)):
        first, total = run.indices[name][0]
        assert abs(first.value - truth) < 4.0 * first.error
        assert abs(total.value - truth) < 4.0 * total.error
    assert run.indices["c"][0][1].value == 0.0  # it does not enter y: to the last bit
    assert run.indices["c"][1][1].value == pytest.approx(1.0, abs=4.0 * run.indices["c"][1][1].error)


@pytest.mark.parametrize("most", [1, 1_000, 5_000, 1 << 23])
def test_assumptions_that_are_evaluated_together_have_the_same_indices(ishigami, monkeypatch, most):
    asked = {name: [0] for name in ishigami.draws}
    expected = pick_and_freeze(ishigami, asked, 10, 1)
    monkeypatch.setattr(module, "_MOST_NUMBERS", most)
    messages = []
    assert pick_and_freeze(ishigami, asked, 10, 1, messages.append) == expected
    assert messages[-1] == 1.0
    assert pick_and_freeze(ishigami, {}, 10, 1).indices == {}


def test_errors_are_the_spread_between_runs(ishigami):
    """The spread of 60 is known to 9 %; 4 times that is asked."""
    runs = [pick_and_freeze(ishigami, {name: [0] for name in ishigami.draws}, 10, seed) for seed in range(60)]
    for order in (0, 1):
        each = [run.indices["x1"][0][order] for run in runs]
        spread = np.std([estimate.value for estimate in each], ddof=1)
        assert np.mean([estimate.error for estimate in each]) == pytest.approx(spread, rel=0.36)


def test_pairs_without_a_number_are_left_out():
    rng = np.random.default_rng(1)
    a, b, c = rng.normal(size=(3, 1000))
    holed = a.copy()
    holed[:10] = np.nan
    assert sobol_indices(holed, b, c) == sobol_indices(a[10:], b[10:], c[10:])


def uniforms(*names, **more):
    return {name: {"cell": f"A{n}", "low": 0.0, "high": 1.0, **more} for n, name in enumerate(names, 1)}


CELLS = {"A1": 0.5, "A2": 0.5, "B1": "=A1+A2", "C1": "=A1"}


@pytest.mark.parametrize(
    ("definitions", "why"),
    [
        ({"filters": {"f": {"cell": "C1", "below": 0.9}}}, "the filters reject trials"),
        ({"correlations": {("a", "b"): 0.5}}, "assumptions are correlated"),
    ],
)
def test_it_is_said_why_there_are_none(book, definitions, why):
    result = sensitivities(simulated(book(CELLS, uniforms("a", "b"), {"y": "B1"}, **definitions), 2000, 1))
    assert why in result.sobol_reason
    assert result.sobol_trials == 0
    assert all(each.total is None for each in result["y"].influences)


def test_none_where_a_parameter_depends_on_an_assumption(book):
    given = uniforms("a", "b")
    given["b"]["high"] = "C2"
    result = sensitivities(simulated(book({**CELLS, "C2": "=A1+1"}, given, {"y": "B1"}), 2000, 1))
    assert "parameters of assumptions depend" in result.sobol_reason


def test_a_filter_that_rejects_nothing_is_no_reason(book):
    model = book(CELLS, uniforms("a", "b"), {"y": "B1"}, {"f": {"cell": "C1", "below": 2.0}})
    result = sensitivities(simulated(model, 2000, 1))
    assert result.sobol_reason == ""
    assert result.sobol_trials > 0
