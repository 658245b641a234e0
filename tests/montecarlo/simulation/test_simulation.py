from __future__ import annotations

import numpy as np
import pytest
from simulated import simulated

from xlmc.api import Simulation
from xlmc.montecarlo import statistics
from xlmc.montecarlo.model.model import CompiledModel

CELLS = {"A1": 0.5, "A2": 0.5, "B1": "=A1+A2", "B2": "=SQRT(A1-0.0005)"}
GIVEN = {"Mass": {"cell": "A1", "low": 0, "high": 1}, "Speed": {"cell": "A2", "low": 0, "high": 1}}


@pytest.fixture
def run(book):
    return simulated(book(CELLS, GIVEN, {"Sum": "B1", "Root": "B2"}, {"f": {"cell": "B1", "above": 0.5}}), 20_000, 1)


@pytest.mark.parametrize("name", ["Sum", "sum", " SUM "])
def test_a_forecast_by_name(run, name):
    assert run[name] is run.results["Sum"]


def test_an_unknown_forecast(run):
    with pytest.raises(KeyError, match="there is no forecast 'Total'; there are 'Sum', 'Root'"):
        run["Total"]


def test_statistics_of_the_accepted_trials(run):
    values = run.forecasts["Sum"]
    result = run["Sum"]
    assert result.values.tolist() == values.tolist()
    assert result.mean == statistics.mean(values)
    assert result.median == statistics.median(values)
    assert result.standard_deviation == statistics.standard_deviation(values)
    assert result.percentile(10) == statistics.percentile(values, 10)
    assert result.central() == statistics.central_interval(values, 0.51)
    assert result.central(0.9) == statistics.central_interval(values, 0.9)
    assert result.probability_above(1.0) == statistics.probability_above(values, 1.0)
    assert result.statistics == statistics.describe(values, central=0.51, threshold=None)
    assert result.statistics is result.statistics


def test_the_answer_is_right(run):
    """Of two uniforms whose sum is above 1/2: acceptance 7/8, mean 23/21 (twice 1/2 less the corner's share)."""
    acceptance, mean = 7 / 8, (1 - 1 / 8 * 1 / 3) / (7 / 8)
    assert abs(run.acceptance.value - acceptance) < 4 * run.acceptance.error
    assert abs(run["Sum"].mean.value - mean) < 4 * run["Sum"].mean.error


def test_values_that_are_no_numbers_are_left_out(run):
    root = run.forecasts["Root"]
    lost = np.isnan(root).sum()
    assert 0 < lost < 20
    assert run["Root"].values.size == run.accepted - lost
    assert run["Root"].faults == {"#NUM!": lost}
    assert repr(run["Root"]) == f"<Root: {run.accepted - lost} accepted trials>"


def test_a_run_in_short(run):
    assert repr(Simulation(run)) == f"<Simulation: {run.accepted} of 20000 trials accepted>"
    assert run.acceptance == statistics.proportion(run.accepted, 20_000)


def test_a_frame_of_accepted_trials(run):
    frame = run.frame()
    assert list(frame.columns) == ["Mass", "Speed", "Sum", "Root"]
    assert frame.index.name == "Trial"
    assert frame.index.tolist() == run.trial_index.tolist()
    assert frame["Sum"].to_numpy().tolist() == run.forecasts["Sum"].tolist()


def test_an_assumption_and_a_forecast_of_one_name(book):
    frame = simulated(book(CELLS, GIVEN, {"Mass": "B1"}), 10).frame()
    assert list(frame.columns) == ["Mass (assumption)", "Speed", "Mass"]
    assert frame["Mass"].tolist() == (frame["Mass (assumption)"] + frame["Speed"]).tolist()


def test_few_errors_are_no_warning(run):
    assert 0 < run.error_trials <= 20
    assert run.warnings == []


@pytest.mark.parametrize(("level", "warned"), [(0.0009, False), (0.0011, True), (0.5, True)])
def test_errors_above_a_thousandth_are(book, level, warned):
    """How many trials err is known beforehand: it is the rank of the draws that decides."""
    model = book(CELLS | {"B2": "=SQRT(A1-B9)", "B9": 0.0}, GIVEN, {"x": "B2", "y": "A1"})
    threshold = np.quantile(simulated(model, 10_000).inputs["Mass"], level)
    run = simulated(book(CELLS | {"B2": "=SQRT(A1-B9)", "B9": float(threshold)}, GIVEN, {"x": "B2", "y": "A1"}), 10_000)
    assert run.error_trials == pytest.approx(10_000 * level, abs=1)
    assert bool(run.warnings) is warned
    if warned:
        assert run.warnings == [
            f"{run.error_trials:,} trials ({run.error_trials / 100:.2f} %) were lost to errors in cells"
        ]


def test_no_accepted_trial_is_a_warning(book):
    run = simulated(book(CELLS, GIVEN, {"x": "B1"}, {"f": {"cell": "B1", "above": 5}, "g": "A1"}), 100)
    assert run.accepted == 0
    assert run.warnings == [
        "no trial was accepted: the filters contradict the assumptions, or accept fewer than 3.7 % of the trials. "
        "'f' rejects all trials by itself"
    ]
    assert run["x"].values.size == 0
    assert run.frame().empty


def test_a_central_range_of_the_forecasts_own(book):
    from dataclasses import replace

    model = book(CELLS, GIVEN, {"x": "B1"})
    forecasts = (replace(model.forecasts[0], central=0.9, threshold=1.0),)
    run = simulated(CompiledModel(model.workbook, replace(model.definitions, forecasts=forecasts), model.path), 1000)
    assert run["x"].central() == statistics.central_interval(run["x"].values, 0.9)
    assert run["x"].statistics == statistics.describe(run["x"].values, central=0.9, threshold=1.0)
