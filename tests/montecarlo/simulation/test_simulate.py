from __future__ import annotations

import gc
import tempfile
import weakref

import numpy as np
import pytest
from simulated import simulated

from xlmc.analysis.results.record.make import fingerprint
from xlmc.analysis.results.statements.sentences import statements
from xlmc.errors import FormulaError, SimulationError
from xlmc.montecarlo.columns import column_store, on_disk
from xlmc.montecarlo.simulation import simulate as module
from xlmc.montecarlo.statistics import Estimate, proportion

CELLS = {
    "A1": 1.0,
    "A2": 1.0,
    "A3": 1.0,
    "A4": 1.0,
    "B1": "=A1*A2+SQRT(A3)",
    "B2": "=IF(A1>0.5,1/(A1-0.5),LN(A2+1))",
    "B3": "=B1^2-SIN(B2)",
    "C1": "=B1>0.6",
    "C2": "=A1-A2",
}
UNIT = {"low": 0, "high": 1}
GIVEN = {name: {"cell": name, **UNIT} for name in ("A1", "A2", "A3")}
GIVEN["A2"] |= {"distribution": "Triangular", "low": 0, "likeliest": 0.2, "high": 1}
FORECASTS = {"x": "B1", "y": "B3", "z": "A1"}
FILTERS = {"f": "C1", "g": {"cell": "C2", "at_least": -0.5, "below": 0.5}}


@pytest.fixture
def model(book):
    return book(CELLS, GIVEN, FORECASTS, FILTERS)


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch):
    """Many blocks in few trials."""
    monkeypatch.setattr(module, "BLOCK", 128)


def bits(run):
    """All that a run found, to compare to the last bit."""
    parts = {"trial": run.trial_index} | {f"in {k}": v for k, v in run.inputs.items()}
    parts |= {f"out {k}": v for k, v in run.forecasts.items()} | {f"prior {k}": v for k, v in run.prior.items()}
    arrays = {name: values.tobytes() for name, values in parts.items()}
    tally = run.tally
    counts = [tally.rejected.tolist(), tally.only.tolist(), tally.together.tolist(), tally.errors, tally.by_error]
    return arrays, counts, run.faults, run.invalid, run.error_trials


@pytest.mark.parametrize("jobs", [2, 3, 4])
@pytest.mark.parametrize("trials", [1, 127, 128, 129, 1000, 5000])
def test_threads_change_no_bit(model, trials, jobs):
    assert bits(simulated(model, trials, jobs=jobs)) == bits(simulated(model, trials, jobs=1))


@pytest.mark.parametrize(("short", "long"), [(1, 2), (128, 129), (200, 400), (1000, 5000)])
def test_a_longer_run_begins_with_the_shorter(model, short, long):
    one, two = simulated(model, short), simulated(model, long)
    m = one.accepted
    assert two.trial_index[:m].tolist() == one.trial_index.tolist()
    assert two.accepted == m or two.trial_index[m] >= short
    for name in FORECASTS:
        assert two.forecasts[name][:m].tobytes() == one.forecasts[name].tobytes()
    for name in GIVEN:
        assert two.inputs[name][:m].tobytes() == one.inputs[name].tobytes()


@pytest.mark.parametrize("trials", [1, 100, 128, 300, 1000])
def test_just_as_many_trials_as_asked_for(model, trials):
    run = simulated(model, trials)
    assert run.trials == trials
    assert run.accepted <= trials
    assert run.accepted == 0 or run.trial_index[-1] < trials
    assert {values.size for values in run.prior.values()} == {trials}
    assert run.acceptance.n == trials


def test_on_disk_a_forecast_that_does_not_vary(book, monkeypatch):
    monkeypatch.setattr(column_store, "IN_MEMORY", 0)
    run = simulated(book({"A1": 1.0, "B1": "=2>1"}, {"a": {"cell": "A1", **UNIT}}, {"x": "B1", "y": "A1"}), 300)
    assert run.forecasts["x"].tolist() == [1.0] * 300
    assert run["x"].mean.value == 1.0


