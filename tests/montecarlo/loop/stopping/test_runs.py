"""Whole runs that end by a rule: the same trials for any number of threads, and by the command that repeats them."""

from __future__ import annotations

import itertools
import shlex
import signal
from dataclasses import replace

import click
import numpy as np
import pytest
from distributed import LocalCluster
from simulated import simulated

from xlmc.analysis.results.record import make_record
from xlmc.analysis.results.record.make import fingerprint
from xlmc.cli.simulate import simulate as command
from xlmc.errors import SimulationError
from xlmc.montecarlo import statistics
from xlmc.montecarlo.columns import column_store, on_disk
from xlmc.montecarlo.definitions.stopping import LIMIT, stopping
from xlmc.montecarlo.simulation import simulate as module

CELLS = {"A1": 1.0, "A2": 1.0, "B1": "=A1+SQRT(A2-0.001)", "B2": "=5+A1*A2", "C1": "=A1*A2>0.5"}
UNIT = {"low": 0, "high": 1}
GIVEN = {"a": {"cell": "A1", **UNIT}, "b": {"cell": "A2", **UNIT}}
ACCEPTANCE = 0.4 - 0.5 * np.log(1 / 0.6)
"""P(ab > 1/2 and a ≥ 0.6), the integral of 1 − 1/(2a) from 0.6 to 1."""


@pytest.fixture
def model(book):
    """About 15 % of the trials are accepted."""
    return book(CELLS, GIVEN, {"x": "B1", "y": "B2"}, {"f": "C1", "g": {"cell": "A1", "at_least": 0.6}})


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch):
    monkeypatch.setattr(module, "BLOCK", 500)


def bits(run):
    parts = (run.inputs, run.prior, run.forecasts)
    arrays = [run.trial_index.tobytes(), *(values.tobytes() for part in parts for values in part.values())]
    tally = run.tally
    counts = [tally.rejected.tolist(), tally.only.tolist(), tally.together.tolist(), tally.errors, tally.by_error]
    return arrays, counts, run.faults, run.invalid, run.error_trials, run.trials


ENDS = [
    {"until_accepted": 2},
    {"until_accepted": 700},
    {"precision": "2%"},
    {"precision": 0.02, "precision_of": "mean,sd,p75.5", "forecasts": ["X"]},
    {"adaptive": 1},
]


@pytest.fixture
def short_sequences(monkeypatch):
    monkeypatch.setattr("xlmc.montecarlo.loop.stopping.adaptive.sequence_length", lambda share: 100)


@pytest.mark.usefixtures("short_sequences")
@pytest.mark.parametrize(
    ("crew", "end"),
    [
        *(({"jobs": 3}, end) for end in ENDS),
        *(({"jobs": 2, "scheduler": "processes"}, end) for end in (ENDS[1], ENDS[3], ENDS[4])),
    ],
    ids=str,
)
def test_who_runs_the_blocks_changes_nothing(model, end, crew):
    alone = simulated(model, seed=3, **end)
    assert alone.stopped.reached
    assert not alone.warnings
    run = simulated(model, seed=3, **end, **crew)
    assert run.stopped == alone.stopped
    assert bits(run) == bits(alone)


@pytest.mark.usefixtures("short_sequences")
@pytest.mark.parametrize("end", ENDS, ids=str)
def test_a_run_of_as_many_trials_has_the_same_trials(model, end):
    run = simulated(model, seed=3, **end)
    assert bits(simulated(model, run.trials, 3)) == bits(run)


@pytest.mark.filterwarnings("ignore::ResourceWarning")  # Dask's, when it closes
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_a_cluster_ends_at_the_same_trial(model):
    asked = {"n_workers": 2, "threads_per_worker": 1, "processes": False, "dashboard_address": ":0"}
    with LocalCluster(**asked) as result:
        run = simulated(model, until_accepted=700, scheduler=result.scheduler_address)
    assert bits(run) == bits(simulated(model, until_accepted=700))


@pytest.mark.parametrize("engine", ["jit", "formulas"])
def test_another_engine_ends_at_the_same_trial(model, engine):
    if engine == "jit":
        pytest.importorskip("llvmlite")
    run, usual = simulated(model, until_accepted=15, engine=engine), simulated(model, until_accepted=15)
    assert run.trial_index.tolist() == usual.trial_index.tolist()
    assert run.trials == usual.trials
    assert run.tally.rejected.tolist() == usual.tally.rejected.tolist()


