"""Runs that end because their numbers look good enough: how often by luck, and whether that moves the numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from simulated import simulated

RUNS = 120
NOISE = 4 * math.sqrt(0.95 * 0.05 / RUNS)


@pytest.mark.parametrize(("name", "needed", "slack"), [("normal", 2_000, 0.0), ("exponential", 2_000, 0.01),
                                                       ("lognormal, σ 1", 4_000, 0.04)])  # fmt: skip
def test_precision(name, needed, slack):
    """95 % less 4 standard errors, and what intervals of skewed means lack without any stop rule. The mean at the stop
    is off by less than four tenths of its error: the bias of the rule, of the order 1/√n, and chance, 4/√120."""
    from stressing.stops import FORECASTS, precise_runs

    forecast = FORECASTS[name]
    tolerance = 1.96 * forecast.deviation / forecast.mean / math.sqrt(needed)
    result = precise_runs(name, tolerance, RUNS)
    assert result["ended"] == RUNS
    assert result["held"] / RUNS > 0.95 - NOISE - slack
    assert result["unvaried"] == 0
    assert abs(result["bias"]) < 0.02 + slack * 4 + 4 * result["error of bias"]
    assert 0.8 * needed < result["length"] < 1.6 * needed


def test_precision_does_not_take_for_known_what_has_not_varied_yet():
    """1 in 1,000 trials is 1, the others 0. At 2,000, the first look, 13.5 % of the runs have only seen zeros."""
    from stressing.stops import precise_runs

    result = precise_runs("1 in 1,000", 0.6, 60)
    assert result["ended"] == 60
    assert result["unvaried"] == 0


@pytest.fixture
def short_sequences(monkeypatch):
    """Of 500 rather than 10,000: as many of them are needed, with 1/√20 of the scale."""
    from xlmc.montecarlo.loop.stopping import adaptive

    monkeypatch.setattr(adaptive, "sequence_length", lambda share: 500)


@pytest.mark.parametrize("scale", [1.2])
def test_adaptive(short_sequences, scale):
    """With twenty sequences at least, every number is within the tolerance in 95 % of runs less 4 standard errors."""
    from stressing.stops import least_sequences, stable_runs

    runs = 60
    result = stable_runs("normal", 2, scale, runs)
    assert result["ended"] == runs
    assert min(result["within"]) / runs > 0.95 - 4 * math.sqrt(0.95 * 0.05 / runs)
    with least_sequences(2):
        standard = stable_runs("normal", 2, scale, runs)
    assert standard["sequences"] < result["sequences"]
    assert min(standard["within"]) < min(result["within"]) - 0.02 * runs  # it stops by luck


def test_adaptive_sees_what_is_rare(short_sequences):
    """Twenty sequences hold 10,000 trials: 1 in 1,000 is missed in 1 of 22,000 runs."""
    from stressing.stops import stable_runs

    result = stable_runs("1 in 1,000", 1, 1.0, 20)
    assert result["ended"] == 20
    assert result["sequences"] >= 20


@pytest.fixture(scope="module")
def model(book):
    given = {name: {"cell": cell, "low": 0.0, "high": 1.0} for name, cell in (("u", "A1"), ("v", "A2"))}
    filters = {"f": {"cell": "A2", "below": 0.1}}
    return book({"A1": 0.5, "A2": 0.5, "B1": "=10+A1"}, given, {"x": "B1"}, filters)


def test_whole_runs_until_so_many_are_accepted(model):
    """60 runs: neither the share nor the mean is moved by more than 4 standard errors."""
    runs = [simulated(model, seed=seed, until_accepted=50, keep_inputs=0) for seed in range(60)]
    shares = np.array([run.acceptance.value for run in runs])
    means = np.array([run["x"].mean.value for run in runs])
    assert shares.mean() == pytest.approx(0.1, abs=4 * shares.std(ddof=1) / math.sqrt(60))
    assert means.mean() == pytest.approx(10.5, abs=4 * means.std(ddof=1) / math.sqrt(60))
    held = sum(run.acceptance.interval[0] <= 0.1 <= run.acceptance.interval[1] for run in runs)
    assert held / 60 > 0.95 - 4 * math.sqrt(0.95 * 0.05 / 60)


def test_whole_runs_until_the_mean_is_known(model, monkeypatch):
    """40 runs in small blocks, which give the rule as many chances to stop by luck as it can have."""
    monkeypatch.setattr("xlmc.montecarlo.simulation.simulate.BLOCK", 2_048)
    runs = [simulated(model, seed=seed, precision=0.012, precision_of="mean", keep_inputs=0) for seed in range(40)]
    assert {run.stopped.by for run in runs} == {"precision"}
    held = sum(run["x"].mean.interval[0] <= 10.5 <= run["x"].mean.interval[1] for run in runs)
    assert held / 40 > 0.95 - 4 * math.sqrt(0.95 * 0.05 / 40)
    off = np.array([(run["x"].mean.value - 10.5) / run["x"].mean.error for run in runs])
    assert abs(off.mean()) < 4 / math.sqrt(40)
