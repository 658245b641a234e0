"""A normal quantity and a reading of it: what is kept is known exactly."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import norm
from simulated import simulated

from xlmc.errors import DefinitionError
from xlmc.montecarlo.simulation.simulate import simulate

X = {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1}
READING = {"cell": "B1", "reading": 1, "error": "normal", "std_dev": 0.5}
CELLS = {"A1": 0.0, "B1": "=A1*1", "C1": 2.0, "D1": "=A1+C1"}
OTHERS = {"x": X, "c": {"cell": "C1", "low": 1, "high": 3}}
FORECASTS = {"y": "B1", "sum": "D1"}


@pytest.fixture(scope="module")
def normal(book):
    return book(CELLS, OTHERS, FORECASTS, evidence={"EDR": READING})


def close(result, truth):
    """Within four standard errors."""
    return abs(result.value - truth) < 4 * result.error


def test_a_normal_error_gives_the_known_posterior(normal):
    """X ~ N(0, 1) and a reading of 1 with a standard deviation of 0.5: mean 0.8, SD √0.2, share √0.2·exp(-0.4)."""
    run = simulated(normal, trials=400_000)
    assert close(run.acceptance, 0.299776)
    assert close(run["y"].mean, 0.8)
    assert close(run["y"].standard_deviation, 0.447214)
    assert close(run["sum"].mean, 2.8)


def test_a_uniform_error_gives_the_known_posterior(book):
    reading = {"cell": "B1", "reading": 1, "plus_minus": 0.5}
    run = simulated(book(CELLS, OTHERS, FORECASTS, evidence={"EDR": reading}), trials=400_000)
    assert close(run.acceptance, 0.241730)
    assert close(run["y"].mean, 0.920645)


def test_a_lognormal_error_gives_the_known_posterior(book):
    """ln m ~ N(0, 0.5) and ln R = 0.5 with σ 0.5: ln m given R ~ N(0.25, 0.5/√2)."""
    cells = {"A1": 0.0, "B1": "=EXP(A1/2)", "C1": "=IF(A1>-9,B1,-1)"}
    reading = {"cell": "C1", "reading": float(np.exp(0.5)), "error": "lognormal", "std_dev": 0.5}
    run = simulated(book(cells, {"x": X}, {"log": "A1"}, evidence={"damage": reading}), trials=200_000)
    assert close(run["log"].mean, 0.5)  # x = 2·ln m
    assert close(run["log"].standard_deviation, 0.5**0.5)


CENSORED = {
    "at least": ({"reading": 1, "error": "at least", "std_dev": 0.5}, 1.0),
    "at most": ({"reading": -1, "error": "at most", "std_dev": 0.5}, -1.0),
}


@pytest.mark.parametrize("engine", ["numpy", "jit"])
@pytest.mark.parametrize(("reading", "side"), CENSORED.values(), ids=CENSORED)
def test_a_reading_that_was_cut_off_gives_the_known_posterior(book, reading, side, engine):
    """X ~ N(0, 1), and X + N(0, 0.5) lies beyond 1: the share is Φ(-1/√1.25), the mean φ(1/√1.25)/(√1.25·share)."""
    run = simulated(
        book(CELLS, OTHERS, FORECASTS, evidence={"EDR": {"cell": "B1", **reading}}), trials=400_000, engine=engine
    )
    at = 1 / np.sqrt(1.25)
    assert close(run.acceptance, norm.sf(at))
    assert close(run["y"].mean, side * norm.pdf(at) / (np.sqrt(1.25) * norm.sf(at)))


def test_a_cut_off_reading_gives_the_same_by_weights(book):
    reading = {"cell": "B1", **CENSORED["at least"][0]}
    run = simulated(book(CELLS, OTHERS, FORECASTS, evidence={"EDR": reading}), trials=200_000, evidence="weights")
    at = 1 / np.sqrt(1.25)
    assert run.accepted == 200_000
    assert run.weighting.mean == pytest.approx(norm.sf(at), rel=0.01)
    assert close(run["y"].mean, norm.pdf(at) / (np.sqrt(1.25) * norm.sf(at)))


def test_a_cut_off_reading_without_an_error_is_a_limit(book):
    zero, none = ({"cell": "B1", "reading": 1, "error": "at least", **error} for error in ({"std_dev": 0}, {}))
    runs = [simulated(book(CELLS, OTHERS, FORECASTS, evidence={"EDR": each}), trials=4_000) for each in (zero, none)]
    assert np.array_equal(runs[0].trial_index, runs[1].trial_index)
    assert runs[0].forecasts["y"].min() >= 1


def test_evidence_moves_no_draw_and_every_engine_keeps_the_same_trials(book, normal):
    plain = simulated(book(CELLS, OTHERS, FORECASTS), trials=5_000)
    both = {"video": {**READING, "reading": 2}, "EDR": READING}
    for method in ("mc", "lhs", "sobol"):
        one, two = simulated(normal, trials=5_000, sampling=method), None
        assert list(one.inputs) == list(one.prior) == ["x", "c"]
        if method == "mc":
            assert all(np.array_equal(one.prior[name], plain.prior[name]) for name in plain.prior)
            two = simulate(
                book(CELLS, OTHERS, FORECASTS, evidence=both), trials=5_000
            )  # which rejects, few as it keeps
            assert set(two.trial_index) < set(one.trial_index)  # the number that EDR draws is its own
            assert np.array_equal(one.trial_index, simulated(normal, trials=5_000, engine="jit").trial_index)
            assert np.array_equal(one.inputs["c"], simulated(normal, trials=5_000, engine="jit").inputs["c"])


def test_what_keeps_no_trial_without_its_chance_is_told_at_the_base_case(normal):
    from xlmc.outputs.summary import base_case

    result = base_case(simulated(normal, trials=200))
    assert result.rejected_by == ()
    assert result.forecasts == {"y": 0.0, "sum": 2.0}


def test_a_reading_may_be_a_formula_but_not_one_of_an_assumption(book):
    cells = {**CELLS, "E1": "=10/10", "F1": "=C1/2"}
    run = simulated(book(cells, OTHERS, FORECASTS, evidence={"EDR": {**READING, "reading": "E1"}}), trials=5_000)
    same = simulated(book(cells, OTHERS, FORECASTS, evidence={"EDR": READING}), trials=5_000)
    assert np.array_equal(run.trial_index, same.trial_index)
    with pytest.raises(DefinitionError, match="varies with an assumption") as raised:
        book(cells, OTHERS, FORECASTS, evidence={"EDR": {**READING, "reading": "F1"}})
    assert str(raised.value.where) == "S!F1"
    with pytest.raises(DefinitionError, match="is 0: no reading is exact"):
        book({**cells, "G1": "=1-1"}, OTHERS, FORECASTS, evidence={"EDR": {**READING, "std_dev": "G1"}})
