"""Whole runs by every sampling method."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from simulated import simulated

import xlmc.montecarlo.simulation.simulate
from xlmc.analysis.results.record import make_record
from xlmc.errors import SimulationError
from xlmc.montecarlo import statistics
from xlmc.montecarlo.definitions.definitions import Settings
from xlmc.montecarlo.loop.sobol_order import plan_sampling
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.sampling.sampling_methods import METHODS

ROUNDED = ", whole ones, for the 1,000 trials that were asked for"
STRATIFIED = [method for method in METHODS if method != "mc"]
CELLS = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "B1": "=A1+2*A2", "B2": "=A1*A3", "B3": "=SQRT(A1-0.001)"}
GIVEN = {
    "a": {"cell": "A1", "low": 0, "high": 1},
    "b": {"cell": "A2", "low": 0, "high": "A1"},
    "c": {"cell": "A3", "low": 0, "high": 1},
}


@pytest.fixture
def model(book, monkeypatch):
    """A filter, a dynamic parameter, a correlated group, an error now and then; blocks that cut through replicates."""
    monkeypatch.setattr(xlmc.montecarlo.simulation.simulate, "BLOCK", 300)
    filters = {"f": {"cell": "B2", "below": 0.4}}
    return book(CELLS, GIVEN, {"x": "B1", "y": "B3"}, filters, {("a", "c"): 0.5})


def everything(run):
    arrays = [run.trial_index, *run.inputs.values(), *run.prior.values(), *run.forecasts.values()]
    return [array.tobytes() for array in arrays], run.trials, run.error_trials


@pytest.mark.parametrize("method", STRATIFIED)
@pytest.mark.parametrize("scheduler", ["threads", "processes"])
def test_who_runs_the_blocks_changes_no_bit(model, method, scheduler):
    alone = simulated(model, 5_000, 3, sampling=method)
    assert everything(simulated(model, 5_000, 3, sampling=method, jobs=3, scheduler=scheduler)) == everything(alone)


@pytest.mark.parametrize("method", STRATIFIED)
def test_the_block_size_changes_no_bit(model, monkeypatch, method):
    small = simulated(model, 5_000, 3, sampling=method)
    monkeypatch.setattr(xlmc.montecarlo.simulation.simulate, "BLOCK", 4_096)
    assert everything(simulated(model, 5_000, 3, sampling=method)) == everything(small)


@pytest.mark.parametrize("method", STRATIFIED)
def test_whole_replicates_are_run_and_can_be_repeated(model, method):
    run = simulated(model, 5_001, 3, sampling=method)
    assert run.trials == run.plan.trials == run.plan.size * run.plan.replicates > 5_001
    assert everything(simulated(model, run.trials, 3, sampling=method)) == everything(run)
    assert run.accepted_by_replicate.sum() == run.accepted
    assert np.array_equal(np.bincount(run.replicate), run.accepted_by_replicate)


@pytest.mark.parametrize("method", STRATIFIED)
def test_errors_come_from_the_replicates(model, method):
    run = simulated(model, 20_000, 3, sampling=method)
    values, ids = run.forecasts["y"], run.replicate
    known = ~np.isnan(values)
    assert not known.all()
    assert run["y"].mean == statistics.mean(values[known], None, ids[known])
    assert run["y"].median == statistics.median(values[known], None, ids[known])
    sizes = np.full(run.plan.replicates, run.plan.size)
    assert run.acceptance == statistics.replicated_proportion(run.accepted_by_replicate, sizes)


def test_without_filters_the_margins_are_stratified_and_the_means_are_better(book):
    model = book(CELLS, {key: GIVEN[key] for key in ("a", "c")}, {"x": "B2"})
    plain = simulated(model, 20_000, 3)["x"].mean.error
    for method, gain in (("lhs", 2), ("lhs500", 2), ("sobol", 50)):
        run = simulated(model, 20_000, 3, sampling=method)
        assert run["x"].mean.error < plain / gain
        assert abs(run["x"].mean.value - 0.25) < 5 * run["x"].mean.error
        places = np.floor(run.inputs["a"][: run.plan.size] * run.plan.size + 1e-9)
        assert np.array_equal(np.sort(places), np.arange(run.plan.size))


@pytest.mark.parametrize("method", ["mc", "lhs", "lhs500"])
def test_other_assumptions_change_nothing(book, method):
    both = simulated(book(CELLS, {key: GIVEN[key] for key in ("a", "c")}, {"x": "B2"}), 2_000, 3, sampling=method)
    alone = simulated(book(CELLS, {"a": GIVEN["a"]}, {"x": "B2"}), 2_000, 3, sampling=method)
    assert np.array_equal(both.inputs["a"], alone.inputs["a"])


def test_too_few_accepted_trials_are_told(book):
    model = book(CELLS, GIVEN, {"x": "B1"}, {"f": {"cell": "A1", "below": 0.02}})
    run = simulated(model, 4_000, 3, sampling="lhs")
    assert 0 < run.accepted < 160
    [warning] = run.warnings
    assert warning.startswith(f"only {run.accepted} trials were accepted in 16 replicates, fewer than 160, so errors")
    assert not simulated(model, 40_000, 3, sampling="lhs").warnings
    assert not simulated(model, 4_000, 3).warnings


def test_long_tails_are_told(book):
    """The notice that it hangs on a single trial says enough; else the one on its interval is given."""
    cells = {"A1": 0.0, "B1": "=EXP(1.5*A1)", "B2": "=EXP(A1)", "B3": "=A1"}
    given = {"z": {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1}}
    model = book(cells, given, {"heavy": "B1", "less": "B2", "plain": "B3"})
    for method in ("mc", "lhs", "sobol"):
        notices = [notice.message for notice in simulated(model, 20_000, 1, sampling=method).notices_of_run]
        short = [message for message in notices if "too short" in message or "depend on a single trial" in message]
        assert "'heavy'" in " ".join(short)
        assert "'plain'" not in " ".join(notices)
        assert "of 'less'" in " ".join(notices)
        assert all("'heavy'" not in message for message in notices if "independent trials" in message)


def test_the_pilot_finds_what_matters(book):
    cells = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "B1": "=A1+9*A2+3*A3"}
    given = {name: {"cell": cell, "low": 0, "high": 1} for name, cell in zip("abc", ("A1", "A2", "A3"), strict=True)}
    model = book(cells, given, {"x": "B1"})
    assert plan_sampling(model, Settings(sampling="sobol")).order == ("b", "c", "a")
    filtered = book(cells, given, {"x": "A2"}, {"f": {"cell": "A1", "below": 0.1}})
    assert plan_sampling(filtered, Settings(sampling="sobol")).order == ("a", "b")
    assert plan_sampling(model, Settings(sampling="lhs")).order == ()


def test_the_pilot_gets_along_with_nothing_accepted_and_with_errors(book):
    model = book(CELLS, GIVEN, {"x": "B3"}, {"f": {"cell": "A1", "above": 2}})
    assert plan_sampling(model, Settings(sampling="sobol")).order == ("a",)
    errors = book({**CELLS, "B3": "=SQRT(-A1)"}, GIVEN, {"x": "B3", "y": "B1"})
    assert set(plan_sampling(errors, Settings(sampling="sobol")).order) == {"a", "b"}


@pytest.mark.parametrize("engine", ["formulas", "jit"])
def test_engines_agree(model, engine):
    if engine == "jit":
        pytest.importorskip("llvmlite")
    numpy, other = (simulated(model, 400, 3, sampling="sobol", engine=each) for each in ("numpy", engine))
    assert np.array_equal(other.trial_index, numpy.trial_index)
    assert other.forecasts["x"] == pytest.approx(numpy.forecasts["x"], rel=1e-12)


def test_an_unknown_method(model):
    with pytest.raises(SimulationError, match="There is no sampling method 'dice'") as caught:
        simulated(model, 100, sampling="dice")
    assert caught.value.hint == f"Choose one of {', '.join(METHODS)}"


def test_the_books_own_setting(model):
    own = replace(model.definitions, settings=Settings(trials=1_000, seed=4, sampling="lhs500"))
    run = simulated(CompiledModel(model.workbook, own, model.path))
    assert run.plan.method == "lhs500"
    assert everything(run) == everything(simulated(model, 1_000, 4, sampling="lhs500"))


@pytest.mark.parametrize(
    ("method", "words", "errors"),
    [
        ("mc", "Monte Carlo: independent trials", "from the spread of the trials"),
        (
            "lhs",
            f"Latin hypercube: 16 independent replicates of 63 trials{ROUNDED}",
            "from the differences between replicates, with Student's t of 15 degrees of freedom",
        ),
        (
            "sobol",
            f"scrambled Sobol: 16 independent replicates of 64 trials{ROUNDED}",
            "from the differences between replicates, with Student's t of 15 degrees of freedom",
        ),
    ],
)
def test_the_record_says_how_trials_were_drawn_and_errors_made(model, method, words, errors):
    run = simulated(model, 1_000, 3, sampling=method)
    record = make_record(run)
    assert record["sampling.method"] == method
    assert record["sampling.method_in_words"] == words
    assert record["sampling.errors"] == errors
    assert record["sampling.trials"] == run.trials
    repeat = "--trials 1000 --seed 3" + (f" --sampling {method}" if method != "mc" else "")
    assert record["run.repeat"] == f"xlmc simulate book.xlsx {repeat}"
    if method == "sobol":
        assert sorted(record["sampling.dimensions"].split(", ")) == ["a", "b", "c"]
    if method != "mc":
        assert record["sampling.asked"] == 1_000
        assert record["conventions.variance"].endswith("the squared error of the mean")


def test_many_replicates_are_grouped_for_their_errors(model):
    record = make_record(simulated(model, 50_000, 3, sampling="lhs500"))
    assert record["sampling.errors"].startswith("from the differences between 64 groups of replicates")
