"""Answers of scenarios beside the workbook's own: the numbers are those of single runs, and errors what they say."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from xlmc.analysis.studies.scenario_answers import model_of, scenario_answers
from xlmc.errors import DefinitionError, SimulationError
from xlmc.montecarlo.definitions.scenarios import Frozen, Limits, Range, Scenario
from xlmc.montecarlo.definitions.stopping import stopping
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.simulation.simulate import simulate

CELLS = {"A1": 0.5, "A2": 0.5, "B1": "=A1+A2^2", "B2": "=A1-A2"}
GIVEN = {"a": {"cell": "A1", "low": 0, "high": 1}, "b": {"cell": "A2", "low": 0, "high": 1}}
SCENARIOS = (
    Scenario("narrow", (Range("a", 0.2, 0.6),)),
    Scenario("held", (Frozen("b", 0.25),), "measured"),
    Scenario("open", (Limits("f", {"at_most": 0.9}),)),
    Scenario("same", ()),
)
NUMBERS = ("mean", "low", "high", "above")


@pytest.fixture(scope="module")
def model(book):
    plain = book(CELLS, GIVEN, {"x": "B1"}, {"f": {"cell": "B2", "at_most": 0.3}})
    forecasts = tuple(replace(each, threshold=0.9) for each in plain.forecasts)
    definitions = replace(plain.definitions, scenarios=SCENARIOS, forecasts=forecasts)
    return CompiledModel(plain.workbook, definitions, plain.path)


def answers(model, trials=2_000, seed=3, **more):
    return scenario_answers(simulate(model, trials=trials, seed=seed, scenarios=True, **more))


@pytest.mark.parametrize("sampling", ["mc", "lhs", "sobol"])
def test_answers_are_those_of_single_runs(model, sampling):
    results = answers(model, sampling=sampling)
    assert [each.name for each in results] == ["as it is", "narrow", "held", "open", "same"]
    for each in results:
        state = model if each.scenario is None else model_of(model, each.scenario)
        own = simulate(state, trials=2_000, seed=3, sampling=sampling)
        assert np.array_equal(each.run.trial_index, own.trial_index)
        assert each.run.forecasts["x"].tobytes() == own.forecasts["x"].tobytes()
        (answer,) = each.forecasts
        result = own.results["x"]
        assert (answer.mean, (answer.low, answer.high)) == (result.mean, result.central())
        assert answer.above == result.probability_above(0.9)
        assert each.acceptance == own.acceptance


def test_differences_are_to_the_workbook_as_it_is(model):
    base, *others = answers(model)
    assert base.acceptance_difference is None
    assert base.forecasts[0].differences == {}
    for each in others:
        for key in NUMBERS:
            difference = each.forecasts[0].differences[key]
            expected = getattr(each.forecasts[0], key).value - getattr(base.forecasts[0], key).value
            assert difference.value == pytest.approx(expected, abs=1e-12)
        expected = each.acceptance.value - base.acceptance.value
        assert each.acceptance_difference.value == pytest.approx(expected, abs=1e-12)
    same = others[-1]
    assert [same.forecasts[0].differences[key].error for key in NUMBERS] == [0.0] * 4
    assert same.acceptance_difference.error == 0.0


LEAST, MOST = 0.383, 1.752
"""√(χ²/16) of 16 degrees of freedom at 4 standard errors: its quantiles at 3.2e-5 and at 1 less that."""


def test_errors_of_differences_are_those_of_many_seeds(model):
    """Over 16 seeds the root mean square of difference less truth, in its error, is 1: between `LEAST` and `MOST`.

    Student's t of 15 degrees of freedom, for replicates, has a root mean square of 1.074; step functions of few trials
    leave their error up to 10 % too large.
    """
    model = CompiledModel(model.workbook, replace(model.definitions, scenarios=SCENARIOS[:3]), model.path)
    truth = answers(model, trials=50_000, seed=99)
    off = {}
    for sampling, widest in (("mc", 1.0), ("lhs", 1.074)):
        runs = [answers(model, trials=400, seed=seed, sampling=sampling) for seed in range(16)]
        for number, scenario in enumerate(SCENARIOS[:3], 1):
            for key in (*NUMBERS, "acceptance"):

                def value(result, number=number, key=key):
                    each = result[number]
                    return each.acceptance_difference if key == "acceptance" else each.forecasts[0].differences[key]

                z = [(value(each).value - value(truth).value) / value(each).error for each in runs]
                spread = float(np.sqrt(np.mean(np.square(z))))
                if not 0.9 * LEAST < spread < widest * MOST:
                    off[scenario.name, key, sampling] = spread
    assert off == {}


def test_common_random_numbers_make_differences_sharper(model):
    base, narrow, *_ = answers(model, trials=20_000)
    mine, theirs = base.forecasts[0].mean.error, narrow.forecasts[0].mean.error
    assert narrow.forecasts[0].differences["mean"].error < 0.7 * np.hypot(mine, theirs)


def test_a_run_until_so_many_are_accepted_has_scenarios_of_as_many(model):
    result = answers(model, trials=None, stopping=stopping(until_accepted=500))
    assert [each.run.accepted for each in result] == [500] * 5
    assert len({each.run.trials for each in result}) > 2
    assert all(each.acceptance_difference.error > 0 for each in result[1:4])


def test_a_run_without_scenarios_has_none(model):
    assert scenario_answers(simulate(model, trials=100)) == ()


def test_what_is_not_there(book, model):
    plain = book(CELLS, GIVEN, {"x": "B1"})
    with pytest.raises(DefinitionError, match="defines no scenario"):
        answers(plain)
    with pytest.raises(SimulationError, match="There is no scenario 'none'"):
        model_of(model, "none")
    with pytest.raises(DefinitionError, match=r"In the scenario 'bad': a: Low \(2\) is above High \(1\)"):
        model_of(model, Scenario("bad", (Range("a", 2, 1),)))
    assert model_of(model, "NARROW").assumptions[0].parameters == {"low": 0.2, "high": 0.6}


def test_a_yes_no_answer_that_a_scenario_makes_certain_stays_a_share(book):
    plain = book({"A1": 0.5, "B1": "=A1<0.4"}, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"low": "B1"})
    scenarios = (Scenario("held", (Frozen("a", 0.25),)), Scenario("high", (Frozen("a", 0.75),)))
    model = CompiledModel(plain.workbook, replace(plain.definitions, scenarios=scenarios), plain.path)
    own, *held = [each.forecasts[0] for each in answers(model)]
    assert [each.has_range for each in (own, *held)] == [False] * 3
    assert [each.mean.value for each in held] == [1.0, 0.0]
    assert [each.differences["mean"].value for each in held] == pytest.approx([1.0 - own.mean.value, -own.mean.value])