@pytest.mark.parametrize("trials", [100, 5000])
def test_on_disk_no_bit_is_different(model, monkeypatch, trials):
    in_memory = simulated(model, trials)
    monkeypatch.setattr(column_store, "IN_MEMORY", 0)
    monkeypatch.setattr(column_store, "WRITTEN", 4000)
    run = simulated(model, trials)
    assert on_disk(run.trial_index)
    assert all(on_disk(values) for part in (run.inputs, run.prior, run.forecasts) for values in part.values())
    assert bits(run) == bits(in_memory)
    for name in FORECASTS:
        assert repr(run[name].statistics) == repr(in_memory[name].statistics)
        assert run[name].values.tolist() == in_memory[name].values.tolist()
    assert fingerprint(run) == fingerprint(in_memory)
    assert run.frame().equals(in_memory.frame())


def test_on_disk_a_forecast_without_a_number_is_left_out(book, monkeypatch):
    monkeypatch.setattr(column_store, "IN_MEMORY", 0)
    run = simulated(book({"A1": 1.0, "B1": "=SQRT(A1-0.5)"}, {"a": {"cell": "A1", **UNIT}}, {"x": "B1"}), 1000)
    kept = run.inputs["a"] >= 0.5
    assert on_disk(run["x"].values)
    assert run["x"].values.tolist() == np.sqrt(run.inputs["a"][kept] - 0.5).tolist()
    assert run["x"].statistics.trials == kept.sum()


def test_the_temporary_files_go_with_the_run(model, monkeypatch, tmp_path):
    monkeypatch.setattr(column_store, "IN_MEMORY", 0)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    run = simulated(model, 1000)
    assert list(tmp_path.iterdir())
    assert run["x"].statistics.trials == run.accepted
    del run
    for generation in range(2):  # the oldest objects are not of this run, and mostly it is among the youngest
        gc.collect(generation)
        if not list(tmp_path.iterdir()):
            break
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("scheduler", ["threads", "processes"])
def test_a_full_disk_ends_the_run(model, monkeypatch, scheduler):
    monkeypatch.setattr(column_store, "IN_MEMORY", 0)
    monkeypatch.setattr(tempfile, "tempdir", "/there/is/none")
    with pytest.raises(SimulationError, match="temporary folder"):
        simulated(model, 1000, jobs=2, scheduler=scheduler)


@pytest.mark.parametrize("kept", [0, 1, 200, 10**6, None])
def test_draws_of_the_first_accepted_trials_are_kept(model, kept):
    run, full = simulated(model, 3000, jobs=2, keep_inputs=kept), simulated(model, 3000)
    count = run.accepted if kept is None else min(kept, run.accepted)
    assert run.kept_inputs == count
    for name in GIVEN:
        assert run.inputs[name].tobytes() == full.inputs[name][:count].tobytes()
    assert [values.tobytes() for values in run.forecasts.values()] == [v.tobytes() for v in full.forecasts.values()]


def test_a_frame_never_holds_fewer_trials_than_were_accepted(model):
    run = simulated(model, 3000, keep_inputs=10)
    with pytest.raises(SimulationError, match="The draws of 10 of"):
        run.frame()
    frame = run.frame(inputs=False)
    assert list(frame) == list(FORECASTS)
    assert len(frame) == run.accepted


def test_draws_do_not_depend_on_the_block_size(model, monkeypatch):
    runs = []
    for block in (64, 100, 4096):
        monkeypatch.setattr(module, "BLOCK", block)
        runs.append(simulated(model, 1000))
    for run in runs[1:]:
        assert run.trial_index.tolist() == runs[0].trial_index.tolist()
        for name in GIVEN:
            assert run.inputs[name].tobytes() == runs[0].inputs[name].tobytes()
    assert runs[1].block == 100


def test_the_seed_matters(model):
    assert simulated(model, 500, 1).trial_index.tolist() != simulated(model, 500, 2).trial_index.tolist()
    assert bits(simulated(model, 500, 1)) == bits(simulated(model, 500, 1))


def test_freezing_one_assumption_leaves_the_draws_of_the_others(book):
    free = simulated(book(CELLS, GIVEN, FORECASTS), 500)
    frozen = simulated(book(CELLS, GIVEN | {"A2": GIVEN["A2"] | {"frozen": True}}, FORECASTS), 500)
    assert sorted(frozen.inputs) == ["A1", "A3"]
    for name in ("A1", "A3"):
        assert frozen.inputs[name].tobytes() == free.inputs[name].tobytes()
    expected = free.inputs["A1"] * 1.0 + np.sqrt(free.inputs["A3"])
    assert frozen.forecasts["x"].tolist() == expected.tolist()


