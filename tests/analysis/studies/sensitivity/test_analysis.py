"""All of it on whole runs."""

from __future__ import annotations

import dataclasses
import json
import math
from pathlib import Path

import pytest
from simulated import simulated

from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.analysis.studies.sensitivity.influences import MEASURED
from xlmc.errors import SimulationError
from xlmc.montecarlo.model.loading import load

EXAMPLES = Path(__file__).resolve().parents[4] / "examples"


@pytest.fixture(scope="module")
def case():
    """The paper's case study."""
    return sensitivities(simulated(load(EXAMPLES / "intersection.xlsx")))


def influence(result, forecast, assumption):
    return next(each for each in result[forecast].influences if each.assumption == assumption)


@pytest.mark.parametrize(
    ("assumption", "correlation"),
    [("Nissan departure angle", 0.76), ("Chevrolet approach angle", -0.71), ("Chevrolet departure angle", -0.12)],
)
def test_rank_correlations_of_the_case_study(case, assumption, correlation):
    """Reference values of two decimals, from some 3,500 accepted trials of another run: errors of 0.017 or less."""
    each = influence(case, "Nissan impact speed", assumption).rank_correlation
    assert each.value == pytest.approx(correlation, abs=4.0 * math.hypot(each.error, 0.017) + 0.005)


def test_what_is_irrelevant_is_not_seen(case):
    for assumption in ("Chevrolet yaw moment of inertia", "Nissan yaw moment of inertia"):
        for forecast in ("Chevrolet delta-V", "Nissan delta-V"):
            assert not influence(case, forecast, assumption).seen


def test_the_filters_decide_what_matters(case):
    """The tornado knows no filter, and says that the Chevrolet's approach angle moves its delta-V.

    Among the accepted trials it is tied to the other angles, and explains nothing of it.
    """
    first = [bar.assumption for bar in case["Chevrolet delta-V"].bars[:2]]
    assert "Chevrolet approach angle" in first
    assert not influence(case, "Chevrolet delta-V", "Chevrolet approach angle").seen


def test_it_is_plain_numbers_and_names(case):
    assert json.loads(json.dumps(dataclasses.asdict(case), allow_nan=True))["accepted"] == 3542


def test_a_forecast_is_found_whatever_its_case(case):
    assert case["chevrolet DELTA-V"].forecast == "Chevrolet delta-V"
    with pytest.raises(KeyError, match="no forecast 'x'"):
        case["x"]


def test_correlated_assumptions_share_what_they_explain(book, normal):
    """b is in no formula; it has the normal correlation ρ with a, and explains ρ² of it. Within 4 standard errors."""
    model = book(
        {"A1": 0.0, "A2": 0.0, "A3": 0.0, "B1": "=A1+2*A3"},
        {"a": normal("A1"), "b": normal("A2"), "c": normal("A3")},
        {"y": "B1", "z": "A2"},
        correlations={("a", "b"): 0.7},
    )
    result = sensitivities(simulated(model, 20_000, 2))
    rho = 2.0 * math.sin(math.pi * 0.7 / 6.0)
    for name, truth in (("a", 0.2), ("b", 0.2 * rho**2), ("c", 0.8)):
        each = influence(result, "y", name).explained
        assert abs(each.value - truth) < 4.0 * each.error


def many(book, n):
    cells = {f"A{i}": 0.5 for i in range(1, n + 1)} | {"B1": f"=A1+(A{n}-0.5)^2*8+0.001*SUM(A1:A{n})"}
    return book(cells, {f"a{i}": {"cell": f"A{i}", "low": 0.0, "high": 1.0} for i in range(1, n + 1)}, {"y": "B1"})