def test_it_ends_with_the_accepted_trial_that_was_waited_for(model):
    for wanted in (2, 3, 77, 78, 1000):
        run = simulated(model, until_accepted=wanted)
        assert run.accepted == wanted
        assert run.trials == run.trial_index[-1] + 1
        assert {values.size for values in run.prior.values()} == {min(run.trials, module.PRIOR_TRIALS)}
        assert run.acceptance == statistics.inverse_proportion(wanted, run.trials)
        assert run.stopped.by == "accepted"


def test_the_share_accepted_is_unbiased(model):
    """Of 144 runs, within 4 standard errors of their mean; accepted over trials would be 25 % too large."""
    runs = [simulated(model, seed=seed, until_accepted=5) for seed in range(144)]
    accepted = [f.acceptance.value for f in runs]
    error = np.std(accepted) / 12
    assert abs(np.mean(accepted) - ACCEPTANCE) < 4 * error
    assert np.mean([5 / f.trials for f in runs]) > ACCEPTANCE + 4 * error


def test_on_disk_it_ends_at_the_same_trial(model, monkeypatch):
    asked = {"precision": "2%", "precision_of": "mean,range,p90"}
    in_memory = simulated(model, **asked)
    monkeypatch.setattr(column_store, "IN_MEMORY", 0)
    monkeypatch.setattr(column_store, "WRITTEN", 4000)
    run = simulated(model, **asked)
    assert on_disk(run.trial_index)
    assert bits(run) == bits(in_memory)


def test_the_precision_asked_for_is_there(model):
    run = simulated(model, precision="1%", precision_of="mean,sd,p10")
    for result in run.results.values():
        for estimate in (result.mean, result.standard_deviation, result.percentile(10)):
            low, high = estimate.interval
            assert max(estimate.value - low, high - estimate.value) <= 0.01 * abs(estimate.value) * 1.001


@pytest.mark.parametrize(
    ("asked", "sentence"),
    [
        ({"trials": 700, "until_accepted": 300}, "the limit of 700 trials was reached before 300 trials were accepted"),
        (
            {"trials": 5000, "precision": 1e-6, "precision_of": "mean", "forecasts": "y"},
            "the limit of 5,000 trials was reached before mean of y was known to within 1e-06 (95 % confidence)",
        ),
        (
            {"trials": 900, "adaptive": 2},
            "the limit of 900 trials was reached before x and y were stable to 2 significant digits (JCGM 101, 7.9)",
        ),
    ],
)
def test_a_goal_that_was_not_reached_is_a_warning(model, asked, sentence):
    run = simulated(model, **asked)
    assert run.trials == asked["trials"]
    assert run.warnings == [run.stopped.sentence] == [sentence]
    assert run.acceptance == statistics.proportion(run.accepted, run.trials)


def test_the_time_ends_a_run_with_a_whole_block(model, monkeypatch):
    clock = itertools.count()
    monkeypatch.setattr(module.time, "monotonic", lambda: float(next(clock)))
    run = simulated(model, 10**6, time_limit=7)
    assert (run.trials, run.stopped.by, run.warnings) == (3500, "time", [])
    assert bits(simulated(model, 3500)) == bits(run)
    record = make_record(run)
    assert (record["end.by"], record["end.blocks"], record["end.time_limit"]) == ("time", 7, 7.0)
    assert "--trials 3500 " in record["run.repeat"]


def test_the_limit_of_a_run_with_a_goal(model):
    assert simulated(model, until_accepted=5).settings.trials == LIMIT
    assert simulated(model, 10**4, until_accepted=5).settings.trials == 10**4


def with_settings(model, **changes):
    settings = replace(model.definitions.settings, **changes)
    model.definitions = replace(model.definitions, settings=settings)
    return model