def test_adding_an_assumption_leaves_the_draws_of_the_others(book):
    few = simulated(book(CELLS, GIVEN, FORECASTS), 300)
    many = simulated(book(CELLS, {"A4": {"cell": "A4", **UNIT}} | GIVEN, FORECASTS | {"w": "A4"}), 300)
    for name in GIVEN:
        assert many.inputs[name].tobytes() == few.inputs[name].tobytes()


def test_an_idle_assumption_is_not_drawn(book):
    run = simulated(book(CELLS, GIVEN | {"A4": {"cell": "A4", **UNIT}}, FORECASTS), 100)
    assert sorted(run.inputs) == sorted(run.prior) == ["A1", "A2", "A3"]


def test_names_are_matched_whatever_their_case(book):
    run = simulated(book(CELLS, {"Mass ": GIVEN["A1"]}, {"X": "A1"}), 50)
    assert run.inputs["Mass "].tolist() == run["x"].values.tolist()


def test_forecasts_are_what_the_function_gives_of_the_inputs(model):
    run = simulated(model, 2000)
    result = model.function(run.inputs)
    for name in FORECASTS:
        assert run.forecasts[name] == pytest.approx(result[name], rel=1e-15)


def test_filters_are_joined_with_and(model):
    run, free = simulated(model, 3000), simulated(model, 3000)
    model_prior = {name: run.prior[name] for name in GIVEN}
    result = model.function(model_prior)
    lean = model_prior["A1"] - model_prior["A2"]
    kept = (result["x"] > 0.6) & (lean >= -0.5) & (lean < 0.5)
    assert run.trial_index.tolist() == np.flatnonzero(kept).tolist()
    assert free.accepted == kept.sum()


def test_the_accounting_is_that_of_a_recount(model):
    run = simulated(model, 3000)
    result, prior = model.function(run.prior), run.prior
    lean = prior["A1"] - prior["A2"]
    fails = [~(result["x"] > 0.6), ~((lean >= -0.5) & (lean < 0.5))]
    assert run.tally.rejected.tolist() == [fail.sum() for fail in fails]
    assert run.tally.only.tolist() == [(fails[0] & ~fails[1]).sum(), (fails[1] & ~fails[0]).sum()]
    assert run.tally.together[0, 1] == run.tally.together[1, 0] == (fails[0] & fails[1]).sum()
    assert run.tally.by_error == 0
    assert run.accepted == 3000 - (fails[0] | fails[1]).sum()


def test_an_error_in_a_filter_rejects_the_trial(book):
    cells = {"A1": 1.0, "B1": "=SQRT(A1)", "B2": "=A1>-0.5"}
    given = {"a": {"cell": "A1", "low": -1, "high": 1}}
    run = simulated(book(cells, given, {"x": "A1"}, {"f": {"cell": "B1", "at_least": 0.1}, "g": "B2"}), 2000)
    a = run.prior["a"]
    assert run.trial_index.tolist() == np.flatnonzero(a >= 0.1**2).tolist()
    assert run.tally.errors == [{"#NUM!": (a < 0).sum()}, {}]
    assert run.tally.rejected.tolist() == [(a < 0.01).sum(), (a <= -0.5).sum()]
    assert run.tally.by_error == ((a < 0) & (a > -0.5)).sum()
    assert run.error_trials == run.tally.by_error
    (warning,) = run.warnings
    assert "lost to errors" in warning


@pytest.mark.parametrize(
    ("formula", "fault"),
    [("=SQRT(A1-0.5)", "#NUM!"), ("=1/(A1>0.5)", "#DIV/0!"), ('=IF(A1>0.5,A1,"none")', "text"), ("=NA()", "#N/A")],
)
def test_an_error_in_a_forecast_removes_the_trial_from_that_forecast_only(book, formula, fault):
    model = book({"A1": 1.0, "B1": formula, "B2": "=A1*2"}, {"a": {"cell": "A1", **UNIT}}, {"x": "B1", "y": "B2"})
    run = simulated(model, 1000)
    bad = run.inputs["a"] <= 0.5 if "A1" in formula else np.ones(1000, bool)
    assert run.accepted == 1000
    assert np.isnan(run.forecasts["x"]).tolist() == bad.tolist()
    assert run["x"].values.size == (~bad).sum()
    assert run["y"].values.size == 1000
    assert run.faults == {"x": {fault: bad.sum()}, "y": {}}
    assert run.error_trials == bad.sum()