def test_of_many_assumptions_those_that_matter_are_measured(book):
    """Also the last one, whose effect falls and rises. The others still count where noise and shares are judged.

    Their squared correlations are noise of 1/n each; its sum is known to √(2 · 60)/2,048, three times that is allowed.
    """
    n = MEASURED + 60
    run = simulated(many(book, n), 4000, 1)
    result = sensitivities(run)
    assert (result.omitted, result["y"].omitted) == (60, 60)
    assert len(result["y"].influences) == len(result["y"].bars) == MEASURED
    assert {each.assumption for each in result["y"].influences[:2]} == {"a1", f"a{n}"}
    assert {each.assumption for each in result["y"].bars[:2]} == {"a1", f"a{n}"}
    every = sensitivities(run, assumptions=[f"a{i}" for i in range(1, n + 1)])
    assert (every.omitted, len(every["y"].influences), len(every["y"].bars)) == (0, n, n)
    whole_square = influence(every, "y", "a1").rank_correlation.value ** 2
    for each in result["y"].influences:
        whole = influence(every, "y", each.assumption)
        assert each.explained_floor == whole.explained_floor
        noise = (60 / run.accepted + 3 * math.sqrt(2 * 60) / 2048) / whole_square
        assert each.contribution.value == pytest.approx(whole.contribution.value, abs=noise)


def test_an_assumption_that_is_asked_for_is_measured(book):
    n = MEASURED + 60
    run = simulated(many(book, n), 4000, 1)
    plain = sensitivities(run)["y"]
    other = next(f"a{i}" for i in range(2, n) if f"a{i}" not in {each.assumption for each in plain.influences})
    asked = sensitivities(run, assumptions=[f" {other.upper()}"])["y"]
    assert other in {each.assumption for each in asked.influences}
    assert other in {bar.assumption for bar in asked.bars}
    with pytest.raises(SimulationError, match="No assumption that is drawn is called 'b1'"):
        sensitivities(run, assumptions=["b1"])


@pytest.mark.parametrize("sampling", ["lhs", "lhs500", "sobol"])
def test_replicated_runs_have_errors_of_their_own(book, sampling):
    model = book(
        {"A1": 0.5, "A2": 0.5, "B1": "=A1+A2"},
        {"a": {"cell": "A1", "low": 0.0, "high": 1.0}, "b": {"cell": "A2", "low": 0.0, "high": 1.0}},
        {"y": "B1"},
        {"f": {"cell": "B1", "below": 1.5}},
    )
    plain = influence(sensitivities(simulated(model, 40_000, 1)), "y", "a")
    each = influence(sensitivities(simulated(model, 40_000, 1, sampling=sampling)), "y", "a")
    assert 0.0 < each.explained.error < 2.0 * plain.explained.error
    assert each.explained.value == pytest.approx(plain.explained.value, abs=4 * plain.explained.error * 5**0.5)
    assert each.rank_correlation.value == pytest.approx(plain.rank_correlation.value, abs=0.04)


def test_draws_that_were_not_kept(book):
    result = sensitivities(simulated(many(book, 3), 1000, 1, keep_inputs=0))
    assert result["y"].influences == ()
    assert len(result["y"].bars) == 3


def test_no_accepted_trial_and_no_live_assumption(book):
    none = book(
        {"A1": 0.5, "B1": "=A1", "C1": "=A1>5"},
        {"a": {"cell": "A1", "low": 0.0, "high": 1.0}},
        {"y": "B1"},
        {"f": "C1", "g": {"cell": "B1", "below": 0.5}},
    )
    result = sensitivities(simulated(none, 500, 1))
    assert result["y"].influences == ()
    assert result.filter_limits == ()
    still = book({"A1": 0.5, "B1": "=A1"}, {"a": {"cell": "A1", "low": 0, "high": 1, "frozen": True}}, {"y": "B1"})
    result = sensitivities(simulated(still, 10, 1))
    assert (result["y"].influences, result["y"].bars, result["y"].base) == ((), (), 0.5)
    assert "no assumption is drawn" in result.sobol_reason


def test_trials_without_a_number_are_left_out_of_that_forecast_only(book):
    model = book(
        {"A1": 0.5, "A2": 0.5, "B1": "=SQRT(A1-0.5)+A2", "B2": "=A1+A2"},
        {"a": {"cell": "A1", "low": 0.0, "high": 1.0}, "b": {"cell": "A2", "low": 0.0, "high": 1.0}},
        {"root": "B1", "sum": "B2"},
    )
    run = simulated(model, 4000, 1)
    result = sensitivities(run)
    assert result["sum"].trials == 4000
    assert result["root"].trials == run["root"].values.size
    assert influence(result, "root", "a").explained.n == result["root"].trials