def test_what_the_workbook_says_of_the_length_holds_until_the_call_says_something(model):
    model = with_settings(model, trials=4000, stopping=stopping(until_accepted=50, time_limit=1000))
    assert simulated(model).accepted == 50
    assert simulated(model, time_limit=500).accepted == 50
    assert simulated(model, time_limit=500).settings.stopping.seconds == 500
    other = simulated(model, until_accepted=60)
    assert (other.accepted, other.settings.trials, other.settings.stopping.seconds) == (60, LIMIT, None)
    plain = simulated(model, 1234)
    assert (plain.trials, plain.stopped.by, plain.settings.stopping.asked) == (1234, "trials", False)


@pytest.mark.parametrize(
    "asked", [{}, {"trials": 700}, {"until_accepted": 40}, {"precision": "3%"}, {"trials": 300, "until_accepted": 90}]
)
def test_the_command_in_the_record_repeats_the_same_trials(model, asked):
    """Whatever the workbook itself asks for."""
    model = with_settings(model, trials=900, stopping=stopping(until_accepted=30, time_limit=1000))
    run = simulated(model, seed=8, **asked)
    words = shlex.split(make_record(run)["run.repeat"])
    assert words[:2] == ["xlmc", "simulate"]
    with click.Context(command) as context:
        command.parse_args(context, words[2:])
        typed = {name: context.params[name] for name in ("trials", "seed", "until_accepted")}
    assert fingerprint(simulated(model, **typed)) == fingerprint(run)
    assert simulated(model, **typed).trials == run.trials


def test_the_record_says_what_ended_the_run(model):
    record = make_record(simulated(model, until_accepted=40))
    assert record["end.in_words"] == record["end.goal"] == "40 trials were accepted"
    assert (record["end.by"], record["end.reached"], record["end.most_trials"]) == ("accepted", True, LIMIT)
    assert record["end.share_accepted"].startswith("(N − 1)/(n − 1)")
    plain = make_record(simulated(model, 400))
    assert (plain["end.by"], plain["end.goal"], plain["end.blocks"]) == ("trials", None, 1)


def test_progress_tells_how_the_run_stands(model):
    seen = []
    run = simulated(model, until_accepted=400, progress=seen.append)
    assert seen[-1].trials == run.trials
    assert seen[-1].accepted == 400
    shares = [standing.share for standing in seen]
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert shares == pytest.approx([standing.accepted / 400 for standing in seen])
    for name, mean in seen[-1].means.items():
        assert mean.value == pytest.approx(run[name].mean.value, rel=1e-12)
        assert mean.error == pytest.approx(run[name].mean.error, rel=1e-9)


@pytest.mark.parametrize(
    "crew", [{}, {"jobs": 2, "scheduler": "threads"}, {"jobs": 2, "scheduler": "processes"}], ids=str
)
@pytest.mark.parametrize("end", [{"trials": 10**7}, {"until_accepted": 10**6}], ids=str)
def test_an_interrupted_run_keeps_what_it_has(model, crew, end):
    def press(standing):
        if standing.trials == 1500:
            signal.raise_signal(signal.SIGINT)

    run = simulated(model, **end, **crew, keep_interrupted=True, progress=press)
    assert run.stopped.interrupted
    assert run.stopped.by == "interruption"
    assert run.trials == 2000
    assert bits(simulated(model, 2000)) == bits(run)
    assert run.warnings == []
    assert make_record(run)["end.by"] == "interruption"
    assert simulated(model, 10).trials == 10


def test_an_interruption_before_there_is_anything_is_one(model, monkeypatch):
    program = model.program
    monkeypatch.setattr(model, "sampler", lambda *given: signal.raise_signal(signal.SIGINT) or program)
    with pytest.raises(KeyboardInterrupt):
        simulated(model, 10**6, keep_interrupted=True)


def test_without_being_asked_to_keep_it_an_interruption_is_one(model):
    def press(standing):
        signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        simulated(model, 10**6, progress=press)


@pytest.mark.parametrize("asked", [{"until_accepted": 10}, {"precision": 1}, {"adaptive": 1}, {"time_limit": 5}])
def test_other_sampling_runs_its_trials(model, asked):
    with_settings(model, sampling="lhs")
    with pytest.raises(SimulationError, match="A run with lhs sampling cannot end before all its trials are run"):
        simulated(model, **asked)


def test_a_forecast_that_is_not_there(model):
    with pytest.raises(SimulationError, match="There is no forecast 'z'"):
        simulated(model, precision=1, forecasts="z")