def test_a_blank_forecast(book):
    run = simulated(book({"A1": 1.0}, {"a": {"cell": "A1", **UNIT}}, {"x": "B7", "y": "A1"}), 10)
    assert run.faults["x"] == {"blank": 10}
    assert np.isnan(run.forecasts["x"]).all()


def test_logicals_count_as_one_and_zero(book):
    run = simulated(book({"A1": 1.0, "B1": "=A1>0.5"}, {"a": {"cell": "A1", **UNIT}}, {"x": "B1"}), 500)
    assert run.forecasts["x"].tolist() == (run.inputs["a"] > 0.5).astype(float).tolist()


@pytest.mark.parametrize(("formula", "kept"), [("=TRUE", 100), ("=FALSE", 0), ("=2", 100), ("=C9", 0), ('="x"', 0)])
def test_a_filter_that_does_not_vary(book, formula, kept):
    run = simulated(book({"A1": 1.0, "B1": formula}, {"a": {"cell": "A1", **UNIT}}, {"x": "A1"}, {"f": "B1"}), 100)
    assert run.accepted == kept
    assert run.tally.rejected.tolist() == [100 - kept]


def test_a_limit_that_varies(book):
    given = {"a": {"cell": "A1", **UNIT}, "b": {"cell": "A2", **UNIT}}
    run = simulated(
        book({"A1": 1.0, "A2": 1.0, "B1": "=A2/2"}, given, {"x": "A1"}, {"f": {"cell": "A1", "above": "B1"}}), 500
    )
    assert run.trial_index.tolist() == np.flatnonzero(run.prior["a"] > run.prior["b"] / 2).tolist()


DYNAMIC_CELLS = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "B1": "=SQRT(A1)", "B2": "=A2+1", "C1": "=A3*2"}
DYNAMIC = {
    "c": {"cell": "A3", "low": "A2", "high": "B2"},
    "b": {"cell": "A2", "low": 0, "high": "B1"},
    "a": {"cell": "A1", "low": -0.25, "high": 1},
}


class TestDynamicParameters:
    def run(self, book, trials=1000, **more):
        return simulated(book(DYNAMIC_CELLS, DYNAMIC, {"x": "C1"}, **more), trials)

    def test_a_chain(self, book):
        run = self.run(book)
        a, b, c = (run.inputs[name] for name in "abc")
        assert (a >= 0).all()
        assert ((b >= 0) & (b <= np.sqrt(a)) & (c >= b) & (c <= b + 1)).all()
        assert run.forecasts["x"].tolist() == (2 * c).tolist()

    def test_trials_without_a_distribution_are_error_trials_and_rejected(self, book):
        run = self.run(book)
        bad = run.prior["a"] < 0
        assert np.isnan(run.prior["b"]).tolist() == np.isnan(run.prior["c"]).tolist() == bad.tolist()
        assert run.trial_index.tolist() == np.flatnonzero(~bad).tolist()
        assert run.invalid == {"b": bad.sum(), "c": bad.sum()}
        assert run.error_trials == bad.sum()
        assert run.warnings

    def test_they_are_lost_once_whatever_the_filters_say(self, book):
        run = self.run(book, filters={"f": {"cell": "C1", "above": 0}, "g": {"cell": "A1", "at_least": -0.1}})
        assert run.error_trials == (run.prior["a"] < 0).sum()
        assert run.tally.by_error == ((run.prior["a"] < 0) & (run.prior["a"] >= -0.1)).sum()

    def test_threads_change_no_bit(self, book):
        model = book(DYNAMIC_CELLS, DYNAMIC, {"x": "C1"})
        assert bits(simulated(model, 3000, jobs=3)) == bits(simulated(model, 3000))

    def test_correlated_with_a_dynamic_one(self, book):
        run = self.run(book, 4000, correlations={("a", "c"): 0.9})
        free = self.run(book, 4000)
        assert run.prior["a"].tobytes() == free.prior["a"].tobytes()
        assert run.prior["c"].tobytes() != free.prior["c"].tobytes()


def test_progress_tells_of_every_block_in_order(model):
    for jobs in (1, 3):
        seen = []
        run = simulated(model, 1000, jobs=jobs, progress=seen.append)
        assert [standing.trials for standing in seen] == [128, 256, 384, 512, 640, 768, 896, 1000]
        accepted = [standing.accepted for standing in seen]
        assert accepted == sorted(accepted)
        assert accepted[-1] == run.accepted


@pytest.mark.parametrize("jobs", [1, 3])
def test_an_interruption_ends_the_run(model, jobs):
    def stop(standing):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        simulated(model, 10**6, jobs=jobs, progress=stop)
    assert simulated(model, 10, jobs=jobs).trials == 10


def test_the_prior_is_kept_of_the_first_trials_only(model, monkeypatch):
    monkeypatch.setattr(module, "PRIOR_TRIALS", 256)
    run = simulated(model, 1000)
    assert {values.size for values in run.prior.values()} == {256}
    assert run.prior["A1"].tobytes() == simulated(model, 256).prior["A1"].tobytes()


def test_the_slow_engine_agrees(model):
    fast, slow = simulated(model, 50), simulated(model, 50, engine="formulas")
    assert slow.trial_index.tolist() == fast.trial_index.tolist()
    assert 0 < slow.accepted < 50
    for name in FORECASTS:
        assert slow.forecasts[name] == pytest.approx(fast.forecasts[name], rel=1e-12)
    for name in GIVEN:
        assert slow.inputs[name].tobytes() == fast.inputs[name].tobytes()
    assert slow.tally.rejected.tolist() == fast.tally.rejected.tolist()
    assert slow.settings.engine == "formulas"
    assert slow.block < 50


def test_settings_of_the_book_and_of_the_call(model):
    run = simulated(model, 10)
    assert (run.settings.trials, run.settings.seed, run.settings.engine) == (10, 999, "numpy")
    assert simulated(model, 10, 0).settings.seed == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"trials": 0}, "0 trials were asked for"),
        ({"trials": -5}, "-5 trials were asked for"),
        ({"trials": 10**13}, "10000000000000 trials were asked for"),
        ({"seed": -1}, "the seed -1 is negative"),
        ({"jobs": 0}, "0 jobs were asked for"),
        ({"engine": "excel"}, "There is no engine 'excel'"),
        ({"scheduler": "ray"}, "there is no scheduler 'ray'"),
        ({"scheduler": "local", "workers": 0}, "0 workers were asked for"),
        ({"workers": 2}, "the number of workers can be set for a local cluster only"),
        ({"keep_inputs": -1}, "the draws of -1 trials were asked for"),
    ],
)
def test_arguments_out_of_range(model, arguments, message):
    with pytest.raises(SimulationError) as caught:
        simulated(model, **{"trials": 10, **arguments})
    assert caught.value.message == message
    assert caught.value.hint


def test_a_circle_is_refused_when_the_model_is_made(book):
    with pytest.raises(FormulaError, match="need each other in a circle"):
        book({"A1": 1.0, "B1": "=B2", "B2": "=B1+A1"}, {"a": {"cell": "A1", **UNIT}}, {"x": "B1"})


def test_without_filters_every_trial_is_accepted_exactly(book):
    assert simulated(book(CELLS, GIVEN, FORECASTS), 300).acceptance == Estimate(1.0, 0.0, (1.0, 1.0), 300)
    every = {"f": {"cell": "C2", "at_least": -10}}
    assert simulated(book(CELLS, GIVEN, FORECASTS, every), 300).acceptance == proportion(300, 300)
    may_fail = {"A1": GIVEN["A1"], "A4": {"cell": "A4", "low": "A1", "high": 9}}
    assert simulated(book(CELLS, may_fail, {"z": "A4"}), 300).acceptance.interval[0] < 1.0


@pytest.mark.parametrize("more", [{}, {"sampling": "lhs500"}])
def test_the_columns_of_a_run_go_with_it_at_once(model, more):
    """Nothing of a run holds it in a circle, which Python would leave until much later."""
    gc.collect()
    gc.disable()
    try:
        run = simulated(model, 5_000, seed=1, **more)
        kept = weakref.ref(run), weakref.ref(next(iter(run.forecasts.values())))
        statements(run), run.warnings, [each.statistics for each in run.results.values()]
        del run
        assert [each() for each in kept] == [None, None]
    finally:
        gc.enable()
